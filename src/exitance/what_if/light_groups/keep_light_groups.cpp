#include "exitance/what_if/light_groups/keep_light_groups.hpp"

#include "exitance/evaluate/energy.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

Result<void> check_light_groups(const Scene& scene) {
    const std::size_t count = find_emitter_groups(scene).size();
    if (count <= max_light_groups) return {};
    return Error{ErrorCode::usage,
                 "there are " + std::to_string(count) + " groups that emit, at most " +
                     std::to_string(max_light_groups) + " are solved one by one",
                 "--light-groups", "give lamps that are switched together the same group name"};
}

Result<LightGroups> keep_light_groups(Solution& solution, const SolveOptions& options, Progress& progress,
                                      const StopRequest& stop) {
    if (!solution.scene.has_light()) return LightGroups();
    SolveStatistics& s = solution.statistics;
    const auto not_kept = [&](const std::string& why) {
        s.warnings.push_back("light groups are not kept: " + why), s.converged = false;
        return LightGroups();
    };
    if (stop.requested()) return not_kept("the run was stopped before they were solved");
    const Stopwatch watch;
    // The discontinuity mesh holds the light of all lamps together. It cannot hold that of a single group. Layers can.
    solution.discontinuity = {}, solution.own_form = {}, solution.delivers_own_form = false;
    Result<LightGroups> groups = solve_light_groups(solution, options, progress, stop);
    if (!groups && stop.requested()) return not_kept(groups.error().message);
    if (!groups) return groups;
    s.seconds[RunPart::light_groups] = watch.seconds();
    s.figures["light_groups"] = static_cast<double>(groups->groups.size());
    s.figures["light_group_bytes"] = static_cast<double>(groups->light_bytes());
    s.figures["repaint_bytes"] = static_cast<double>(groups->transport.bytes());
    s.figures["repaint_rays"] = static_cast<double>(groups->transport.rays);
    s.figures["repaint_rows"] = static_cast<double>(groups->transport.receiver.size());
    s.figures["repaint_entries"] = static_cast<double>(groups->transport.source.size());
    return groups;
}

EnergyBalance energy_after_change(const Solution& solution) {
    Stage stage(solution.scene);
    stage.set_rooms(find_light_rooms(stage, 1, StopRequest()));
    return energy_of_interpolant(solution, stage);
}

}  // namespace exitance
