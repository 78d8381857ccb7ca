#include <cmath>
#include <memory>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/lab/classical/classical.hpp"
#include "exitance/lab/classical/corner_steps.hpp"
#include "exitance/lab/classical/element_vertices.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/solve/shooting.hpp"
#include "exitance/transport/hemicube_rows.hpp"
#include "exitance/transport/patch_transfer.hpp"

namespace exitance {
namespace {

constexpr double vertex_rounding = 1e-6;  // of the scene's size: corners of a region that are closer are one vertex

class Shooting {
  public:
    Shooting(const MethodInput& input, bool substructuring);

    SolveReport run();
    double unshot_share() const;
    void report(GlobalLight& light) const;

  private:
    std::size_t samples() const { return input_.options.visibility_samples.value_or(default_visibility_samples); }
    void cut(ElementId e);
    void add_receivers(std::size_t first_element);
    void drop_receiver(std::size_t i);
    std::vector<Spectrum> first_light() const;
    void make_rows();
    std::span<const float> column(std::size_t patch);
    std::span<const float> vertex_column(std::size_t patch);
    void fill_column(std::size_t patch, std::size_t first);
    void keep_end(std::vector<float>& kept, std::span<const float> column);
    float factor_at(std::size_t vertex, std::size_t patch) const;
    void add_vertices(std::span<const ElementId> elements);
    void note_change(const Spectrum& sent, std::span<const float> column);
    double least_area() const { return input_.options.min_area.value_or(default_min_share * input_.stage.area); }
    std::size_t refine();
    void gather_new(std::size_t first);
    void gather_new_at_centres(std::size_t first);
    SolveReport shoot_once();
    ElementFunction irradiance() const;
    Spectrum ambient() const;
    Spectrum mean_at_vertices(std::size_t receiver) const;

