#include "exitance/lab/classical/shooting_columns.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {

ShootingColumns::ShootingColumns(const MethodInput& input, const ShootingMesh& mesh)
    : input_(input),
      mesh_(mesh),
      at_vertices_(input.options.classical.receivers == ShootingReceivers::vertex),
      transfer_(input.stage, mesh.tree, static_cast<unsigned>(samples()), input.options.seed),
      kept_(mesh.patches.size()),
      kept_at_vertices_(mesh.patches.size()) {
    const SolveOptions& o = input.options;
    if (!o.form_factors || o.form_factors == FormFactorKind::analytic) return;
    const ElementLocator locator(mesh.tree, input.stage.scene.regions().size());
    const LeafNumbering numbering(mesh.tree);
    const NumberedLeaves leaves{mesh.tree, numbering, locator};
    if (o.form_factors == FormFactorKind::hemicube)
        hemicubes_.emplace(input.stage, leaves, hemicube_cells(o));
    else
        ray_rows_.emplace(input.stage, leaves, RowRays{ray_budget(o, input.knobs), o.seed});
}

/// Returns the form factor from a vertex to a patch: exact for the polygon, times the unblocked share of rays from the
/// vertex [Wallace89].
float ShootingColumns::factor_at(std::size_t v, std::size_t p) const {
    const ElementId patch = mesh_.patches[p];
    const RegionId own = mesh_.vertices.region[v], source = mesh_.tree.region(patch);
    if (own == source) return 0;
    const Normal& n = input_.stage.scene.regions()[own].plane.n;
    const double F = point_to_polygon(mesh_.vertices.at[v], n, mesh_.tree.outline(patch));
    ++form_factors_;
    if (!(F > 0)) return 0;
    RandomStream random(input_.options.seed, Stream::shooting, v, p);
    const std::size_t count = samples();
    std::vector<Point> from(count, mesh_.vertices.at[v]), to(count);
    const auto grid = static_cast<std::size_t>(std::max(1.0, std::floor(std::sqrt(static_cast<double>(count)))));
    for (std::size_t i = 0; i < count; ++i) {
        const double step = 1.0 / static_cast<double>(grid);
        const double s = step * (static_cast<double>(i % grid) + random.uniform());
        const double t = step * (static_cast<double>(i / grid % grid) + random.uniform());
        to[i] = mesh_.tree.patch(patch).at(mesh_.tree.uniform(patch, s, t));
    }
    const std::unique_ptr<bool[]> blocked(new bool[count]);
    rays_ += input_.stage.tracer.occluded(from, to, own, source, {blocked.get(), count});
    const auto free = std::count(blocked.get(), blocked.get() + count, false);
    return static_cast<float>(F * static_cast<double>(free) / static_cast<double>(count));
}

/// Appends the missing rest of a column to the kept part if it fits into memory.
void ShootingColumns::keep_end(std::vector<float>& kept, std::span<const float> column) {
    const std::span<const float> end = column.subspan(kept.size());
    if (kept_bytes_ + end.size_bytes() > column_memory) return;
    kept_bytes_ += end.size_bytes();
    kept.insert(kept.end(), end.begin(), end.end());
}

/// Computes the entries of `column_` from receiver `first` on.
void ShootingColumns::fill_column(std::size_t patch, std::size_t first) {
    const std::size_t n = mesh_.receivers.size();
    std::fill(column_.begin() + static_cast<std::ptrdiff_t>(first), column_.end(), 0.0f);
    if (hemicubes_) {
        for (std::size_t i = first; i < n; ++i)
            column_[i] =
                static_cast<float>(hemicubes_->form_factor(patch, i) * mesh_.patch_area[patch] / mesh_.area[i]);
    } else if (ray_rows_) {
        const auto hits = ray_rows_->hits(patch);
        for (std::uint32_t hit : hits)
            if (hit != RayRows::missed)
                column_[hit] +=
                    static_cast<float>(mesh_.patch_area[patch] / mesh_.area[hit] / static_cast<double>(hits.size()));
    } else if (at_vertices_) {
        const std::span<const float> factors = of_vertices(patch);
        for (std::size_t i = first; i < n; ++i) {
            if (!mesh_.tree.is_leaf(mesh_.receivers[i])) continue;
            const std::vector<std::uint32_t>& around = mesh_.vertices.of_element[i];
            for (std::uint32_t v : around) column_[i] += factors[v] / static_cast<float>(around.size());
        }
    } else {
        std::vector<std::size_t> numbers;
        std::vector<ElementId> leaves;
        for (std::size_t i = first; i < n; ++i)
            if (mesh_.tree.is_leaf(mesh_.receivers[i])) numbers.push_back(i), leaves.push_back(mesh_.receivers[i]);
        std::vector<float> factors(leaves.size());
        transfer_.column(leaves, mesh_.patches[patch], factors);
        for (std::size_t k = 0; k < numbers.size(); ++k) column_[numbers[k]] = factors[k];
    }
}

std::span<const float> ShootingColumns::of_receivers(std::size_t patch) {
    std::vector<float>& kept = kept_[patch];
    if (kept.size() == mesh_.receivers.size()) return kept;
    column_.resize(mesh_.receivers.size());
    std::copy(kept.begin(), kept.end(), column_.begin());
    fill_column(patch, kept.size());
    keep_end(kept, column_);
    return column_;
}

std::span<const float> ShootingColumns::of_vertices(std::size_t patch) {
    std::vector<float>& kept = kept_at_vertices_[patch];
    const std::size_t first = kept.size(), count = mesh_.vertices.at.size();
    if (first == count) return kept;
    if (vertex_column_of_ == patch) return vertex_column_;
    vertex_column_of_ = patch;
    vertex_column_.resize(count);
    std::copy(kept.begin(), kept.end(), vertex_column_.begin());
    parallel_for(count - first, 16, [&](std::size_t i) { vertex_column_[first + i] = factor_at(first + i, patch); });
    keep_end(kept, vertex_column_);
    return vertex_column_;
}

void ShootingColumns::of_new_receivers(std::size_t patch, std::size_t first, std::span<double> factors) {
    column_.resize(mesh_.receivers.size());
    transfer_.column(std::span(mesh_.receivers).subspan(first), mesh_.patches[patch], std::span(column_).subspan(first),
                     factors);
    if (kept_[patch].size() == first) keep_end(kept_[patch], column_);
}

std::span<const float> ShootingColumns::of_new_vertices(std::size_t patch, std::size_t first) {
    parallel_for(vertex_column_.size() - first, 16,
                 [&](std::size_t i) { vertex_column_[first + i] = factor_at(first + i, patch); });
    if (kept_at_vertices_[patch].size() == first) keep_end(kept_at_vertices_[patch], vertex_column_);
    return vertex_column_;
}

void ShootingColumns::update_vertices() {
    vertex_column_.resize(mesh_.vertices.at.size());
    vertex_column_of_ = none;
}

void ShootingColumns::drop(std::size_t receiver) {
    for (std::vector<float>& kept : kept_)
        if (receiver < kept.size()) kept[receiver] = 0;
}

std::size_t ShootingColumns::rays() const {
    return transfer_.rays() + rays_ + (hemicubes_ ? hemicubes_->rays() : 0) + (ray_rows_ ? ray_rows_->rays() : 0);
}

}  // namespace exitance
