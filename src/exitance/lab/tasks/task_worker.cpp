#include "exitance/lab/tasks/task_worker.hpp"

#include <algorithm>
#include <bit>
#include <ctime>
#include <utility>

#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

/// Processor time of the calling thread; other programs on the machine do not affect it.
double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// True if some corner of p is in front of q.
bool reaches_before(const TaskPatch& p, const TaskPatch& q) {
    const auto corners = p.outline();
    return std::any_of(corners.begin(), corners.end(), [&](const Point& x) { return q.plane.signed_distance(x) > 0; });
}

bool may_face(const TaskPatch& p, const TaskPatch& q) {
    return p.region != q.region && reaches_before(p, q) && reaches_before(q, p);
}

/// Mean form factor to q over p's receiving points.
double mean_form_factor(const TaskPatch& p, const TaskPatch& q) {
    double sum = 0;
    for (std::size_t i = 0; i < p.corner_count; ++i) sum += point_to_polygon(p.receiving[i], p.plane.n, q.outline());
    return sum / p.corner_count;
}

}  // namespace

void TaskWorker::spend(TaskGraph::Cost kind) {
    const double now = thread_seconds();
    seconds[kind] += now - mark_;
    mark_ = now;
}

void TaskWorker::process(const PatchTask& task, const IterationState& iteration) {
    iteration_ = &iteration;
    made_.clear();
    before_ = seconds;
    mark_ = thread_seconds();
    const double begin = options_->record ? iteration.clock.seconds() : 0;
    TaskPatch& patch = (*patches_)[task.patch];
    if (iteration.number == 1 && patch.level == 0) link_pieces(task.patch);
    refine(task.patch);
    gather(patch);
    spend(TaskGraph::rad);
    hand_down(task.patch);
    spend(TaskGraph::back);
    ++tasks;
    if (options_->record) record(task, begin);
}

void TaskWorker::record(const PatchTask& task, double begin) {
    const TaskPatch& patch = (*patches_)[task.patch];
    Record& record = records.emplace_back(Record{.patch = task.patch, .maker = task.maker, .task = {}});
    record.task.iteration = iteration_->number - 1;
    record.task.worker = number_;
    record.task.polygon = patch.polygon;
    record.task.level = patch.level;
    record.task.interactions = static_cast<std::uint32_t>(patch.list.size());
    record.task.begin = iteration_->origin + begin;
    record.task.end = iteration_->origin + iteration_->clock.seconds();
    for (std::size_t k = 0; k < seconds.size(); ++k)
        record.task.seconds[k] = static_cast<float>(seconds[k] - before_[k]);
}

void TaskWorker::link_pieces(std::uint32_t p) {
    TaskPatch& patch = (*patches_)[p];
    for (std::uint32_t q = 0; q < patches_->root_count(); ++q)
        if (q != p && may_face(patch, (*patches_)[q])) patch.list.push_back({.source = q});
    spend(TaskGraph::init);
}

/// Form factor from p to q. If two patches barely face each other, all points of p may be where they do not; then q's
/// points are used, by reciprocity.
float TaskWorker::form_factor(const TaskPatch& p, const TaskPatch& q) {
    if (!may_face(p, q)) return 0;
    form_factors += p.corner_count;
    const double F = mean_form_factor(p, q);
    if (F > 0) return static_cast<float>(F);
    form_factors += q.corner_count;
    return static_cast<float>(std::min(1.0, mean_form_factor(q, p) * q.area / p.area));
}

float TaskWorker::visible_share(const TaskPatch& p, const TaskPatch& q) {
    int passed = 0, facing = 0;
    for (std::size_t group = 0; group < options_->rays / RayEnds::size; ++group) {
        const std::uint32_t cast = patches_->facing_rays(p, q, group);
        if (cast == 0) continue;
        const auto [from, to] = patches_->rays(p, q, group);
        const std::uint32_t blocked = stage_->tracer.occluded(from, to);
        facing += std::popcount(cast);
        passed += std::popcount(cast & ~blocked);
    }
    rays += static_cast<std::size_t>(facing);
    return facing > 0 ? static_cast<float>(passed) / static_cast<float>(facing) : 0.0f;
}

void TaskWorker::find_form_factors(const TaskPatch& patch) {
    for (Interaction& i : fresh_)
        if (i.form_factor < 0) i.form_factor = form_factor(patch, (*patches_)[i.source]);
    std::erase_if(fresh_, [](const Interaction& i) { return !(i.form_factor > 0); });
}

void TaskWorker::find_visibility(const TaskPatch& patch) {
    for (Interaction& i : fresh_)
        if (i.visible < 0) i.visible = visible_share(patch, (*patches_)[i.source]);
    std::erase_if(fresh_, [](const Interaction& i) { return !(i.visible > 0); });
}

bool TaskWorker::is_too_strong(const TaskPatch& patch, const Interaction& i) const {
    const TaskPatch& source = (*patches_)[i.source];
    const double F = static_cast<double>(i.form_factor), limit = (i.visible < 1 ? 0.5 : 1) * options_->threshold;
    if (options_->by_power) return F * patch.area * max(source.radiosity[iteration_->last()]) > limit;
    return F * std::max(1.0, patch.area / source.area) > limit;  // reciprocity: F_qp = F_pq A_p / A_q
}

