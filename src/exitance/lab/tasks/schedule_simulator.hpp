#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "exitance/base/schedule.hpp"
#include "exitance/base/task_graph.hpp"

namespace exitance {

/// Costs that a machine adds to the processor time of tasks, in seconds.
///
/// A queue serves one processor at a time, for `queue` seconds. With one queue for all it is the bottleneck: P
/// processors are too many if P > mean task time / queue. An idle processor probes queues one after the other, `probe`
/// each, and then pays `steal`. Radiosities are written by their owners in every iteration, so that the first read
/// through each interaction comes from another processor's memory with probability 1 - 1/P. It costs `near`, or `far`
/// from another ring of `ring` processors. A task that is stolen, or that a task of another processor made, also
/// transfers its list. `slowness`: time of this machine's processor over that of the one on which the graph was
/// recorded.
struct MachineModel {
    std::string_view name;
    double queue = 0, probe = 0, steal = 0;
    double near = 0, far = 0;
    std::size_t ring = 1;
    double slowness = 1;
};

/// Threads on sockets of 32 cores: a lock, and cache lines from the shared cache (15 ns) or from another socket (150
/// ns).
inline constexpr MachineModel shared_memory{.name = "shared",
                                            .queue = 60e-9,
                                            .probe = 20e-9,
                                            .steal = 200e-9,
                                            .near = 15e-9,
                                            .far = 150e-9,
                                            .ring = 32,
                                            .slowness = 1};
/// Rings of 32 processors of 40 MHz with only caches, as in [Vinod95]: 175 or 600 cycles per remote line. Assumptions,
/// which `flattening_lock` varies: such a processor takes a second for work that a present one does in a millisecond; a
/// queue's lock is taken, written and released, three lines of the own ring.
inline constexpr MachineModel two_rings{.name = "ring",
                                        .queue = 3 * 175 / 40e6,
                                        .probe = 175 / 40e6,
                                        .steal = 600 / 40e6,
                                        .near = 175 / 40e6,
                                        .far = 600 / 40e6,
                                        .ring = 32,
                                        .slowness = 1000};
/// Processes on machines of 32 cores, connected by a network with 1.5 us latency.
inline constexpr MachineModel network{.name = "network",
                                      .queue = 1.5e-6,
                                      .probe = 1.5e-6,
                                      .steal = 3e-6,
                                      .near = 15e-9,
                                      .far = 1.5e-6,
                                      .ring = 32,
                                      .slowness = 1};
/// No cost except tasks and barriers: the limit set by the graph.
inline constexpr MachineModel no_overhead{.name = "ideal"};

inline constexpr std::array<MachineModel, 4> machine_models{no_overhead, shared_memory, two_rings, network};

/// Result of a simulated run. Times are in seconds.
struct SimulatedRun {
    double seconds = 0;  ///< From the first task to the last barrier.
    /// Sums over processors: running tasks, waiting for and holding queues, reading remote lines.
    double tasks = 0, queue = 0, remote = 0;
    /// Sums over processors: without work; and behind barriers, where one processor works.
    double idle = 0, serial = 0;
    std::size_t stolen = 0;
};

/// Time during which a processor of a simulated run works, seconds since the first task began.
struct BusyInterval {
    std::size_t processor = 0;
    double begin = 0, end = 0;
    bool is_serial = false;  ///< True behind a barrier, where this processor alone works.
};

/// Replays a graph event by event on `processors` processors under the rules of GrowingQueues. Tasks that a task
/// creates become available when it ends. Deterministic. O(tasks log(processors)), plus the probes for stealing.
/// `busy`: receives the intervals of work, if given.
SimulatedRun simulate_schedule(const TaskGraph& graph, Schedule schedule, std::size_t processors,
                               const MachineModel& machine, std::vector<BusyInterval>* busy = nullptr);

/// Returns the time of a queue's lock, seconds, at which a machine that otherwise costs the same reaches a speed-up on
/// `processors` processors: what a published curve says about a cost that is not published. Accurate to 1%. Returns
/// none if the speed-up is not reached without any lock, or is exceeded with a lock of a second.
std::optional<double> flattening_lock(const TaskGraph& graph, Schedule schedule, std::size_t processors,
                                      MachineModel machine, double speedup);

/// Sum over iterations of the longest chain of tasks and the time behind the barrier, seconds at slowness 1: a lower
/// bound for any number of processors.
double critical_path(const TaskGraph& graph);

}  // namespace exitance
