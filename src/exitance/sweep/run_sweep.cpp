#include "exitance/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "exitance/sweep/variant_links.hpp"

namespace exitance {
namespace {

constexpr std::chrono::milliseconds wait_for_others{50};  ///< Interval at which steps of other processes are checked.
constexpr std::chrono::milliseconds progress_interval{100};

/// Step, reason and folder of a failure.
std::string failure_text(const StepStore& store, const ResolvedStep& step) {
    const std::optional<StepFailure> failure = store.failure(step);
    if (!failure) return fmt::format("{}: it failed", step.name);
    return fmt::format("{}: {}; see {}", step.name, failure->message, store.failure_path(step));
}

/// Step, damage and folder of a step that was finished.
std::string damage_text(const StepStore& store, const ResolvedStep& step, const std::string& damage) {
    return fmt::format("{}: its result in {} is damaged: {}", step.name, store.path(step), damage);
}

VariantState state_of(const StepStore& store, ResolvedVariant variant) {
    VariantState out;
    const std::vector<ResolvedStep>& steps = variant.steps;
    while (out.finished_steps < steps.size() && store.is_finished(steps[out.finished_steps])) ++out.finished_steps;
    if (out.finished_steps == steps.size()) {
        out.kind = VariantState::Kind::done;
    } else {
        const ResolvedStep& next = steps[out.finished_steps];
        if (store.is_running(next)) {
            out.kind = VariantState::Kind::running;
        } else if (const std::optional<StepFailure> failure = store.failure(next)) {
            out.kind = VariantState::Kind::failed;
            out.failure = failure_text(store, next);
        } else if (const std::string damage = store.damage(next); !damage.empty()) {
            out.failure = fmt::format("{}; the next run repeats it", damage_text(store, next, damage));
        }
    }
    out.variant = std::move(variant);
    return out;
}

/// A variant that is being run.
struct SweepJob {
    std::size_t index = 0;
    ResolvedVariant variant;  ///< Has no steps until the job is begun.
    std::size_t next = 0;     ///< Index of the first step that is not known to be finished.
};

/// Variants that wait to be run, shared by the threads that run them.
class SweepQueue {
  public:
    SweepQueue(const SweepPlan& plan, const std::vector<std::size_t>& variants, const StepRunner& runner,
               const StopRequest& stop)
        : plan_(plan), runner_(runner), stop_(stop), store_(step_folder(plan)) {
        for (const std::size_t index : variants) waiting_.push_back({index, {}, 0});
        report_.variants = variants.size();
    }

    /// Runs variants until none is left, a stop is requested or an error occurs.
    void work();
    /// Share of the variants that are done or have failed.
    double fraction() const;
    Result<SweepReport> report();

  private:
    enum class Advance { done, failed, busy, stopped };
    Result<Advance> advance(SweepJob& job);
    Result<void> begin(SweepJob& job);
    bool has_failed(const ResolvedStep& step) const;
    void add_failure(std::size_t index, const ResolvedStep& step);
    void count(StepStore::Outcome outcome, const ResolvedStep& step, const std::string& damage);
    std::optional<SweepJob> take();