    const MethodInput& input_;
    bool at_vertices_;
    ElementTree tree_;
    std::vector<ElementId> patches_;
    Field<ElementId, std::uint32_t> patch_of_element_;
    std::unique_ptr<PatchTransfer> transfer_;
    std::optional<HemicubeRows> hemicubes_;
    std::optional<RayRows> ray_rows_;
    std::vector<double> patch_area_;
    std::vector<Spectrum> sent_, unshot_;  ///< Per patch.
    // Per receiver: the leaves in the order of their ids. Elements that have been cut since stay in the list, with area
    // and form factors of 0. Receivers keep their numbers; new ones are appended.
    std::vector<ElementId> receivers_;
    std::vector<double> area_;
    std::vector<std::uint32_t> patch_of_;
    std::vector<Spectrum> reflectance_, direct_, irradiance_;
    std::size_t leaf_count_ = 0;
    CornerSteps steps_;  ///< Steps of receivers, if they are refined.
    double change_ = 0;  ///< Bound on the change of light on any receiver since the last look at the steps, W/m^2.
    ElementVertices vertices_;
    std::vector<Spectrum> at_vertex_;
    std::vector<float> column_, vertex_column_;                ///< The columns computed last.
    std::size_t vertex_column_of_ = ~std::size_t(0);           ///< Patch of `vertex_column_`, or none.
    std::vector<std::vector<float>> kept_, kept_at_vertices_;  ///< Per patch; may lack the newest receivers.
    std::size_t kept_bytes_ = 0, shots_ = 0;
    mutable std::atomic<std::size_t> rays_{0}, form_factors_{0};
    double first_power_ = 0;
};

Shooting::Shooting(const MethodInput& input, bool substructuring)
    : input_(input),
      at_vertices_(input.options.classical.receivers == ShootingReceivers::vertex),
      tree_(constant_mesh(input.stage, input.options, input.knobs, input.stop)),
      patches_(tree_.leaves()),
      patch_of_element_(tree_.size()),
      sent_(patches_.size()),
      steps_(vertex_rounding * input.stage.scene.size()),
      kept_(patches_.size()),
      kept_at_vertices_(patches_.size()) {
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        patch_of_element_[patches_[p]] = static_cast<std::uint32_t>(p);
        patch_area_.push_back(tree_.area(patches_[p]));
    }
    if (substructuring)
        for (ElementId patch : patches_) cut(patch);
    transfer_ =
        std::make_unique<PatchTransfer>(input.stage, tree_, static_cast<unsigned>(samples()), input.options.seed);
    add_receivers(0);
    if (!carries_light(input)) direct_ = mean_direct_light(input, tree_, receivers_);
    unshot_ = first_light();
    first_power_ = unshot_power(unshot_, patch_area_);
    make_rows();
}

/// Cuts an element into four. Cells of contact lines are bisected twice across their longest extents.
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

/// Adds the leaves from `first_element` on as receivers.
void Shooting::add_receivers(std::size_t first_element) {
    const std::size_t first = receivers_.size();
    for (std::size_t i = first_element; i < tree_.size(); ++i) {
        const ElementId e(i);
        if (!tree_.is_leaf(e)) continue;
        receivers_.push_back(e);
        area_.push_back(tree_.area(e));
        patch_of_.push_back(patch_of_element_[e]);
        reflectance_.push_back(material_of(input_, tree_, e).reflectance);
        if (input_.options.classical.refine_gradient)
            steps_.add(tree_.region(e), tree_.patch(e), area_.back() / 4 >= least_area());
    }
    direct_.resize(receivers_.size()), irradiance_.resize(receivers_.size());
    leaf_count_ += receivers_.size() - first;
    if (at_vertices_) add_vertices(std::span(receivers_).subspan(first));
}

/// Removes the receiver of an element that has been cut.
void Shooting::drop_receiver(std::size_t i) {
    area_[i] = 0;
    direct_[i] = irradiance_[i] = {};
    steps_.remove(i);
    --leaf_count_;
    for (std::vector<float>& kept : kept_)
        if (i < kept.size()) kept[i] = 0;
}

/// Adds vertices. New ones gather the light that all patches have sent.
void Shooting::add_vertices(std::span<const ElementId> elements) {
    const std::size_t before = vertices_.at.size();
    vertices_.add(input_.stage, tree_, elements);
    const std::size_t fresh = vertices_.at.size() - before;
    at_vertex_.resize(vertices_.at.size());
    vertex_column_.resize(vertices_.at.size());
    vertex_column_of_ = ~std::size_t(0);
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        if (!(squared(sent_[p]) > 0)) continue;
        parallel_for(fresh, 16, [&](std::size_t i) {
            const std::size_t v = before + i;
            vertex_column_[v] = factor_at(v, p);
            at_vertex_[v] += static_cast<double>(vertex_column_[v]) * sent_[p];
        });
        if (kept_at_vertices_[p].size() == before) keep_end(kept_at_vertices_[p], vertex_column_);
    }
}

/// Initial unshot light of patches: their exitance, or the reflected direct light.
std::vector<Spectrum> Shooting::first_light() const {
    if (carries_light(input_)) return exitances(input_, tree_, patches_);
    std::vector<Spectrum> out(patches_.size());
    for (std::size_t i = 0; i < direct_.size(); ++i)
        out[patch_of_[i]] += (area_[i] / patch_area_[patch_of_[i]]) * (reflectance_[i] * direct_[i]);
    return out;
}

/// Computes rows of form factors of patches. Reciprocity turns them into the columns for shooting, F_ij = F_ji A_j /
/// A_i.
void Shooting::make_rows() {
    if (!input_.options.form_factors || input_.options.form_factors == FormFactorKind::analytic) return;
    const ElementLocator locator(tree_, input_.stage.scene.regions().size());
    const LeafNumbering numbering(tree_);
    const SolveOptions& o = input_.options;
    if (o.form_factors == FormFactorKind::hemicube) {
        hemicubes_.emplace(input_.stage, tree_, numbering, locator, hemicube_cells(o));
        return;
    }
    ray_rows_.emplace(input_.stage, tree_, numbering, locator, ray_budget(o, input_.knobs), o.seed);
}

