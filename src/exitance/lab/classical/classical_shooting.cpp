#include <cmath>
#include <utility>

#include "exitance/lab/classical/corner_steps.hpp"
#include "exitance/lab/classical/shooting_columns.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/solve/shooting.hpp"

namespace exitance {
namespace {

constexpr double vertex_rounding = 1e-6;  // share of the scene's size; closer corners of a region are one vertex

class Shooting {
  public:
    Shooting(const MethodInput& input, bool substructuring);

    SolveReport run();
    double unshot_share() const;
    void report(GlobalLight& light) const;

  private:
    void cut(ElementId e);
    void add_receivers(std::size_t first_element);
    void drop_receiver(std::size_t i);
    std::vector<Spectrum> first_light() const;
    void add_vertices(std::span<const ElementId> elements);
    void note_change(const Spectrum& sent, std::span<const float> column);
    double min_area() const { return input_.options.min_area.value_or(default_min_share * input_.stage.area); }
    std::size_t refine();
    void gather_new(std::size_t first);
    void gather_new_at_centres(std::size_t first);
    SolveReport shoot_once();
    ElementFunction irradiance() const;
    Spectrum ambient() const;
    Spectrum mean_at_vertices(std::size_t receiver) const;

    const MethodInput& input_;
    bool at_vertices_;
    ShootingMesh mesh_;
    std::optional<ShootingColumns> columns_;
    Field<ElementId, std::uint32_t> patch_of_element_;
    std::vector<Spectrum> sent_, unshot_;                      ///< Per patch.
    std::vector<std::uint32_t> patch_of_;                      ///< Per receiver.
    std::vector<Spectrum> reflectance_, direct_, irradiance_;  ///< Per receiver.
    std::size_t leaf_count_ = 0;
    CornerSteps steps_;  ///< Steps of receivers, if they are refined.
    double change_ = 0;  ///< Bound on the change of light on any receiver since the steps were last evaluated, W/m^2.
    std::vector<Spectrum> at_vertex_;
    std::size_t shots_ = 0;
    double first_power_ = 0;
};

Shooting::Shooting(const MethodInput& input, bool substructuring)
    : input_(input),
      at_vertices_(input.options.classical.receivers == ShootingReceivers::vertex),
      mesh_(constant_mesh(input.stage, input.options, input.knobs, input.stop)),
      patch_of_element_(mesh_.tree.size()),
      sent_(mesh_.patches.size()),
      steps_(vertex_rounding * input.stage.scene.size()) {
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
        patch_of_element_[mesh_.patches[p]] = static_cast<std::uint32_t>(p);
    if (substructuring)
        for (ElementId patch : mesh_.patches) cut(patch);
    columns_.emplace(input, mesh_);
    add_receivers(0);
    if (!carries_light(input)) direct_ = mean_direct_light(input, mesh_.tree, mesh_.receivers);
    unshot_ = first_light();
    first_power_ = unshot_power(unshot_, mesh_.patch_area);
}

/// Cuts an element into four. Cells of contact lines are bisected twice across their longest extents.
void Shooting::cut(ElementId e) {
    const std::uint32_t patch = patch_of_element_[e];
    if (mesh_.tree.is_cell(e)) {
        const IdRange<ElementId> halves = refine_element(mesh_.tree, e);
        for (ElementId half : halves) refine_element(mesh_.tree, half);
    } else {
        mesh_.tree.split(e, Cut::both);
    }
    patch_of_element_.resize(mesh_.tree.size(), patch);
}

/// Adds the leaves from `first_element` on as receivers.
void Shooting::add_receivers(std::size_t first_element) {
    const std::size_t first = mesh_.receivers.size();
    for (std::size_t i = first_element; i < mesh_.tree.size(); ++i) {
        const ElementId e(i);
        if (!mesh_.tree.is_leaf(e)) continue;
        mesh_.receivers.push_back(e);
        mesh_.area.push_back(mesh_.tree.area(e));
        patch_of_.push_back(patch_of_element_[e]);
        reflectance_.push_back(material_of(input_, mesh_.tree, e).reflectance);
        if (input_.options.classical.refine_gradient)
            steps_.add(mesh_.tree.region(e), mesh_.tree.patch(e), mesh_.area.back() / 4 >= min_area());
    }
    direct_.resize(mesh_.receivers.size()), irradiance_.resize(mesh_.receivers.size());
    leaf_count_ += mesh_.receivers.size() - first;
    if (at_vertices_) add_vertices(std::span(mesh_.receivers).subspan(first));
}

/// Removes the receiver of an element that has been cut.
void Shooting::drop_receiver(std::size_t i) {
    mesh_.area[i] = 0;
    direct_[i] = irradiance_[i] = {};
    steps_.remove(i);
    --leaf_count_;
    columns_->drop(i);
}

/// Adds vertices. New ones gather the light that all patches have sent.
void Shooting::add_vertices(std::span<const ElementId> elements) {
    const std::size_t before = mesh_.vertices.at.size();
    mesh_.vertices.add(input_.stage, mesh_.tree, elements);
    at_vertex_.resize(mesh_.vertices.at.size());
    columns_->update_vertices();
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
        if (!(squared(sent_[p]) > 0)) continue;
        const std::span<const float> factors = columns_->of_new_vertices(p, before);
        for (std::size_t v = before; v < factors.size(); ++v)
            at_vertex_[v] += static_cast<double>(factors[v]) * sent_[p];
    }
}

/// Initial unshot light of patches: their exitance, or the reflected direct light.
std::vector<Spectrum> Shooting::first_light() const {
    if (carries_light(input_)) return exitances(input_, mesh_.tree, mesh_.patches);
    std::vector<Spectrum> out(mesh_.patches.size());
    for (std::size_t i = 0; i < direct_.size(); ++i)
        out[patch_of_[i]] += (mesh_.area[i] / mesh_.patch_area[patch_of_[i]]) * (reflectance_[i] * direct_[i]);
    return out;
}

/// Shoots once, from the patch with the most unshot light.
SolveReport Shooting::shoot_once() {
    const std::vector<Spectrum> before = unshot_;
    std::size_t shooter = mesh_.patches.size();
    std::span<const float> to_receivers;
    const ShootingProblem problem{patch_of_, mesh_.area, mesh_.patch_area, reflectance_, [&](std::size_t patch) {
                                      return shooter = patch, to_receivers = columns_->of_receivers(patch);
                                  }};
    const SolveReport report = shoot(problem,
                                     {.overshooting = input_.options.overshooting,
                                      .unshot = input_.knobs.residual,
                                      .reference = first_power_,
                                      .max_shots = 1,
                                      .request = &input_.stop},
                                     unshot_, irradiance_);
    if (shooter == mesh_.patches.size()) return report;
    const Spectrum sent = before[shooter] - unshot_[shooter];
    sent_[shooter] += sent;
    if (input_.options.classical.refine_gradient) note_change(sent, to_receivers);
    if (at_vertices_) {
        const std::span<const float> factors = columns_->of_vertices(shooter);
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
    const std::size_t elements = mesh_.tree.size(), first = mesh_.receivers.size();
    for (std::size_t i : steep) cut(mesh_.receivers[i]), drop_receiver(i);
    columns_->update_elements();
    add_receivers(elements);
    gather_new(first);
    return steep.size();
}

/// Computes direct light and the light of all patches for the receivers from `first` on.
void Shooting::gather_new(std::size_t first) {
    const std::span<const ElementId> fresh = std::span(mesh_.receivers).subspan(first);
    if (!carries_light(input_)) {
        const std::vector<Spectrum> exact = mean_direct_light(input_, mesh_.tree, fresh);
        std::copy(exact.begin(), exact.end(), direct_.begin() + static_cast<std::ptrdiff_t>(first));
    }
    if (!at_vertices_) return gather_new_at_centres(first);
    for (std::size_t i = first; i < mesh_.receivers.size(); ++i) irradiance_[i] = mean_at_vertices(i);
}

void Shooting::gather_new_at_centres(std::size_t first) {
    std::vector<double> factors(mesh_.receivers.size() - first);
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
        if (!(squared(sent_[p]) > 0)) continue;
        columns_->of_new_receivers(p, first, factors);
        for (std::size_t k = 0; k < factors.size(); ++k) irradiance_[first + k] += factors[k] * sent_[p];
    }
}

/// Unshot power, relative to the initial power.
double Shooting::unshot_share() const {
    return first_power_ > 0 ? unshot_power(unshot_, mesh_.patch_area) / first_power_ : 0;
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
    const std::vector<std::uint32_t>& around = mesh_.vertices.of_element[receiver];
    Spectrum sum;
    for (std::uint32_t v : around) sum += at_vertex_[v];
    return sum / static_cast<double>(around.size());
}

/// Ambient term: unshot light spread over all surfaces, with all its reflections [Cohen88]. For display.
Spectrum Shooting::ambient() const {
    Spectrum flux, reflected;
    double whole = 0;
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
        flux += mesh_.patch_area[p] * unshot_[p], whole += mesh_.patch_area[p];
    for (std::size_t i = 0; i < mesh_.area.size(); ++i) reflected += (mesh_.area[i] / whole) * reflectance_[i];
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = std::max(0.0, flux[b]) / (whole * (1 - reflected[b]));
    return out;
}

ElementFunction Shooting::irradiance() const {
    const Spectrum more = input_.options.classical.ambient ? ambient() : Spectrum();
    ElementFunction out;
    out.tree = mesh_.tree;
    out.first_value.resize(mesh_.tree.size(), 0);
    for (std::size_t i = 0; i < mesh_.receivers.size(); ++i) {
        const ElementId leaf = mesh_.receivers[i];
        if (!mesh_.tree.is_leaf(leaf)) continue;
        out.first_value[leaf] = static_cast<std::uint32_t>(out.values.size());
        if (!at_vertices_) {
            for (int k = 0; k < 4; ++k) out.add_value(irradiance_[i] + more);
            continue;
        }
        // The corners of a cell differ from those of its frame, so its mean is returned.
        for (int k = 0; k < mesh_.tree.patch(leaf).corner_count(); ++k)
            out.add_value(more + (mesh_.tree.is_cell(leaf)
                                      ? mean_at_vertices(i)
                                      : at_vertex_[mesh_.vertices.of_element[i][static_cast<std::size_t>(k)]]));
    }
    return out;
}

void Shooting::report(GlobalLight& light) const {
    light.published->irradiance = irradiance();
    light.published->elements = mesh_.tree.size(), light.published->leaf_elements = leaf_count_;
    light.work.rays = columns_->rays();
    light.work.form_factors = columns_->form_factors();
    light.work.link_memory_bytes = columns_->kept_bytes();
    light.published->figures["coefficient_memory_bytes"] =
        static_cast<double>(sizeof(Spectrum) * (2 * mesh_.patches.size() + 2 * leaf_count_ + at_vertex_.size()));
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
