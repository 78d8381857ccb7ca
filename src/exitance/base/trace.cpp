#include "exitance/base/trace.hpp"

namespace exitance {
namespace {
TaskTrace* current_trace = nullptr;  // written only while there is one thread
}

void set_task_trace(TaskTrace* trace) {
    current_trace = trace;
}

TaskTrace* task_trace() {
    return current_trace;
}

TaskTrace::TaskTrace() {
    begin_phase("begin");
}

void TaskTrace::begin_phase(std::string_view name) {
    finish();
    phases_.push_back({std::string(name), next_id_++, now(), 0});
}

void TaskTrace::finish() {
    if (!phases_.empty()) phases_.back().end = now();
}

TaskTrace::Loop TaskTrace::begin_loop(const char* name, std::size_t count, std::size_t grain, std::size_t tasks) {
    Loop loop{*name != 0 ? name : phases_.back().name, next_id_, phases_.size() - 1, count, grain, now(), 0, {}};
    next_id_ += 1 + tasks;
    return loop;
}

void TaskTrace::end_loop(Loop loop) {
    loop.end = now();
    loops_.push_back(std::move(loop));
}

void TaskTrace::add_graph(TaskGraph graph) {
    graph.phase = phases_.empty() ? 0 : phases_.size() - 1;
    graph.id = next_id_;
    next_id_ += graph.iterations.size() + graph.tasks.size();
    graphs_.push_back(std::move(graph));
}

}  // namespace exitance
