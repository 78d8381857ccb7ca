#include <cmath>
#include <memory>

#include "exitance/core/parallel.hpp"
#include "exitance/core/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/methods/classical/classical_input.hpp"
#include "exitance/methods/classical/element_vertices.hpp"
#include "exitance/methods/classical/vertex_averages.hpp"
#include "exitance/solve/shooting.hpp"
#include "exitance/transport/hemicube_rows.hpp"
#include "exitance/transport/patch_transfer.hpp"

namespace exitance {
namespace {

constexpr std::size_t default_visibility_samples = 16;
constexpr unsigned default_hemicube_cells = 64;
constexpr std::size_t column_memory = std::size_t{1} << 29;  // bytes of columns that are kept for later shots
constexpr double default_least_share = 1.0 / 65536;          // of the scene's area: no element is cut smaller

class Shooting {
  public:
    Shooting(const ClassicalInput& input, bool substructuring)
        : input_(input),
          at_vertices_(input.classical.receivers == ShootingReceivers::vertex),
          tree_(constant_mesh(input)),
          patches_(tree_.leaves()),
          transfer_(nullptr) {
        for (std::size_t p = 0; p < patches_.size(); ++p) {
            patch_of_element_.resize(std::max<std::size_t>(patch_of_element_.size(), patches_[p].value + 1));
            patch_of_element_[patches_[p]] = static_cast<std::uint32_t>(p);
            patch_area_.push_back(tree_.area(patches_[p]));
        }
        patch_of_element_.resize(tree_.size());
        if (substructuring)
            for (ElementId patch : patches_) cut(patch);
        transfer_ =
            std::make_unique<PatchTransfer>(input.stage, tree_, static_cast<unsigned>(samples()), input.options.seed);
        sent_.resize(patches_.size());
        number_leaves();
        direct_.assign(numbering_.leaves.size(), {});
        if (!input.carries()) direct_ = mean_direct_light(input, tree_, numbering_.leaves);
        irradiance_.assign(numbering_.leaves.size(), {});
        unshot_ = first_light();
        first_power_ = unshot_power(unshot_, patch_area_);
        make_rows();
    }

    SolveReport run();
    double unshot_share() const;
    void report(ClassicalLight& light) const;

  private:
    std::size_t samples() const { return input_.options.visibility_samples.value_or(default_visibility_samples); }
    void cut(ElementId e);
    void number_leaves();
    std::vector<Spectrum> first_light() const;
    void make_rows();
    std::span<const float> column(std::size_t patch);
    void vertex_column(std::size_t patch);
    float factor_at(std::size_t vertex, std::size_t patch) const;
    std::size_t refine();
    void gather_anew(std::span<const std::uint32_t> fresh);
    SolveReport shoot_once();
    ElementFunction irradiance() const;
    Spectrum ambient() const;
    Spectrum mean_at_vertices(std::size_t leaf) const;