/// Form factor from a vertex to a patch: exact for the polygon, times the unblocked share of rays from the vertex
/// [Wallace89].
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

/// Appends the missing rest of a column to the kept part if it fits into memory.
void Shooting::keep_end(std::vector<float>& kept, std::span<const float> column) {
    const std::span<const float> end = column.subspan(kept.size());
    if (kept_bytes_ + end.size_bytes() > column_memory) return;
    kept_bytes_ += end.size_bytes();
    kept.insert(kept.end(), end.begin(), end.end());
}

/// Form factors from all vertices to a patch.
std::span<const float> Shooting::vertex_column(std::size_t patch) {
    std::vector<float>& kept = kept_at_vertices_[patch];
    const std::size_t first = kept.size(), count = vertices_.at.size();
    if (first == count) return kept;
    if (vertex_column_of_ == patch) return vertex_column_;
    vertex_column_of_ = patch;
    vertex_column_.resize(count);
    std::copy(kept.begin(), kept.end(), vertex_column_.begin());
    parallel_for(count - first, 16, [&](std::size_t i) { vertex_column_[first + i] = factor_at(first + i, patch); });
    keep_end(kept, vertex_column_);
    return vertex_column_;
}

/// Computes the entries of `column_` from receiver `first` on.
void Shooting::fill_column(std::size_t patch, std::size_t first) {
    const std::size_t n = receivers_.size();
    std::fill(column_.begin() + static_cast<std::ptrdiff_t>(first), column_.end(), 0.0f);
    if (hemicubes_) {
        for (std::size_t i = first; i < n; ++i)
            column_[i] = static_cast<float>(hemicubes_->form_factor(patch, i) * patch_area_[patch] / area_[i]);
    } else if (ray_rows_) {
        const auto hits = ray_rows_->hits(patch);
        for (std::uint32_t hit : hits)
            if (hit != RayRows::missed)
                column_[hit] += static_cast<float>(patch_area_[patch] / area_[hit] / static_cast<double>(hits.size()));
    } else if (at_vertices_) {
        const std::span<const float> factors = vertex_column(patch);
        for (std::size_t i = first; i < n; ++i) {
            if (!tree_.is_leaf(receivers_[i])) continue;
            const std::vector<std::uint32_t>& around = vertices_.of_element[i];
            for (std::uint32_t v : around) column_[i] += factors[v] / static_cast<float>(around.size());
        }
    } else {
        std::vector<std::size_t> numbers;
        std::vector<ElementId> leaves;
        for (std::size_t i = first; i < n; ++i)
            if (tree_.is_leaf(receivers_[i])) numbers.push_back(i), leaves.push_back(receivers_[i]);
        std::vector<float> factors(leaves.size());
        transfer_->column(leaves, patches_[patch], factors);
        for (std::size_t k = 0; k < numbers.size(); ++k) column_[numbers[k]] = factors[k];
    }
}

/// Form factors from all receivers to a patch. Entries that are kept are not computed again.
std::span<const float> Shooting::column(std::size_t patch) {
    std::vector<float>& kept = kept_[patch];
    if (kept.size() == receivers_.size()) return kept;
    column_.resize(receivers_.size());
    std::copy(kept.begin(), kept.end(), column_.begin());
    fill_column(patch, kept.size());
    keep_end(kept, column_);
    return column_;
}

/// Shoots once, from the patch with the most unshot light.
SolveReport Shooting::shoot_once() {
    const std::vector<Spectrum> before = unshot_;
    std::size_t shooter = patches_.size();
    std::span<const float> to_receivers;
    const ShootingProblem problem{patch_of_, area_, patch_area_, reflectance_,
                                  [&](std::size_t patch) { return shooter = patch, to_receivers = column(patch); }};
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
    if (input_.options.classical.refine_gradient) note_change(sent, to_receivers);
    if (at_vertices_) {
        const std::span<const float> factors = vertex_column(shooter);
        for (std::size_t v = 0; v < at_vertex_.size(); ++v) at_vertex_[v] += static_cast<double>(factors[v]) * sent;
    }
    return report;
}