/// Splits the larger patch of an interaction, or the source if both have the same area.
void TaskWorker::cut_interaction(std::uint32_t p, const Interaction& i) {
    const TaskPatch& patch = (*patches_)[p];
    Interaction part;
    if (options_->triage && i.visible == 1) part.visible = 1;
    if (patch.area > (*patches_)[i.source].area) {
        const std::uint32_t first = patches_->children(p, iteration_->last());
        part.source = i.source;
        for (std::uint32_t c = 0; c < 4; ++c) (*patches_)[first + c].list.push_back(part);
        return;
    }
    const std::uint32_t first = patches_->children(i.source, iteration_->last());
    for (std::uint32_t c = 0; c < 4; ++c) {
        part.source = first + c;
        next_.push_back(part);
    }
}

/// Refines a patch's list in rounds: first the whole list, then the parts of split sources, until no interaction is too
/// strong.
void TaskWorker::refine(std::uint32_t p) {
    TaskPatch& patch = (*patches_)[p];
    bool are_pieces = iteration_->number == 1 && patch.level == 0;
    kept_.clear();
    fresh_.assign(patch.list.begin(), patch.list.end());
    while (!fresh_.empty()) {
        if (std::any_of(fresh_.begin(), fresh_.end(), [](const Interaction& i) { return i.form_factor < 0; })) {
            find_form_factors(patch);
            spend(TaskGraph::ff);
            find_visibility(patch);
            spend(TaskGraph::vis);
        }
        if (std::exchange(are_pieces, false))
            for (const Interaction& i : fresh_) visible_pairs.push_back({p, i.source, i.form_factor});
        next_.clear();
        const bool goes_on = !iteration_->stop.requested();
        for (const Interaction& i : fresh_) {
            const TaskPatch& larger = patch.area > (*patches_)[i.source].area ? patch : (*patches_)[i.source];
            const bool may_cut = larger.level < PatchPool::deepest && larger.area / 4 >= options_->min_area;
            if (goes_on && may_cut && is_too_strong(patch, i))
                cut_interaction(p, i);
            else
                kept_.push_back(i);
        }
        fresh_.swap(next_);
        if (!fresh_.empty()) spend(TaskGraph::init);
    }
    patch.list.assign(kept_.begin(), kept_.end());
    spend(TaskGraph::init);
}

/// E_p = E_parent + sum F_pq V_pq B_q over the list, with B of the last iteration.
void TaskWorker::gather(TaskPatch& patch) {
    Spectrum E = patch.parent == TaskPatch::none ? Spectrum() : (*patches_)[patch.parent].irradiance;
    for (const Interaction& i : patch.list)
        E += static_cast<double>(i.form_factor) * static_cast<double>(i.visible) *
             (*patches_)[i.source].radiosity[iteration_->last()];
    patch.irradiance = E;
    patch.reached = iteration_->number;
}

/// Creates tasks for the children that have a list or had children before the iteration, and finishes the others here.
/// A patch whose children are all new and have no lists is finished as a leaf.
void TaskWorker::hand_down(std::uint32_t p) {
    TaskPatch& patch = (*patches_)[p];
    const std::uint32_t first = patch.first_child.load(std::memory_order_acquire);
    const auto has_list = [&](std::uint32_t c) { return !(*patches_)[c].list.empty(); };
    const bool is_leaf =
        first >= TaskPatch::being_made || (first >= iteration_->old_size && !has_list(first) && !has_list(first + 1) &&
                                           !has_list(first + 2) && !has_list(first + 3));
    if (is_leaf) return finish_leaf(patch);
    patch.open_children.store(4, std::memory_order_release);
    for (std::uint32_t c = first; c < first + 4; ++c) {
        TaskPatch& child = (*patches_)[c];
        const std::uint32_t below = child.first_child.load(std::memory_order_acquire);
        if (has_list(c) || below < iteration_->old_size) {
            made_.push_back({c, p});
        } else {
            gather(child);
            finish_leaf(child);
        }
    }
}

void TaskWorker::finish_leaf(TaskPatch& patch) {
    const Material& material = stage_->scene.material(patch.region);
    patch.radiosity[iteration_->present()] = material.exitance + material.reflectance * patch.irradiance;
    pull_up(patch);
}

/// Sets B of ancestors whose children are all finished to the mean over their children, which have a quarter of the
/// area each. Sums in pairs, so that four equal values give exactly that value.
void TaskWorker::pull_up(const TaskPatch& patch) {
    for (const TaskPatch* child = &patch; child->parent != TaskPatch::none;) {
        TaskPatch& parent = (*patches_)[child->parent];
        if (parent.open_children.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
        const std::uint32_t c = parent.first_child.load(std::memory_order_acquire);
        const auto B = [&](std::uint32_t k) { return (*patches_)[c + k].radiosity[iteration_->present()]; };
        parent.radiosity[iteration_->present()] = 0.25 * ((B(0) + B(1)) + (B(2) + B(3)));
        child = &parent;
    }
}

}  // namespace exitance
