#include "exitance/lab/studies/schedule_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "exitance/lab/study/study_drawings.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_drawn_tasks = 200;
constexpr double drawn_pauses = 400;  ///< Shortest pause that is drawn, as the inverse of its share of the run.

/// Indices of the tasks of one tree, creators first.
using TaskTree = std::vector<std::size_t>;

std::vector<TaskTree> trees_of(const TaskGraph& graph) {
    std::vector<TaskTree> trees;
    std::vector<std::size_t> tree_of(graph.tasks.size());
    for (std::size_t t = 0; t < graph.tasks.size(); ++t) {
        const std::uint32_t maker = graph.tasks[t].maker;
        tree_of[t] = maker == TaskGraph::none ? trees.size() : tree_of[maker];
        if (maker == TaskGraph::none) trees.emplace_back();
        trees[tree_of[t]].push_back(t);
    }
    return trees;
}

TaskTree drawn_tree(const TaskGraph& graph) {
    TaskTree largest, smallest;
    for (TaskTree& tree : trees_of(graph)) {
        if (smallest.empty() || tree.size() < smallest.size()) smallest = tree;
        if (tree.size() <= max_drawn_tasks && tree.size() > largest.size()) largest = std::move(tree);
    }
    if (!largest.empty()) return largest;
    smallest.resize(std::min(smallest.size(), max_drawn_tasks));
    return smallest;
}

/// Horizontal places of the tasks of a tree: leaves side by side, others in the middle above theirs.
class TaskColumns {
  public:
    TaskColumns(const TaskGraph& graph, const TaskTree& tree) {
        for (const std::size_t t : tree)
            if (t != tree.front()) made_[graph.tasks[t].maker].push_back(t);
        if (!tree.empty()) place(tree.front());
    }
    double operator[](std::size_t task) const { return x_.at(task); }

  private:
    double place(std::size_t task) {
        const auto made = made_.find(task);
        double x = 0;
        if (made == made_.end()) {
            x = next_++;
        } else {
            for (const std::size_t t : made->second) x += place(t) / static_cast<double>(made->second.size());
        }
        return x_[task] = x;
    }

    std::map<std::size_t, std::vector<std::size_t>> made_;
    std::map<std::size_t, double> x_;
    double next_ = 0;
};

}  // namespace

void add_published_curves(const std::string& scene, const GraphsBySchedule& graphs, Table& out) {
    constexpr std::size_t most = 64;
    double fastest = HUGE_VAL;
    const auto add = [&](const std::string& schedule, std::size_t processors, double seconds, double alone) {
        out.add_row();
        out.set("scene", scene), out.set("schedule", schedule), out.set("processors", std::to_string(processors));
        out.set("seconds", field(seconds)), out.set("speedup", field(alone / seconds));
    };
    for (const auto& [schedule, name] : schedule_names) {
        const TaskGraph& graph = graphs[static_cast<std::size_t>(schedule)];
        const double alone = simulate_schedule(graph, schedule, 1, two_rings).seconds;
        fastest = std::min(fastest, alone);
        for (std::size_t P = 1; P <= most; P *= 2)
            add(std::string(name), P, simulate_schedule(graph, schedule, P, two_rings).seconds, alone);
    }
    for (std::size_t P = 1; P <= most; P *= 2) add("ideal", P, fastest / static_cast<double>(P), fastest);
}

void draw_busy_processors(const std::string& scene, const TaskGraph& graph, Schedule schedule, std::size_t processors,
                          Table& out) {
    std::vector<BusyInterval> busy;
    const double seconds = simulate_schedule(graph, schedule, processors, two_rings, &busy).seconds;
    std::stable_sort(busy.begin(), busy.end(), [](const BusyInterval& a, const BusyInterval& b) {
        return std::pair(a.processor, a.begin) < std::pair(b.processor, b.begin);
    });
    std::vector<BusyInterval> drawn;
    for (const BusyInterval& next : busy) {
        const bool joins = !drawn.empty() && drawn.back().processor == next.processor &&
                           drawn.back().is_serial == next.is_serial &&
                           next.begin - drawn.back().end < seconds / drawn_pauses;
        if (joins)
            drawn.back().end = std::max(drawn.back().end, next.end);
        else
            drawn.push_back(next);
    }
    const std::string drawing = fmt::format("{}, {}, {} processors", scene,
                                            schedule_names[static_cast<std::size_t>(schedule)].second, processors);
    constexpr double inset = 0.1;  // share of a row; derived from a gap of a fifth of a row between processors
    for (const BusyInterval& interval : drawn) {
        const auto row = static_cast<double>(interval.processor);
        add_shape(out, drawing, "box", {interval.begin, row + inset, interval.end, row + 1 - inset},
                  interval.is_serial ? "#d55e00" : "#0072b2");
    }
}

void draw_task_graph(const std::string& scene, const TaskGraph& graph, Table& out) {
    const TaskTree tree = drawn_tree(graph);
    if (tree.empty()) return;
    const TaskColumns x(graph, tree);
    std::map<std::size_t, double> depth;
    double longest = 0;
    for (const std::size_t t : tree) {
        depth[t] = t == tree.front() ? 0 : depth.at(graph.tasks[t].maker) + 1;
        longest = std::max(longest, graph.tasks[t].cost());
    }
    const std::string drawing = fmt::format("{}, {} tasks", scene, tree.size());
    for (const std::size_t t : tree)
        if (const std::size_t maker = graph.tasks[t].maker; t != tree.front())
            add_shape(out, drawing, "line", {x[maker], -depth[maker], x[t], -depth[t]}, "#999999");
    for (const std::size_t t : tree)
        add_shape(out, drawing, "dot", {x[t], -depth[t]},
                  share_colour(longest > 0 ? graph.tasks[t].cost() / longest : 0));
}

}  // namespace exitance
