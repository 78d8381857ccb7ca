#include "exitance/lab/tasks/schedule_simulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Two iterations of trees of tasks, with one root per polygon; tasks cost up to a millisecond.
TaskGraph random_graph(std::uint64_t seed, std::uint32_t polygons) {
    RandomStream random(seed, Stream::mesh);
    TaskGraph graph;
    for (std::uint32_t i = 0; i < 2; ++i) {
        TaskGraph::Iteration iteration{.serial = 1e-4, .first_task = graph.tasks.size()};
        for (std::uint32_t p = 0; p < polygons; ++p) {
            const std::size_t first = graph.tasks.size();
            const std::size_t count = 1 + static_cast<std::size_t>(40 * random.uniform());
            for (std::size_t k = 0; k < count; ++k) {
                TaskGraph::Task task{.iteration = i, .polygon = p, .interactions = 10};
                if (k > 0) task.maker = static_cast<std::uint32_t>(first + (k - 1) / 4);
                task.seconds[TaskGraph::vis] = static_cast<float>(1e-3 * random.uniform());
                graph.tasks.push_back(task);
            }
        }
        iteration.task_count = graph.tasks.size() - iteration.first_task;
        graph.iterations.push_back(iteration);
    }
    return graph;
}

double all_work(const TaskGraph& graph) {
    double sum = 0;
    for (const TaskGraph::Task& task : graph.tasks) sum += task.cost();
    for (const TaskGraph::Iteration& iteration : graph.iterations) sum += iteration.serial;
    return sum;
}

}  // namespace

TEST(ScheduleSimulator, OneProcessorNeedsTheSumOfTheTaskTimes) {
    const TaskGraph graph = random_graph(1, 20);
    for (const auto& [schedule, name] : schedule_names) {
        const SimulatedRun run = simulate_schedule(graph, schedule, 1, no_overhead);
        EXPECT_NEAR(run.seconds, all_work(graph), 1e-9) << name;
        EXPECT_NEAR(run.idle, 0, 1e-9);
    }
}

TEST(ScheduleSimulator, BusyIntervalsOfAProcessorDoNotOverlapAndSumToItsWork) {
    const TaskGraph graph = random_graph(1, 20);
    for (const auto& [schedule, name] : schedule_names) {
        std::vector<BusyInterval> busy;
        constexpr std::size_t processors = 8;
        const SimulatedRun run = simulate_schedule(graph, schedule, processors, two_rings, &busy);
        std::vector<double> until(processors, 0);
        double tasks = 0, serial = 0;
        std::stable_sort(busy.begin(), busy.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
        for (const BusyInterval& interval : busy) {
            ASSERT_LT(interval.processor, processors);
            EXPECT_GE(interval.begin, until[interval.processor] - 1e-9) << name;
            EXPECT_LE(interval.end, run.seconds + 1e-9);
            until[interval.processor] = interval.end;
            (interval.is_serial ? serial : tasks) += interval.end - interval.begin;
        }
        EXPECT_NEAR(tasks, run.tasks + run.remote, 1e-6 * run.tasks) << name;
        EXPECT_NEAR(serial, run.serial, 1e-9);
    }
}

TEST(ScheduleSimulator, RespectsTheBoundsOfWorkAndCriticalPath) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const TaskGraph graph = random_graph(seed, 3 + 5 * static_cast<std::uint32_t>(seed));
        const double longest = critical_path(graph), work = all_work(graph);
        for (std::size_t P : {2u, 3u, 16u, 200u}) {
            const double least = std::max(longest, work / static_cast<double>(P));
            for (const auto& [schedule, name] : schedule_names) {
                const SimulatedRun run = simulate_schedule(graph, schedule, P, no_overhead);
                EXPECT_GE(run.seconds, least - 1e-9) << name << " on " << P;
                EXPECT_GE(run.idle, -1e-9);
                double tasks = 0;
                for (const TaskGraph::Task& task : graph.tasks) tasks += task.cost();
                EXPECT_NEAR(run.tasks, tasks, 1e-9) << "every task runs once";
                // Bound for greedy schedules [Graham69]; a static schedule may leave processors idle while others have
                // work.
                if (schedule != Schedule::fixed) {
                    EXPECT_LE(run.seconds, work / static_cast<double>(P) + longest + 1e-9) << name << " on " << P;
                }
            }
        }
    }
}

TEST(ScheduleSimulator, OneSharedQueueIsLimitedByItsLock) {
    const TaskGraph graph = random_graph(3, 400);
    MachineModel slow_queue = no_overhead;
    slow_queue.queue = 50e-6;  // a twentieth of the longest task
    const double locks = 50e-6 * static_cast<double>(graph.tasks.size());
    EXPECT_GE(simulate_schedule(graph, Schedule::dynamic, 512, slow_queue).seconds, locks);
    EXPECT_LT(simulate_schedule(graph, Schedule::stealing, 512, slow_queue).seconds, 0.5 * locks);
}

TEST(ScheduleSimulator, TheLockOfAPublishedSpeedUpIsFound) {
    const TaskGraph graph = random_graph(3, 400);
    MachineModel machine = no_overhead;
    machine.queue = 20e-6;
    const double published = simulate_schedule(graph, Schedule::dynamic, 1, machine).seconds /
                             simulate_schedule(graph, Schedule::dynamic, 64, machine).seconds;
    const std::optional<double> found = flattening_lock(graph, Schedule::dynamic, 64, no_overhead, published);
    ASSERT_TRUE(found);
    machine.queue = *found;
    const double again = simulate_schedule(graph, Schedule::dynamic, 1, machine).seconds /
                         simulate_schedule(graph, Schedule::dynamic, 64, machine).seconds;
    EXPECT_NEAR(again / published, 1, 0.02) << "the lock is accurate to 1%, and speed-ups fall at most as its inverse";
    EXPECT_FALSE(flattening_lock(graph, Schedule::dynamic, 64, no_overhead, 65)) << "more than there are processors";
}

TEST(ScheduleSimulator, ListsThatAnotherProcessorMadeAreTransferred) {
    // Task 1 is made by task 0 on processor 0, which then takes task 2, made likewise; the other processor takes one.
    TaskGraph graph;
    graph.iterations.push_back({.first_task = 0, .task_count = 3});
    for (const std::uint32_t maker : {TaskGraph::none, 0u, 0u}) {
        TaskGraph::Task& task = graph.tasks.emplace_back();
        task.maker = maker, task.interactions = 10, task.seconds = {1, 0, 0, 0, 0};
    }
    MachineModel machine = no_overhead;
    machine.near = 1e-3, machine.ring = 32;
    const double line = 10 * machine.near;
    // Each of three tasks reads half of its radiosities from the other processor; one has a list made elsewhere.
    EXPECT_NEAR(simulate_schedule(graph, Schedule::dynamic, 2, machine).remote, (3 * 0.5 + 1) * line, 1e-12);
    EXPECT_NEAR(simulate_schedule(graph, Schedule::fixed, 2, machine).remote, 3 * 0.5 * line, 1e-12);
}

TEST(ScheduleSimulator, RemoteLinesCostMoreBeyondARing) {
    const TaskGraph graph = random_graph(4, 300);
    const SimulatedRun inside = simulate_schedule(graph, Schedule::fixed, 32, two_rings);
    const SimulatedRun outside = simulate_schedule(graph, Schedule::fixed, 64, two_rings);
    EXPECT_GT(inside.remote, 0);
    EXPECT_GT(outside.remote, 1.5 * inside.remote);
    EXPECT_EQ(simulate_schedule(graph, Schedule::fixed, 1, two_rings).remote, 0);
}

}  // namespace exitance
