#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/what_if/light_groups/cast_transport.hpp"
#include "exitance/what_if/light_groups/group_direct.hpp"
#include "exitance/what_if/light_groups/group_errors.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"
#include "exitance/what_if/light_groups/reflected_light.hpp"

namespace exitance {
namespace {

/// Returns the number of values that a file of `function` holds, one per corner of a leaf. In memory, dark leaves share
/// some.
std::size_t value_count(const ElementFunction& function) {
    std::size_t count = 0;
    for (const ElementId e : function.tree.leaves())
        count += static_cast<std::size_t>(function.tree.patch(e).corner_count());
    return std::max(count, function.values.size());
}

CornerValues as_floats(const std::vector<Spectrum>& values) {
    CornerValues out(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t band = 0; band < bands; ++band) out[i][band] = static_cast<float>(values[i][band]);
    return out;
}

/// Distributes the whole light over the groups in proportion to their light at each value. If no group has light there,
/// each gets its share of all light.
void deal_out(const CornerValues& whole, std::vector<LightGroup>& groups, CornerValues LightGroup::*values) {
    std::vector<double> of_all(groups.size(), 0);
    double all = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for (const auto& v : groups[g].*values)
            for (const float x : v) of_all[g] += std::max(0.0, static_cast<double>(x));
        all += of_all[g];
    }
    for (double& share : of_all) share = all > 0 ? share / all : 1 / static_cast<double>(groups.size());
    parallel_for(whole.size(), 4096, [&](std::size_t i) {
        for (std::size_t band = 0; band < bands; ++band) {
            double light = 0;
            for (const LightGroup& g : groups) light += std::max(0.0, static_cast<double>((g.*values)[i][band]));
            for (std::size_t g = 0; g < groups.size(); ++g) {
                float& v = (groups[g].*values)[i][band];
                const double share = light > 0 ? std::max(0.0, static_cast<double>(v)) / light : of_all[g];
                v = static_cast<float>(share * static_cast<double>(whole[i][band]));
            }
        }
    });
}

/// Separates the light of one solution.
class GroupSolver {
  public:
    GroupSolver(const Solution& solution, const SolveOptions& options, Progress& progress, const StopRequest& stop)
        : solution_(solution),
          stage_(solution.scene),
          options_(options),
          knobs_(knobs_for_error(options.error_target(), stage_.lit_spaces(), options)),
          progress_(progress),
          stop_(stop) {}

    Result<LightGroups> run() {
        record();
        find_transport();
        for (const EmitterGroup& emitters : find_emitter_groups(solution_.scene)) {
            if (stop_.requested()) break;
            progress_.phase("group " + emitters.name);
            out_.groups.emplace_back().emitters = emitters;
            find_light(out_.groups.back());
        }
        if (!stop_.requested()) finish();
        if (stop_.requested())
            return Error{ErrorCode::limit, "was stopped before all light groups were solved", "", ""};
        return std::move(out_);
    }

  private:
    bool reflects() const { return solution_.bounces != 0 && stage_.has_indirect_light(); }

    void record() {
        const Scene& scene = solution_.scene;
        for (const Material& m : scene.materials())
            out_.reflectance.push_back(m.reflectance), out_.exitance.push_back(m.exitance);
        for (const PunctualLight& light : scene.lights()) out_.intensity.push_back(light.intensity);
        for (const auto& dome : scene.distant().domes) out_.distant.push_back(dome.irradiance);
        for (const auto& disc : scene.distant().discs) out_.distant.push_back(disc.irradiance);
    }

    void find_transport() {
        progress_.phase("rays between elements");
        const double error = options_.error_target();
        // RMS of reflected indirect light.
        const double light = rms_reflected(solution_);
        std::vector<std::uint32_t> receivers =
            reflects() ? choose_receivers(solution_, error * light) : std::vector<std::uint32_t>();
        out_.layout = make_layout(solution_, receivers);
        node_ = number_nodes(solution_.interpolant, solution_.scene.size(), nodes_);
        for (const MaterialId m : out_.layout.material) rho_.push_back(out_.reflectance[m.value]);
        if (!reflects()) return;
        // The number of rays is in proportion to those of the solution, which suit its requested error, but at least
        // that of a gather.
        constexpr double places = 9;
        const double as_before =
            static_cast<double>(solution_.statistics.rays) / (places * static_cast<double>(receivers.size()));
        RayBudget rays = knobs_.gather_rays;
        rays.average = calibrated::kept_rays * std::max(rays.average, as_before);
        out_.transport = cast_transport(stage_, solution_, std::move(receivers), out_.layout,
                                        {rays, calibrated::kept_form_factor, options_.seed}, stop_);
    }