/// Adds to `change_` the largest change of light on a receiver by a shot.
void Shooting::note_change(const Spectrum& sent, std::span<const float> column) {
    double largest_sent = 0, change = 0;
    for (double s : sent.value) largest_sent = std::max(largest_sent, std::abs(s));
    for (std::size_t i = 0; i < column.size(); ++i) {
        const double rho = max(reflectance_[i]);
        change = std::max(change, (rho > 0 ? rho : 1) * static_cast<double>(column[i]));
    }
    change_ += change * largest_sent;
}

/// Cuts elements across which radiosity changes by more than the requested gradient; their parts gather the light that
/// all patches have sent. Returns the number of elements cut. O(receivers), and one form factor per new receiver and
/// patch.
std::size_t Shooting::refine() {
    // For black surfaces, irradiance is used instead of radiosity.
    const auto light = [&](std::size_t i) {
        const Spectrum arriving = direct_[i] + irradiance_[i];
        return max(reflectance_[i]) > 0 ? reflectance_[i] * arriving : arriving;
    };
    const std::vector<std::size_t> steep =
        steps_.steeper_than(*input_.options.classical.refine_gradient, std::exchange(change_, 0), light);
    if (steep.empty()) return 0;
    const std::size_t elements = tree_.size(), first = receivers_.size();
    for (std::size_t i : steep) cut(receivers_[i]), drop_receiver(i);
    transfer_->update_places();
    add_receivers(elements);
    gather_new(first);
    return steep.size();
}

/// Computes direct light and the light of all patches for the receivers from `first` on.
void Shooting::gather_new(std::size_t first) {
    const std::span<const ElementId> fresh = std::span(receivers_).subspan(first);
    if (!carries_light(input_)) {
        const std::vector<Spectrum> exact = mean_direct_light(input_, tree_, fresh);
        std::copy(exact.begin(), exact.end(), direct_.begin() + static_cast<std::ptrdiff_t>(first));
    }
    if (!at_vertices_) return gather_new_at_centres(first);
    for (std::size_t i = first; i < receivers_.size(); ++i) irradiance_[i] = mean_at_vertices(i);
}

void Shooting::gather_new_at_centres(std::size_t first) {
    const std::span<const ElementId> fresh = std::span(receivers_).subspan(first);
    std::vector<double> factors(fresh.size());
    column_.resize(receivers_.size());
    const std::span<float> column = std::span(column_).subspan(first);
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        if (!(squared(sent_[p]) > 0)) continue;
        transfer_->column(fresh, patches_[p], column, factors);
        for (std::size_t k = 0; k < fresh.size(); ++k) irradiance_[first + k] += factors[k] * sent_[p];
        if (kept_[p].size() == first) keep_end(kept_[p], column_);
    }
}

/// Unshot power, relative to the initial power.
double Shooting::unshot_share() const {
    return first_power_ > 0 ? unshot_power(unshot_, patch_area_) / first_power_ : 0;
}

