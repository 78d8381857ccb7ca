#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exitance {

/// What the tasks of an engine did whose tasks make tasks: enough to rebuild the graph and to replay it on any number
/// of processors. Iterations follow one another behind barriers. Times in seconds.
struct TaskGraph {
    static constexpr std::uint32_t none = 0xffffffffu;

    /// What a task's time goes to: its list and children made, visibility, form factors, radiosity gathered over the
    /// list, radiosity pulled up. Source: T_init, T_vis, T_ff, T_rad and T_back of [Vinod95].
    static constexpr std::array<const char*, 5> cost_names{"T_init", "T_vis", "T_ff", "T_rad", "T_back"};
    enum Cost : std::size_t { init, vis, ff, rad, back };

    /// A patch with its list of interactions, once an iteration.
    struct Task {
        std::uint32_t maker = none;  ///< In `tasks`, a smaller index; none: the iteration begins with it.
        std::uint32_t iteration = 0, worker = 0;
        std::uint32_t polygon = 0, level = 0;  ///< Of the patch: the input's piece, and the cuts below it.
        std::uint32_t interactions = 0;        ///< That it read over.
        double begin = 0, end = 0;             ///< By the clock on the wall, since the trace's beginning.
        std::array<float, 5> seconds{};        ///< By kind, of its thread's processor time.

        double cost() const {
            double sum = 0;
            for (float s : seconds) sum += static_cast<double>(s);
            return sum;
        }
    };
    struct Iteration {
        double begin = 0, end = 0;
        double serial = 0;  ///< Of that, behind the barrier.
        std::size_t first_task = 0, task_count = 0;
        double total_radiosity = 0;  ///< Sum of area times radiosity, mean of the bands, W.
    };

    std::size_t workers = 1;
    std::vector<Iteration> iterations;
    std::vector<Task> tasks;  ///< By iteration; within it makers before what they made, the same on any machine.
    // Where it stands in a TaskTrace:
    std::size_t phase = 0;
    std::uint64_t id = 0;
};

}  // namespace exitance
