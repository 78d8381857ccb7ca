#include "exitance/base/schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"

namespace exitance {
namespace {

constexpr Schedule all_schedules[] = {Schedule::fixed, Schedule::dynamic, Schedule::stealing};

/// Takes all tasks that one worker gets if no other worker takes any.
std::vector<std::size_t> drain(TaskQueues& queues, std::size_t worker) {
    std::vector<std::size_t> out;
    for (std::size_t task; (task = queues.next(worker)) != TaskQueues::none;) out.push_back(task);
    return out;
}

/// Restores the default schedule and number of threads.
struct Restore {
    ~Restore() { set_schedule(Schedule::stealing), set_threads(0); }
};

}  // namespace

TEST(TaskQueues, StaticTasksStayWithTheirWorker) {
    TaskQueues queues(Schedule::fixed, 7, 3);
    EXPECT_EQ(drain(queues, 1), (std::vector<std::size_t>{1, 4}));
    EXPECT_EQ(drain(queues, 0), (std::vector<std::size_t>{0, 3, 6}));
    EXPECT_EQ(drain(queues, 1), (std::vector<std::size_t>{}));
    EXPECT_EQ(drain(queues, 2), (std::vector<std::size_t>{2, 5}));
}

TEST(TaskQueues, DynamicTasksComeFromOneQueueInOrder) {
    TaskQueues queues(Schedule::dynamic, 5, 3);
    EXPECT_EQ(queues.next(2), 0u);
    EXPECT_EQ(queues.next(0), 1u);
    EXPECT_EQ(drain(queues, 1), (std::vector<std::size_t>{2, 3, 4}));
    EXPECT_EQ(queues.next(2), TaskQueues::none);
}

TEST(TaskQueues, StolenTasksComeFromTheTailOfTheNext) {
    TaskQueues queues(Schedule::stealing, 7, 3);
    EXPECT_EQ(queues.next(1), 1u);
    EXPECT_EQ(drain(queues, 0), (std::vector<std::size_t>{0, 3, 6, 4, 5, 2}));
    EXPECT_EQ(queues.next(1), TaskQueues::none);
}

TEST(TaskQueues, TasksOfAPolygonGoToOneWorker) {
    const std::vector<std::uint32_t> polygon{0, 0, 1, 1, 2, 2, 2, 3};
    TaskQueues queues(Schedule::fixed, polygon.size(), 2, polygon);
    EXPECT_EQ(drain(queues, 0), (std::vector<std::size_t>{0, 1, 4, 5, 6}));
    EXPECT_EQ(drain(queues, 1), (std::vector<std::size_t>{2, 3, 7}));
}

TEST(TaskQueues, ConcurrentThreadsGetEveryTaskOnce) {
    for (Schedule schedule : all_schedules)
        for (std::size_t tasks : {1u, 5u, 20000u}) {
            constexpr std::size_t workers = 4;
            TaskQueues queues(schedule, tasks, workers);
            std::vector<std::vector<std::size_t>> got(workers);
            std::vector<std::thread> threads;
            for (std::size_t w = 0; w < workers; ++w) threads.emplace_back([&, w] { got[w] = drain(queues, w); });
            for (std::thread& thread : threads) thread.join();
            std::vector<std::size_t> all;
            for (const auto& part : got) all.insert(all.end(), part.begin(), part.end());
            std::sort(all.begin(), all.end());
            ASSERT_EQ(all.size(), tasks);
            for (std::size_t i = 0; i < tasks; ++i) ASSERT_EQ(all[i], i);
        }
}

TEST(Parallel, EveryIndexIsVisitedOnceUnderEverySchedule) {
    const Restore restore;
    for (Schedule schedule : all_schedules)
        for (int threads : {1, 2, 5}) {
            set_schedule(schedule), set_threads(threads);
            std::vector<int> visits(1003, 0);
            parallel_for(visits.size(), 8, [&](std::size_t i) { ++visits[i]; },
                         {"visit", [](std::size_t i) { return i / 100; }, true});
            EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), 1003);
        }
}

TEST(Parallel, SumsAreBitIdenticalUnderEveryScheduleAndWhenNested) {
    const Restore restore;
    const auto sum = [] {
        return parallel_sum<double>(5000, [](std::size_t i) {
            RandomStream random(i, Stream::mesh);
            return parallel_sum<double>(3, [&](std::size_t) { return random.uniform(); });
        });
    };
    set_threads(1);
    const double alone = sum();
    for (Schedule schedule : all_schedules)
        for (int threads : {2, 3}) {
            set_schedule(schedule), set_threads(threads);
            EXPECT_EQ(sum(), alone);
        }
}

}  // namespace exitance