SolveReport Shooting::run() {
    const auto& c = input_.options.classical;
    const bool refines = c.refine_gradient.has_value();
    const bool during = refines && c.refine.value_or(RefineWhen::during) == RefineWhen::during;
    const std::size_t max_shots = input_.options.max_iterations.value_or(1'000'000);
    SolveReport report;
    SafePoints safe_points = input_.safe_points;
    const auto state = [&](auto& a) { a(shots_, unshot_, sent_, irradiance_, at_vertex_); };
    // The elements that refinement makes are not saved: with it, a resumed run starts from the beginning.
    if (!refines) safe_points.resume(state);
    for (;;) {
        if (!refines) safe_points.pass(state);
        const std::size_t left = shots_;
        report = shoot_once();
        if (report.iterations > 0) {
            ++shots_;
            if (during) refine();
            input_.end_shot(shots_, [&] {
                GlobalLight so_far = published_light(input_);
                this->report(so_far);
                so_far.report.iterations = shots_;
                so_far.report.residual = unshot_share();
                return so_far;
            });
        }
        if (report.converged || report.interrupted || shots_ == left || shots_ >= max_shots) break;
    }
    constexpr int max_depth = 16;
    for (int depth = 0; refines && !during && depth < max_depth && !input_.stop.requested() && refine() > 0; ++depth) {
    }
    report.iterations = shots_;
    report.residual = unshot_share();
    report.converged = report.residual <= input_.knobs.residual;
    return report;
}

/// Mean irradiance of the vertices around a receiver.
Spectrum Shooting::mean_at_vertices(std::size_t receiver) const {
    const std::vector<std::uint32_t>& around = vertices_.of_element[receiver];
    Spectrum sum;
    for (std::uint32_t v : around) sum += at_vertex_[v];
    return sum / static_cast<double>(around.size());
}

/// Ambient term: unshot light spread over all surfaces, with all its reflections [Cohen88]. For display.
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
    const Spectrum more = input_.options.classical.ambient ? ambient() : Spectrum();
    ElementFunction out;
    out.tree = tree_;
    out.first_value.resize(tree_.size(), 0);
    for (std::size_t i = 0; i < receivers_.size(); ++i) {
        const ElementId leaf = receivers_[i];
        if (!tree_.is_leaf(leaf)) continue;
        out.first_value[leaf] = static_cast<std::uint32_t>(out.values.size());
        if (!at_vertices_) {
            for (int k = 0; k < 4; ++k) out.add_value(irradiance_[i] + more);
            continue;
        }
        // The corners of a cell differ from those of its frame, so its mean is returned.
        for (int k = 0; k < tree_.patch(leaf).corner_count(); ++k)
            out.add_value(more + (tree_.is_cell(leaf)
                                      ? mean_at_vertices(i)
                                      : at_vertex_[vertices_.of_element[i][static_cast<std::size_t>(k)]]));
    }
    return out;
}

void Shooting::report(GlobalLight& light) const {
    light.published->irradiance = irradiance();
    light.published->elements = tree_.size(), light.published->leaf_elements = leaf_count_;
    light.work.rays =
        transfer_->rays() + rays_ + (hemicubes_ ? hemicubes_->rays() : 0) + (ray_rows_ ? ray_rows_->rays() : 0);
    light.work.form_factors = transfer_->form_factors() + form_factors_;
    light.work.link_memory_bytes = kept_bytes_;
    light.published->figures["coefficient_memory_bytes"] =
        static_cast<double>(sizeof(Spectrum) * (2 * patches_.size() + 2 * leaf_count_ + at_vertex_.size()));
}

/// Progressive refinement [Cohen88] and substructuring [Cohen86]: the patch with the most unshot light shoots it to all
/// elements, either at their centres or at their vertices with (bi)linear interpolation [Wallace89]. With
/// substructuring, patches are cut into four elements. If `--refine-gradient` is given, these are cut further while
/// light is shot or afterwards. One column of form factors per shot.
GlobalLight shoot_as_published(const MethodInput& input, bool substructuring) {
    GlobalLight light = published_light(input);
    input.progress.phase("mesh");
    Shooting shooting(input, substructuring);
    input.progress.phase("shoot");
    light.report = shooting.run();
    shooting.report(light);
    return light;
}

}  // namespace

GlobalLight solve_classical_shooting(const MethodInput& input) {
    return shoot_as_published(input, false);
}

GlobalLight solve_classical_substructuring(const MethodInput& input) {
    return shoot_as_published(input, true);
}

}  // namespace exitance
