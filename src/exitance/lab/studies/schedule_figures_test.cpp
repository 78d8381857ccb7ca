#include "exitance/lab/studies/schedule_figures.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

/// One iteration of `roots` trees of 1 + 3 + 9 tasks of a millisecond.
TaskGraph even_graph(std::uint32_t roots) {
    TaskGraph graph;
    for (std::uint32_t root = 0; root < roots; ++root) {
        const auto first = static_cast<std::uint32_t>(graph.tasks.size());
        for (std::uint32_t k = 0; k < 13; ++k) {
            TaskGraph::Task task{.maker = k == 0 ? TaskGraph::none : first + (k - 1) / 3, .polygon = root};
            task.seconds[TaskGraph::vis] = 1e-3F;
            graph.tasks.push_back(task);
        }
    }
    graph.iterations.push_back({.serial = 1e-3, .task_count = graph.tasks.size()});
    return graph;
}

std::size_t rows_with(const Table& table, const std::string& column, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t row = 0; row < table.rows.size(); ++row) count += table.text(row, column) == text;
    return count;
}

TEST(ScheduleFigures, TheIdealLineIsNeverSlowerThanASchedule) {
    Table curves;
    add_published_curves("room", {even_graph(20), even_graph(20), even_graph(20)}, curves);
    ASSERT_EQ(curves.rows.size(), 28u);  // 1, 2, ... 64 processors, three schedules and the ideal line
    for (std::size_t row = 0; row < 21; ++row) {
        const std::size_t ideal = 21 + row % 7;
        ASSERT_EQ(curves.text(ideal, "processors"), curves.text(row, "processors"));
        EXPECT_EQ(curves.number(ideal, "speedup"), curves.number(row, "processors"));
        EXPECT_GE(curves.number(row, "seconds"), curves.number(ideal, "seconds") * (1 - 1e-6));
    }
}

TEST(ScheduleFigures, EveryProcessorThatWorksHasItsRow) {
    Table busy;
    draw_busy_processors("room", even_graph(20), Schedule::stealing, 4, busy);
    EXPECT_GE(rows_with(busy, "colour", "#0072b2"), 4u);
    EXPECT_EQ(rows_with(busy, "colour", "#d55e00"), 1u);  // the processor behind the barrier
    bool has_row[4] = {};
    for (std::size_t row = 0; row < busy.rows.size(); ++row)
        has_row[static_cast<std::size_t>(busy.number(row, "y1"))] = true;
    for (const bool has : has_row) EXPECT_TRUE(has);
}

TEST(ScheduleFigures, ATreeOfTasksIsDrawnBelowItsRoot) {
    Table drawing;
    draw_task_graph("room", even_graph(2), drawing);
    EXPECT_EQ(rows_with(drawing, "shape", "dot"), 13u);
    EXPECT_EQ(rows_with(drawing, "shape", "line"), 12u);
    EXPECT_EQ(rows_with(drawing, "y1", "-2"), 9u);  // leaves
    EXPECT_EQ(rows_with(drawing, "drawing", "room, 13 tasks"), 25u);
}

}  // namespace
}  // namespace exitance