    const ClassicalInput& input_;
    bool at_vertices_;
    ElementTree tree_;
    std::vector<ElementId> patches_;
    Field<ElementId, std::uint32_t> patch_of_element_;
    std::unique_ptr<PatchTransfer> transfer_;
    std::optional<HemicubeRows> hemicubes_;
    std::optional<RayRows> ray_rows_;
    LeafNumbering numbering_;
    std::vector<double> patch_area_, area_;
    std::vector<std::uint32_t> patch_of_;
    std::vector<Spectrum> sent_, unshot_, reflectance_, direct_, irradiance_, at_vertex_;
    ElementVertices vertices_;
    std::vector<float> column_, vertex_factors_;
    std::vector<std::vector<float>> kept_, kept_at_vertices_;
    std::size_t kept_bytes_ = 0, shots_ = 0;
    mutable std::atomic<std::size_t> rays_{0}, form_factors_{0};
    double first_power_ = 0;
};

/// Into four; cells, which contacts have cut off, across their longest extents.
void Shooting::cut(ElementId e) {
    const std::uint32_t patch = patch_of_element_[e];
    if (tree_.is_cell(e)) {
        const IdRange<ElementId> halves = refine_element(tree_, e);
        for (ElementId half : halves) refine_element(tree_, half);
    } else {
        tree_.split(e, Cut::both);
    }
    patch_of_element_.resize(tree_.size(), patch);
}

void Shooting::number_leaves() {
    numbering_ = LeafNumbering(tree_);
    area_ = leaf_areas(tree_, numbering_);
    reflectance_ = leaf_reflectances(input_.stage.scene, tree_, numbering_);
    patch_of_.clear();
    for (ElementId e : numbering_.leaves) patch_of_.push_back(patch_of_element_[e]);
    kept_.assign(patches_.size(), {}), kept_at_vertices_.assign(patches_.size(), {});
    kept_bytes_ = 0;
    if (!at_vertices_) return;
    vertices_.update(input_.stage, tree_, numbering_.leaves);
    const std::size_t before = at_vertex_.size();
    at_vertex_.resize(vertices_.at.size());
    parallel_for(at_vertex_.size() - before, 4, [&](std::size_t i) {
        for (std::size_t p = 0; p < patches_.size(); ++p)
            if (squared(sent_[p]) > 0)
                at_vertex_[before + i] += static_cast<double>(factor_at(before + i, p)) * sent_[p];
    });
}

/// What patches have to send at first: what they emit, or reflect of the direct light.
std::vector<Spectrum> Shooting::first_light() const {
    if (input_.carries()) return exitances(input_, tree_, patches_);
    std::vector<Spectrum> out(patches_.size());
    for (std::size_t i = 0; i < direct_.size(); ++i)
        out[patch_of_[i]] += (area_[i] / patch_area_[patch_of_[i]]) * (reflectance_[i] * direct_[i]);
    return out;
}

/// Rows of what a patch sees, which reciprocity makes the columns that it shoots by, F_ij = F_ji A_j / A_i.
void Shooting::make_rows() {
    if (!input_.options.form_factors || input_.options.form_factors == FormFactorKind::analytic) return;
    const ElementLocator locator(tree_, input_.stage.scene.regions().size());
    const SolveOptions& o = input_.options;
    if (o.form_factors == FormFactorKind::hemicube) {
        const auto cells =
            static_cast<unsigned>(std::min<std::size_t>(1024, o.hemicube_cells.value_or(default_hemicube_cells)));
        hemicubes_.emplace(input_.stage, tree_, numbering_, locator, 2 * ((cells + 1) / 2));
        return;
    }
    RayBudget budget = input_.knobs.solve_rays;
    if (o.visibility_samples) budget.average = static_cast<double>(samples());
    ray_rows_.emplace(input_.stage, tree_, numbering_, locator, budget, o.seed);
}

/// Exactly towards the polygon, times the share of rays from the vertex that meet nothing [Wallace89].
float Shooting::factor_at(std::size_t v, std::size_t p) const {
    const ElementId patch = patches_[p];
    const RegionId own = vertices_.region[v], source = tree_.region(patch);
    if (own == source) return 0;
    const Normal& n = input_.stage.scene.regions()[own].plane.n;
    const double F = point_to_polygon(vertices_.at[v], n, tree_.outline(patch));
    ++form_factors_;
    if (!(F > 0)) return 0;
    RandomStream random(input_.options.seed, Stream::shooting, v, p);
    const std::size_t count = samples();
    std::vector<Point> from(count, vertices_.at[v]), to(count);
    const auto grid = static_cast<std::size_t>(std::max(1.0, std::floor(std::sqrt(static_cast<double>(count)))));
    for (std::size_t i = 0; i < count; ++i) {
        const double step = 1.0 / static_cast<double>(grid);
        const double s = step * (static_cast<double>(i % grid) + random.uniform());
        const double t = step * (static_cast<double>(i / grid % grid) + random.uniform());
        to[i] = tree_.patch(patch).at(tree_.uniform(patch, s, t));
    }
    const std::unique_ptr<bool[]> blocked(new bool[count]);
    rays_ += input_.stage.tracer.occluded(from, to, own, source, {blocked.get(), count});
    const auto free = std::count(blocked.get(), blocked.get() + count, false);
    return static_cast<float>(F * static_cast<double>(free) / static_cast<double>(count));
}

void Shooting::vertex_column(std::size_t patch) {
    vertex_factors_.resize(vertices_.at.size());
    parallel_for(vertices_.at.size(), 16, [&](std::size_t v) { vertex_factors_[v] = factor_at(v, patch); });
    for (std::size_t i = 0; i < numbering_.leaves.size(); ++i) {
        const std::vector<std::uint32_t>& around = vertices_.of_leaf[i];
        column_[i] = 0;
        for (std::uint32_t v : around) column_[i] += vertex_factors_[v] / static_cast<float>(around.size());
    }
}

std::span<const float> Shooting::column(std::size_t patch) {
    const std::size_t n = numbering_.leaves.size();
    if (kept_[patch].size() == n) {
        if (at_vertices_) vertex_factors_ = kept_at_vertices_[patch];
        return kept_[patch];
    }
    column_.assign(n, 0);
    if (hemicubes_) {
        for (std::size_t i = 0; i < n; ++i)
            column_[i] = static_cast<float>(hemicubes_->form_factor(patch, i) * patch_area_[patch] / area_[i]);
    } else if (ray_rows_) {
        const auto hits = ray_rows_->hits(patch);
        for (std::uint32_t hit : hits)
            if (hit != RayRows::missed)
                column_[hit] += static_cast<float>(patch_area_[patch] / area_[hit] / static_cast<double>(hits.size()));
    } else if (at_vertices_) {
        vertex_column(patch);
    } else {
        transfer_->column(numbering_.leaves, patches_[patch], column_);
    }
    const std::size_t bytes = sizeof(float) * (n + (at_vertices_ ? vertex_factors_.size() : 0));
    if (kept_bytes_ + bytes > column_memory) return column_;
    kept_bytes_ += bytes;
    if (at_vertices_) kept_at_vertices_[patch] = vertex_factors_;
    return kept_[patch] = column_;
}

/// One shot, of the patch with most to send.
SolveReport Shooting::shoot_once() {
    const std::vector<Spectrum> before = unshot_;
    std::size_t shooter = patches_.size();
    const ShootingProblem problem{patch_of_, area_, patch_area_, reflectance_,
                                  [&](std::size_t patch) { return shooter = patch, column(patch); }};
    const SolveReport report = shoot(problem,
                                     {.overshooting = input_.options.overshooting,
                                      .unshot = input_.knobs.residual,
                                      .reference = first_power_,
                                      .max_shots = 1,
                                      .request = &input_.stop},
                                     unshot_, irradiance_);
    if (shooter == patches_.size()) return report;
    const Spectrum sent = before[shooter] - unshot_[shooter];
    sent_[shooter] += sent;
    if (at_vertices_)
        for (std::size_t v = 0; v < at_vertex_.size(); ++v)
            at_vertex_[v] += static_cast<double>(vertex_factors_[v]) * sent;
    return report;
}

/// Elements across which radiosity changes by more than asked for are cut, and gather anew what all patches have sent.
/// Returns how many.
std::size_t Shooting::refine() {
    const double least = input_.options.min_area.value_or(default_least_share * input_.stage.area);
    std::vector<Spectrum> b(irradiance_.size());
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = reflectance_[i] * (direct_[i] + irradiance_[i]);
    // On black surfaces what arrives is what there is to follow.
    for (std::size_t i = 0; i < b.size(); ++i)
        if (max(reflectance_[i]) == 0) b[i] = direct_[i] + irradiance_[i];
    const ElementFunction f =
        averaged_at_vertices(constant_function(tree_, numbering_.leaves, b), 1e-6 * input_.stage.scene.size());
    std::vector<ElementId> steep;
    for (ElementId e : numbering_.leaves) {
        const Patch& patch = tree_.patch(e);
        if (tree_.area(e) / 4 < least) continue;
        Spectrum lo(HUGE_VAL), hi(-HUGE_VAL);
        for (int k = 0; k < patch.corner_count(); ++k) {
            const Spectrum v = f.at({e, patch.corner_uv(k)});
            for (std::size_t band = 0; band < bands; ++band)
                lo[band] = std::min(lo[band], v[band]), hi[band] = std::max(hi[band], v[band]);
        }
        if (max(hi - lo) > *input_.classical.refine_gradient) steep.push_back(e);
    }
    if (steep.empty()) return 0;
    Field<ElementId, std::uint32_t> old(tree_.size());
    for (std::size_t i = 0; i < numbering_.leaves.size(); ++i)
        old[numbering_.leaves[i]] = static_cast<std::uint32_t>(i);
    const std::size_t size = tree_.size();
    for (ElementId e : steep) cut(e);
    transfer_->update_places();
    const std::vector<Spectrum> old_irradiance = irradiance_, old_direct = direct_;
    number_leaves();
    irradiance_.assign(numbering_.leaves.size(), {}), direct_ = irradiance_;
    std::vector<std::uint32_t> fresh;
    for (std::uint32_t i = 0; i < numbering_.leaves.size(); ++i) {
        const ElementId e = numbering_.leaves[i];
        if (e.value >= size)
            fresh.push_back(i);
        else
            irradiance_[i] = old_irradiance[old[e]], direct_[i] = old_direct[old[e]];
    }
    gather_anew(fresh);
    return steep.size();
}

void Shooting::gather_anew(std::span<const std::uint32_t> fresh) {
    std::vector<ElementId> elements;
    for (std::uint32_t i : fresh) elements.push_back(numbering_.leaves[i]);
    if (!input_.carries()) {
        const std::vector<Spectrum> exact = mean_direct_light(input_, tree_, elements);
        for (std::size_t k = 0; k < fresh.size(); ++k) direct_[fresh[k]] = exact[k];
    }
    parallel_for(fresh.size(), 4, [&](std::size_t k) {
        const std::uint32_t i = fresh[k];
        if (at_vertices_) {
            irradiance_[i] = mean_at_vertices(i);
            return;
        }
        PatchTransfer::Workspace workspace;
        for (std::size_t p = 0; p < patches_.size(); ++p)
            if (squared(sent_[p]) > 0)
                irradiance_[i] += transfer_->form_factor(elements[k], patches_[p], workspace) * sent_[p];
        transfer_->count(workspace);
    });
}

/// Of the power that there was at first.
double Shooting::unshot_share() const {
    return first_power_ > 0 ? unshot_power(unshot_, patch_area_) / first_power_ : 0;
}

SolveReport Shooting::run() {
    const auto& c = input_.classical;
    const bool refines = c.refine_gradient.has_value();
    const bool during = refines && c.refine.value_or(RefineWhen::during) == RefineWhen::during;
    const std::size_t most = input_.options.max_iterations.value_or(1'000'000);
    SolveReport report;
    for (;;) {
        const std::size_t left = shots_;
        report = shoot_once();
        if (report.iterations > 0) {
            ++shots_;
            if (during) refine();
            input_.snapshots.after_shot(shots_, [&] {
                ClassicalLight so_far;
                this->report(so_far);
                so_far.report.iterations = shots_;
                so_far.report.residual = unshot_share();
                return so_far;
            });
        }
        if (report.converged || report.interrupted || shots_ == left || shots_ >= most) break;
    }
    constexpr int most_depth = 16;
    for (int depth = 0; refines && !during && depth < most_depth && !input_.stop.requested() && refine() > 0; ++depth) {
    }
    report.iterations = shots_;
    report.residual = unshot_share();
    report.converged = report.residual <= input_.knobs.residual;
    return report;
}

/// Of what has arrived around a leaf.
Spectrum Shooting::mean_at_vertices(std::size_t leaf) const {
    const std::vector<std::uint32_t>& around = vertices_.of_leaf[leaf];
    Spectrum sum;
    for (std::uint32_t v : around) sum += at_vertex_[v];
    return sum / static_cast<double>(around.size());
}

/// What is unshot, spread over all surfaces, with all its reflections [Cohen88]: for display.
Spectrum Shooting::ambient() const {
    Spectrum flux, reflected;
    double whole = 0;
    for (std::size_t p = 0; p < patches_.size(); ++p) flux += patch_area_[p] * unshot_[p], whole += patch_area_[p];
    for (std::size_t i = 0; i < area_.size(); ++i) reflected += (area_[i] / whole) * reflectance_[i];
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = std::max(0.0, flux[b]) / (whole * (1 - reflected[b]));
    return out;
}

ElementFunction Shooting::irradiance() const {
    const Spectrum more = input_.classical.ambient ? ambient() : Spectrum();
    std::vector<Spectrum> E = irradiance_;
    for (Spectrum& value : E) value += more;
    if (!at_vertices_) return constant_function(tree_, numbering_.leaves, E);
    ElementFunction out;
    out.tree = tree_;
    out.first_value.resize(tree_.size(), 0);
    for (std::size_t i = 0; i < numbering_.leaves.size(); ++i) {
        out.first_value[numbering_.leaves[i]] = static_cast<std::uint32_t>(out.values.size());
        // The corners of a cell are not those of its frame: it is delivered as its mean.
        const ElementId leaf = numbering_.leaves[i];
        for (int k = 0; k < tree_.patch(leaf).corner_count(); ++k)
            out.add_value(more + (tree_.is_cell(leaf) ? mean_at_vertices(i)
                                                      : at_vertex_[vertices_.of_leaf[i][static_cast<std::size_t>(k)]]));
    }
    return out;
}

void Shooting::report(ClassicalLight& light) const {
    light.irradiance = irradiance();
    light.elements = tree_.size(), light.leaf_elements = numbering_.leaves.size();
    light.rays =
        transfer_->rays() + rays_ + (hemicubes_ ? hemicubes_->rays() : 0) + (ray_rows_ ? ray_rows_->rays() : 0);
    light.form_factors = transfer_->form_factors() + form_factors_;
    light.link_memory_bytes = kept_bytes_;
    light.coefficient_memory_bytes =
        sizeof(Spectrum) * (2 * patches_.size() + 2 * numbering_.leaves.size() + at_vertex_.size());
}

}  // namespace

/// Progressive refinement [Cohen88] and substructuring [Cohen86]: the patch with most to send shoots it to all
/// elements, at their middles, or at their vertices with (bi)linear functions in between [Wallace89]. Substructuring:
/// patches are cut into four elements, and those, where `--refine-gradient` asks for it, while light is shot or once it
/// is. A column of form factors a shot.
ClassicalLight solve_classical_shooting(const ClassicalInput& input, bool substructuring) {
    ClassicalLight light;
    input.progress.phase("shoot");
    Shooting shooting(input, substructuring);
    light.report = shooting.run();
    shooting.report(light);
    return light;
}

}  // namespace exitance
