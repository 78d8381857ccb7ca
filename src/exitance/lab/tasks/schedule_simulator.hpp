#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "exitance/base/schedule.hpp"
#include "exitance/base/task_graph.hpp"

namespace exitance {

/// What a machine adds to the processor time of tasks. Seconds.
///
/// A queue serves one processor at a time, `queue` each; with one queue for all that is the bottleneck: P processors
/// are too many when P > mean task / queue. A thief looks at one queue after the other, `probe` each, and then pays
/// `steal`. Radiosities are written by their owners every iteration, so that the first read over each interaction
/// comes from another processor's memory with probability 1 - 1/P: `near`, or `far` where that is in another ring of
/// `ring` processors. What is stolen brings its list along, too. `slowness`: of a processor, over the one that the
/// graph was recorded on.
struct MachineModel {
    std::string_view name;
    double queue = 0, probe = 0, steal = 0;
    double near = 0, far = 0;
    std::size_t ring = 1;
    double slowness = 1;
};

/// Threads of one socket: a lock, a line from the cache that its cores share (15 ns), from another socket (150 ns)
/// beyond 32 of them.
inline constexpr MachineModel shared_memory{.name = "shared",
                                            .queue = 60e-9,
                                            .probe = 20e-9,
                                            .steal = 200e-9,
                                            .near = 15e-9,
                                            .far = 150e-9,
                                            .ring = 32,
                                            .slowness = 1};
/// Rings of 32 processors of 20 MHz with nothing but caches, as [Vinod95] had them: 175 and 600 cycles a remote line.
/// Assumed: one of its processors does in a second what one of today does in a millisecond; a queue's lock is taken,
/// written and given back, three lines of the own ring.
inline constexpr MachineModel two_rings{.name = "ring",
                                        .queue = 3 * 175 / 20e6,
                                        .probe = 175 / 20e6,
                                        .steal = 600 / 20e6,
                                        .near = 175 / 20e6,
                                        .far = 600 / 20e6,
                                        .ring = 32,
                                        .slowness = 1000};
/// Processes on machines of 32 cores in a network of 1.5 us.
inline constexpr MachineModel network{.name = "network",
                                      .queue = 1.5e-6,
                                      .probe = 1.5e-6,
                                      .steal = 3e-6,
                                      .near = 15e-9,
                                      .far = 1.5e-6,
                                      .ring = 32,
                                      .slowness = 1};
/// Nothing but tasks and barriers: what the graph allows.
inline constexpr MachineModel no_overhead{.name = "ideal"};

inline constexpr std::array<MachineModel, 4> machine_models{no_overhead, shared_memory, two_rings, network};

/// How a recorded run would have gone.
struct SimulatedRun {
    double seconds = 0;                       ///< From the first task to the last barrier.
    double tasks = 0, queue = 0, remote = 0;  ///< Sums over processors: of tasks, at queues (waiting too), for lines,
    double idle = 0, serial = 0;              ///< without work, and behind barriers, where one works.
    std::size_t stolen = 0;
};

/// Replays a graph event by event on `processors` processors, under the rules of GrowingQueues. What a task makes is
/// there when it ends. The same graph gives the same run. O(tasks log(processors)), and the probes of thieves.
SimulatedRun simulate_schedule(const TaskGraph& graph, Schedule schedule, std::size_t processors,
                               const MachineModel& machine);

/// The longest chain of tasks of every iteration, and what lies behind barriers: no number of processors is faster. Of
/// a processor of slowness 1.
double critical_path(const TaskGraph& graph);

}  // namespace exitance
