#include "exitance/cli/run_limits.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "exitance/base/available_memory.hpp"
#include "exitance/base/distinct_numbers.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

using Clock = StopRequest::Clock;

/// Time between the time limit and the end of the program. In it, code that checks the StopRequest can print its own
/// error and end its child processes.
constexpr std::chrono::milliseconds grace{200};
/// Interval of checks of the memory. Pages are first written at about 1 GB/s per core: 10 MB per core and interval.
constexpr std::chrono::milliseconds memory_interval{10};
/// Longer interval for several processes: reading their shares of common pages takes the system 1 to 5 ms per GB.
constexpr std::chrono::milliseconds memory_interval_of_several{100};

}  // namespace

Clock::time_point seconds_from_now(double seconds) {
    const std::chrono::duration<double> limit(std::min(seconds, 1e9));  // a time that the clock can represent
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
}

RunLimits::RunLimits(const LimitArguments& limits)
    : limits_(limits), is_alone_(processes() == 1), is_first_(is_first_process()) {
    if (limits_.time_limit) {
        const Clock::time_point deadline = seconds_from_now(*limits_.time_limit);
        stop_.set_deadline(deadline);
        end_ = deadline + grace;
    }
    if (is_over_memory()) {
        over_memory_ = true;
        end_without_result();
    }
    if (limits_.time_limit || limits_.memory_limit) watcher_ = std::jthread([this] { watch(); });
}

RunLimits::~RunLimits() {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    changed_.notify_all();
}

StopRequest& RunLimits::keep(Signals signals) {
    const std::lock_guard lock(mutex_);
    keeps_ = true;
    if (!signals_ && signals == Signals::request_stop) signals_.emplace(stop_);
    changed_.notify_all();
    return stop_;
}

double RunLimits::seconds_left() const {
    if (!limits_.time_limit) return std::numeric_limits<double>::infinity();
    return std::chrono::duration<double>(end_ - grace - Clock::now()).count();
}

StopReason RunLimits::reason() const {
    return over_memory_ ? StopReason::memory_limit : reason_of(stop_);
}

Error RunLimits::error(const std::string& message) const {
    if (!over_memory_)
        return {ErrorCode::limit, fmt::format("{:g} s have passed, and {}", limits_.time_limit.value_or(0), message),
                "--time-limit", "raise the limit"};
    const NumberTexts mib = distinct_texts(static_cast<double>(used_memory_bytes()) / 0x1p20,
                                           static_cast<double>(*limits_.memory_limit) / 0x1p20);
    return {ErrorCode::limit,
            fmt::format("{} MiB are in use, over the limit of {} MiB, and {}", mib.first, mib.second, message),
            "--memory-limit", "raise the limit"};
}

void RunLimits::watch_memory_of_several() {
    const std::lock_guard lock(mutex_);
    watches_several_ = true;
    changed_.notify_all();
}

std::size_t RunLimits::used_memory_bytes() const {
    return is_alone_ ? resident_memory_bytes() : proportional_memory_bytes();
}

bool RunLimits::is_over_memory() const {
    // A solve over several processes keeps the limit by fit_into_memory().
    return limits_.memory_limit && (is_alone_ || watches_several_) && used_memory_bytes() > *limits_.memory_limit;
}

void RunLimits::watch() {
    const std::chrono::milliseconds interval = is_alone_ ? memory_interval : memory_interval_of_several;
    std::unique_lock lock(mutex_);
    while (!is_over_) {
        const bool looks = limits_.memory_limit && !over_memory_;
        if (looks)
            changed_.wait_until(lock, std::min(end_, Clock::now() + interval));
        else if (keeps_ || !limits_.time_limit)
            changed_.wait(lock);
        else
            changed_.wait_until(lock, end_);
        if (is_over_) return;
        const bool passes_memory = looks && is_over_memory();
        if (passes_memory) over_memory_ = true, stop_.interrupt(StopRequest::Cause::memory_limit);
        if (!keeps_ && (passes_memory || Clock::now() >= end_) && is_first_) end_without_result();
    }
}

void RunLimits::end_without_result() const {
    const Error passed = error("there is no result to keep yet");
    fmt::print(stderr, "{}error: {}: {}\nhint: {}\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", passed.where,
               passed.message, passed.hint);
    remove_unfinished_files();
    _exit(static_cast<int>(ExitCode::no_result));
}

}  // namespace exitance