    const SweepPlan& plan_;
    const StepRunner& runner_;
    const StopRequest& stop_;
    StepStore store_;
    mutable std::mutex mutex_;  ///< Guards the members below.
    std::deque<SweepJob> waiting_;
    InputHashes hashes_;
    std::set<std::string> failed_;  ///< Keys of steps that failed in this run.
    SweepReport report_;
    std::optional<Error> error_;
};

double SweepQueue::fraction() const {
    const std::lock_guard lock(mutex_);
    const std::size_t ended = report_.done + report_.failures.size();
    return report_.variants == 0 ? 1.0 : static_cast<double>(ended) / static_cast<double>(report_.variants);
}

Result<SweepReport> SweepQueue::report() {
    const std::lock_guard lock(mutex_);
    if (error_) return *error_;
    return report_;
}

bool SweepQueue::has_failed(const ResolvedStep& step) const {
    const std::lock_guard lock(mutex_);
    return failed_.contains(step.key);
}

void SweepQueue::add_failure(std::size_t index, const ResolvedStep& step) {
    const std::string text = failure_text(store_, step);
    const std::lock_guard lock(mutex_);
    failed_.insert(step.key);
    report_.failures.push_back(fmt::format("variant {}: {}", index + 1, text));
}

void SweepQueue::count(StepStore::Outcome outcome, const ResolvedStep& step, const std::string& damage) {
    const std::lock_guard lock(mutex_);
    if (outcome == StepStore::Outcome::finished && !damage.empty())
        report_.warnings.push_back(fmt::format("{}; it was run again", damage_text(store_, step, damage)));
    ++(outcome == StepStore::Outcome::finished ? report_.steps_run : report_.steps_reused);
}

Result<void> SweepQueue::begin(SweepJob& job) {
    const std::lock_guard lock(mutex_);
    Result<ResolvedVariant> resolved = resolve_variant(plan_, job.index, hashes_);
    if (!resolved) return resolved.error();
    job.variant = std::move(*resolved);
    return {};
}

/// Takes the steps of a variant, up to the first one that another thread or process runs.
Result<SweepQueue::Advance> SweepQueue::advance(SweepJob& job) {
    if (job.variant.steps.empty()) {
        if (const Result<void> begun = begin(job); !begun) return begun.error();
        // If a step fails, no results of older parameters or inputs may look like those of this variant.
        remove_if_stale(plan_, job.index, job.variant);
    }
    for (; job.next < job.variant.steps.size(); ++job.next) {
        const ResolvedStep& step = job.variant.steps[job.next];
        if (stop_.requested()) return Advance::stopped;
        if (has_failed(step)) return add_failure(job.index, step), Advance::failed;
        const std::string damage = store_.damage(step);
        const Result<StepStore::Outcome> outcome = store_.run(step, runner_, stop_);
        if (!outcome) return outcome.error();
        if (*outcome == StepStore::Outcome::busy) return Advance::busy;
        if (*outcome == StepStore::Outcome::stopped) return Advance::stopped;
        if (*outcome == StepStore::Outcome::failed) return add_failure(job.index, step), Advance::failed;
        count(*outcome, step, damage);
    }
    if (const Result<void> linked = link_variant(plan_, job.index, job.variant); !linked) return linked.error();
    return Advance::done;
}

std::optional<SweepJob> SweepQueue::take() {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty() || error_) return std::nullopt;
    SweepJob job = std::move(waiting_.front());
    waiting_.pop_front();
    return job;
}

void SweepQueue::work() {
    std::size_t busy = 0;  // number of consecutive jobs that wait for steps of other processes
    while (std::optional<SweepJob> job = take()) {
        const Result<Advance> result = advance(*job);
        bool all_are_busy = false;
        {
            const std::lock_guard lock(mutex_);
            if (!result) error_ = result.error();
            if (!result || *result == Advance::stopped) return;
            if (*result == Advance::done) ++report_.done;
            busy = *result == Advance::busy ? busy + 1 : 0;
            if (*result == Advance::busy) waiting_.push_back(std::move(*job));
            all_are_busy = busy >= waiting_.size() && busy > 0;
        }
        if (all_are_busy) std::this_thread::sleep_for(wait_for_others), busy = 0;
    }
}

}  // namespace

std::string name_of(VariantState::Kind kind) {
    switch (kind) {
        case VariantState::Kind::done:
            return "done";
        case VariantState::Kind::running:
            return "running";
        case VariantState::Kind::failed:
            return "failed";
        case VariantState::Kind::to_do:
            break;
    }
    return "to do";
}

Result<std::vector<VariantState>> sweep_states(const SweepPlan& plan) {
    const StepStore store(step_folder(plan));
    InputHashes hashes;
    std::vector<VariantState> out;
    for (std::size_t i = 0; i < plan.variants.size(); ++i) {
        Result<ResolvedVariant> variant = resolve_variant(plan, i, hashes);
        if (!variant) return variant.error();
        out.push_back(state_of(store, std::move(*variant)));
    }
    return out;
}

Result<SweepReport> run_sweep(const SweepPlan& plan, const std::vector<std::size_t>& variants, int jobs,
                              const StepRunner& runner, Progress& progress, const StopRequest& stop) {
    SweepQueue queue(plan, variants, runner, stop);
    progress.phase("variants");
    int running = jobs;
    std::mutex mutex;  // guards `running`
    std::condition_variable ended;
    // Commands end with the thread that started them, so the threads last as long as their commands.
    std::vector<std::jthread> threads;
    for (int i = 0; i < jobs; ++i)
        threads.emplace_back([&] {
            queue.work();
            const std::lock_guard lock(mutex);
            --running;
            ended.notify_all();
        });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, progress_interval, [&] { return running == 0; })) progress.advance(queue.fraction());
    lock.unlock();
    threads.clear();
    if (variants.size() == plan.variants.size()) remove_extra_variants(plan);
    Result<SweepReport> report = queue.report();
    if (!report || !stop.requested()) return report;
    // Variants that were not looked at before the stop may have been done by another run.
    const Result<std::vector<VariantState>> states = sweep_states(plan);
    if (!states) return states.error();
    report->done = static_cast<std::size_t>(std::count_if(variants.begin(), variants.end(), [&](std::size_t i) {
        return (*states)[i].kind == VariantState::Kind::done;
    }));
    return report;
}

Result<void> update_variant_folders(const SweepPlan& plan, const std::vector<VariantState>& states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i].kind != VariantState::Kind::done)
            remove_if_stale(plan, i, states[i].variant);
        else if (const Result<void> linked = link_variant(plan, i, states[i].variant); !linked)
            return linked.error();
    }
    remove_extra_variants(plan);
    return {};
}

}  // namespace exitance