    /// Computes a group's direct light and its reflections, as values of the solution's functions.
    void find_light(LightGroup& group) {
        const TransportLayout& layout = out_.layout;
        const Scene lit = alone(solution_.scene, group.emitters);
        direct_.push_back(
            fit_direct_of(lit, stage_, solution_.interpolant.tree, layout.sources, knobs_.direct_tolerance, stop_));
        const std::vector<DirectFit>& direct = direct_.back();
        std::vector<Spectrum> indirect(value_count(solution_.indirect));
        if (reflects()) {
            const KeptOperator F(out_.transport, layout, solution_.interpolant.tree.size());
            std::vector<Spectrum> E(direct.size());
            for (std::size_t i = 0; i < E.size(); ++i) E[i] = direct[i].mean;
            std::vector<Spectrum> b = reflected_light(F, rho_, layout.area, E, solution_.bounces, &stop_);
            if (solution_.bounces > 0) older_.push_back(b);
            for (std::size_t i = 0; i < b.size(); ++i)
                b[i] += solution_.direct_share * lit.materials()[layout.material[i]].exitance;
            indirect = F.at_corners(F.at_receivers(b));
        }
        std::vector<Spectrum> all(solution_.interpolant.values.size());
        parallel_for(all.size(), 4096, [&](std::size_t i) { all[i] = layout.interpolant_at[i].of(indirect); });
        add_direct(direct, all);
        if (solution_.direct_in_elements) {
            // the exported function is `indirect` itself
            indirect = all;
        }
        group.indirect = as_floats(indirect), group.interpolant = as_floats(all);
    }

    /// Adds projected direct light at the corners of the interpolant's leaves.
    void add_direct(const std::vector<DirectFit>& direct, std::vector<Spectrum>& all) const {
        const ElementFunction& f = solution_.interpolant;
        const Spectrum apart = solution_.direct_in_elements ? Spectrum(1) : Spectrum(1) - solution_.direct_share;
        for (const ElementId e : f.tree.leaves()) {
            const ElementId base = is_base(f.tree, e) ? e : f.tree.parent(e);
            const Patch &patch = f.tree.patch(e), &whole = f.tree.patch(base);
            for (int k = 0; k < patch.corner_count(); ++k) {
                const Between at{0, corner_weights(whole, whole.coordinates(patch.corner(k)))};
                all[f.first_value[e] + static_cast<std::uint32_t>(k)] +=
                    apart * at.of(direct[out_.layout.number[base]].corners);
            }
        }
        average_at_nodes(node_, nodes_, all);
    }

    void finish() {
        measure_transport();
        deal_out(solution_.indirect.values, out_.groups, &LightGroup::indirect);
        deal_out(solution_.interpolant.values, out_.groups, &LightGroup::interpolant);
        for (LightGroup& group : out_.groups) {
            const std::vector<Spectrum> E = source_means(out_.layout, group.interpolant);
            double sum = 0, area = 0;
            for (std::size_t i = 0; i < E.size(); ++i)
                sum += out_.layout.area[i] * mean(rho_[i] * E[i]), area += out_.layout.area[i];
            group.reflected = area > 0 ? sum / area : 0;
        }
        progress_.phase("errors of light groups");
        if (reflects())
            estimate_group_errors(stage_, solution_, direct_, older_, options_.error_target(), options_.seed, out_,
                                  stop_);
        else
            for (LightGroup& group : out_.groups) group.error = solution_.statistics.relative_error_estimate;
    }

    /// Measures the difference between the groups' sum and the solution before it is corrected.
    void measure_transport() {
        if (!reflects()) return;
        CornerValues sum(solution_.indirect.values.size());
        for (const LightGroup& group : out_.groups)
            for (std::size_t i = 0; i < sum.size(); ++i)
                for (std::size_t band = 0; band < bands; ++band) sum[i][band] += group.indirect[i][band];
        out_.transport.error = relative_difference(solution_, sum);
    }

    const Solution& solution_;
    const Stage stage_;
    const SolveOptions& options_;
    const Knobs knobs_;
    Progress& progress_;
    const StopRequest& stop_;
    LightGroups out_;
    std::vector<Spectrum> rho_;                   ///< Per source.
    std::vector<std::vector<DirectFit>> direct_;  ///< Per group: direct light on the sources.
    /// Per group: radiosity of the sources, if the number of bounces is limited.
    std::vector<std::vector<Spectrum>> older_;
    std::vector<std::uint32_t> node_;  ///< Per value of the interpolant: its node.
    std::size_t nodes_ = 0;
};

}  // namespace

std::size_t LightGroups::light_bytes() const {
    std::size_t values = 0;
    for (const LightGroup& g : groups) values += g.indirect.size() + g.interpolant.size();
    return values * sizeof(CornerValues::value_type);
}

Result<LightGroups> solve_light_groups(const Solution& solution, const SolveOptions& options, Progress& progress,
                                       const StopRequest& stop) {
    return GroupSolver(solution, options, progress, stop).run();
}

}  // namespace exitance
