#include "exitance/methods/plan/memory_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/memory.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/methods/plan/method_memory.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Leaves per piece that is smaller than the target element size, and per element of larger pieces; grading and light
/// split these further. Given by rooms of 20 to 54,005 polygons at 2% and 5%.
constexpr double leaves_a_piece = 2.5, leaves_an_element = 20;

/// Returns the memory of a process on its node over that of a single process.
double share_of_process() {
    const auto count = static_cast<double>(processes_on_node());
    return largest_of_all((1 + own_memory * (count - 1)) / count);
}

/// Returns the memory in use per process; shared memory of a node is divided by the number of its processes.
double bytes_in_use() {
    const std::size_t proportional = processes() > 1 ? proportional_memory_bytes() : 0;
    const double own = static_cast<double>(proportional > 0 ? proportional : peak_memory_bytes());
    return largest_of_all(sum_on_node(own) / static_cast<double>(processes_on_node()));
}

double predicted_leaves(double elements, const Stage& stage) {
    const double of_pieces = std::min(elements, static_cast<double>(stage.pieces.size()));
    return leaves_a_piece * of_pieces + leaves_an_element * (elements - of_pieces);
}

double predicted_bytes(const Knobs& knobs, const Stage& stage, const SolveOptions& options) {
    const double solved = static_cast<double>(predict_elements(stage.pieces, knobs.solve_mesh.edge)),
                 gathered = static_cast<double>(predict_elements(stage.pieces, knobs.gather_mesh.edge));
    const double leaves = predicted_leaves(solved, stage) + predicted_leaves(gathered, stage);
    return bytes_a_leaf * leaves + method_bytes(stage, options, knobs, solved);
}

}  // namespace

Result<bool> fit_into_memory(Knobs& knobs, const Stage& stage, const SolveOptions& options) {
    const double limit = static_cast<double>(*options.memory_limit_bytes);
    const double used = bytes_in_use(), share = share_of_process();
    const auto needed = [&] { return share * predicted_bytes(knobs, stage, options); };
    bool unchanged = true;
    for (double before = 0; used + needed() > limit; unchanged = false) {
        const double now = needed();
        if (now == before)
            return Error{
                ErrorCode::limit,
                fmt::format("{:.0f} MiB are in use and the coarsest mesh needs about {:.0f} MiB more, over the "
                            "limit of {:.0f} MiB",
                            std::ceil(used / 0x1p20), std::ceil(now / 0x1p20), std::floor(limit / 0x1p20)),
                "--memory-limit", "raise the limit"};
        before = now;
        knobs.solve_mesh.edge *= calibrated::coarsening;
        knobs.gather_mesh.edge *= calibrated::coarsening;
        knobs.solve_mesh.grading_levels = std::max(0, knobs.solve_mesh.grading_levels - 1);
        knobs.gather_mesh.grading_levels = std::max(0, knobs.gather_mesh.grading_levels - 1);
        knobs.solve_rays.average =
            std::max(calibrated::min_rays_per_sample, knobs.solve_rays.average / calibrated::coarsening);
    }
    return unchanged;
}

}  // namespace exitance
