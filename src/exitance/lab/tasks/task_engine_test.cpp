#include "exitance/lab/tasks/task_engine.hpp"

#include <gtest/gtest.h>

#include <map>

#include "exitance/lab/tasks/interaction_forecast.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Radiosity and list length of every patch, by its path.
using State = std::map<std::tuple<std::uint32_t, std::uint64_t, int>, std::pair<Spectrum, std::size_t>>;

State state_of(const TaskEngine& engine) {
    State out;
    for (std::uint32_t id = 0; id < engine.patches().size(); ++id) {
        const TaskPatch& patch = engine.patches()[id];
        out[{patch.polygon, patch.path, patch.level}] = {engine.radiosity(id), patch.list.size()};
    }
    return out;
}

TaskOptions options(double threshold, Schedule schedule = Schedule::stealing, std::size_t threads = 1) {
    TaskOptions o;
    o.threshold = threshold, o.min_area = 0.02, o.change = 1e-3, o.max_iterations = 30;
    o.schedule = schedule, o.threads = threads, o.record = true;
    return o;
}

Progress silent;
const StopRequest never;

}  // namespace

TEST(TaskEngine, BitsDoNotDependOnScheduleOrThreads) {
    const Scene scene = built_scene("complex", {{"m", "1"}});
    const Stage stage(scene);
    State first;
    for (const auto& [schedule, name] : schedule_names)
        for (std::size_t threads : {1u, 2u, 5u}) {
            TaskEngine engine(stage, options(0.05, schedule, threads));
            const TaskReport report = engine.run(silent, never);
            EXPECT_TRUE(report.converged);
            EXPECT_GT(report.iterations, 3u);
            const State state = state_of(engine);
            if (first.empty()) first = state;
            EXPECT_EQ(state, first) << name << " on " << threads;
        }
    EXPECT_GT(first.size(), 4 * stage.pieces.size()) << "patches were cut";
}

TEST(TaskEngine, AClosedRoomOfOneReflectanceHasTheExactRadiosity) {
    // All faces emit 1 and reflect one half: B = 1 / (1 - 1/2) on any mesh. The tolerance is for form factors that do
    // not sum to 1, since they are evaluated at four points of coarse patches.
    const Scene scene = box_scene(2, 3, 2.5, 0.5, 1, 1);
    const Stage stage(scene);
    TaskEngine engine(stage, options(0.02));
    engine.run(silent, never);
    double area = 0, power = 0;
    for (std::uint32_t root = 0; root < engine.patches().root_count(); ++root) {
        area += engine.patches()[root].area;
        power += engine.patches()[root].area * mean(engine.radiosity(root));
    }
    EXPECT_NEAR(power / area, 2, 0.02);
}

TEST(TaskEngine, SmallerThresholdsMakeMoreInteractionsAsPredicted) {
    const Scene scene = box_scene(2, 3, 2.5, 0.5, 5);
    const Stage stage(scene);
    std::size_t before = 0;
    for (double threshold : {0.4, 0.1, 0.025}) {
        TaskOptions o = options(threshold);
        TaskEngine engine(stage, o);
        const TaskReport report = engine.run(silent, never);
        EXPECT_GT(report.interactions, before);
        before = report.interactions;
        const double predicted = predict_interactions(
            engine.visible_pairs(), [&](std::uint32_t r) { return engine.patches()[r].area; },
            [&](std::uint32_t r) { return max(engine.radiosity(r)); }, o);
        // The equation assumes that all parts of a pair are alike.
        EXPECT_GT(predicted, 0.3 * static_cast<double>(report.interactions));
        EXPECT_LT(predicted, 3 * static_cast<double>(report.interactions));
    }
}

TEST(TaskEngine, TheFormFactorOracleIgnoresLight) {
    std::size_t found[2];
    for (int i = 0; i < 2; ++i) {
        const Scene scene = box_scene(2, 3, 2.5, 0.5, i == 0 ? 5 : 500);
        const Stage stage(scene);
        TaskOptions o = options(0.05);
        o.by_power = false;
        TaskEngine engine(stage, o);
        found[i] = engine.run(silent, never).interactions;
    }
    EXPECT_EQ(found[0], found[1]);
}

TEST(TaskEngine, TheGraphRecordsMakerAndTimeOfEveryTask) {
    const Scene scene = built_scene("complex", {{"m", "1"}});
    const Stage stage(scene);
    TaskEngine engine(stage, options(0.05, Schedule::stealing, 2));
    const TaskReport report = engine.run(silent, never);
    const TaskGraph& graph = engine.graph();
    ASSERT_EQ(graph.iterations.size(), report.iterations);
    ASSERT_EQ(graph.tasks.size(), report.tasks);
    double seconds = 0;
    for (const TaskGraph::Iteration& iteration : graph.iterations) {
        std::size_t roots = 0;
        for (std::size_t t = iteration.first_task; t < iteration.first_task + iteration.task_count; ++t) {
            const TaskGraph::Task& task = graph.tasks[t];
            EXPECT_GE(task.begin, iteration.begin);
            EXPECT_LE(task.end, iteration.end);
            seconds += task.cost();
            if (task.maker == TaskGraph::none) {
                ++roots;
                EXPECT_EQ(task.level, 0u);
                continue;
            }
            ASSERT_LT(task.maker, t);
            ASSERT_GE(task.maker, iteration.first_task);
            const TaskGraph::Task& maker = graph.tasks[task.maker];
            EXPECT_EQ(task.polygon, maker.polygon);
            EXPECT_EQ(task.level, maker.level + 1);
            EXPECT_LE(maker.end, task.begin);
        }
        EXPECT_EQ(roots, stage.pieces.size());
    }
    double reported = 0;
    for (double s : report.seconds) reported += s;
    EXPECT_NEAR(seconds, reported, 1e-3 * reported);
}

TEST(TaskEngine, AStopBeforeTheFirstIterationRunsNone) {
    const Scene scene = box_scene(2, 3, 2.5, 0.5, 5);
    const Stage stage(scene);
    StopRequest stop;
    stop.interrupt();
    TaskEngine engine(stage, options(0.01));
    EXPECT_EQ(engine.run(silent, stop).iterations, 0u);
}

}  // namespace exitance
