#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exitance {

/// Record of a task-based engine whose tasks create further tasks: enough to rebuild the task graph and to replay it on
/// any number of processors. Iterations are separated by barriers. Times in seconds.
struct TaskGraph {
    static constexpr std::uint32_t none = 0xffffffffu;

    /// The parts of a task's time: making its interaction list and children, visibility, form factors, gathering
    /// radiosity over the list, and pulling radiosity up. Source: T_init, T_vis, T_ff, T_rad and T_back of [Vinod95].
    static constexpr std::array<const char*, 5> cost_names{"T_init", "T_vis", "T_ff", "T_rad", "T_back"};
    enum Cost : std::size_t { init, vis, ff, rad, back };

    /// One patch with its list of interactions, in one iteration.
    struct Task {
        /// Task that created it, a smaller index into `tasks`; none: it starts the iteration.
        std::uint32_t maker = none;
        std::uint32_t iteration = 0, worker = 0;
        std::uint32_t polygon = 0, level = 0;  ///< Input polygon of the patch, and its depth in the subdivision.
        std::uint32_t interactions = 0;        ///< Number of interactions over which the task gathered.
        double begin = 0, end = 0;             ///< Wall-clock time since the start of the trace.
        std::array<float, 5> seconds{};        ///< Processor time of the task's thread, by `Cost`.

        double cost() const {
            double sum = 0;
            for (float s : seconds) sum += static_cast<double>(s);
            return sum;
        }
    };
    struct Iteration {
        double begin = 0, end = 0;
        double serial = 0;  ///< Part of this time that is serial, after the barrier.
        std::size_t first_task = 0, task_count = 0;
        double total_radiosity = 0;  ///< Sum of area times radiosity, mean over the bands, W.
    };

    std::size_t workers = 1;
    std::vector<Iteration> iterations;
    /// Sorted by iteration; within one, creators precede their tasks. The order is the same on any machine.
    std::vector<Task> tasks;
    // Phase and id of this record in a TaskTrace.
    std::size_t phase = 0;
    std::uint64_t id = 0;
};

}  // namespace exitance
