#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "exitance/solve/shot_progress.hpp"

namespace exitance {

/// Server-sent events of a running solve, for the pages that follow it. All events are kept except progress, of which
/// only the newest is: a page that opens late gets no outdated progress. Safe from any thread.
class ViewEvents {
  public:
    /// Adds an event.
    void tell(const std::string& name, const std::string& json);
    /// Sends a new state of progress, which replaces the previous one.
    void tell_progress(const std::string& json);
    /// Adds the last event, "end".
    void end(const std::string& json);

    /// Waits up to one second for an event. Sets `text` to the progress and the events from number `next` on, and
    /// advances `next`. Returns false after the last event.
    bool wait(std::size_t& next, std::string& text);

  private:
    std::mutex mutex_;
    std::condition_variable told_;
    std::vector<std::string> events_;
    std::string progress_;
    std::size_t progress_number_ = 0;
    bool ended_ = false;
};

/// Progress that is sent to pages as events, at most ten times per second, and passed on to `inner`.
class ViewProgress : public ShotProgress {
  public:
    ViewProgress(ViewEvents& events, Progress& inner) : events_(events), inner_(inner) {}
    void phase(std::string_view name) override;
    void advance(double fraction, std::string_view detail) override;
    void shot(std::span<const Point> outline, double unshot) override;
    void note(std::string_view message) override { inner_.note(message); }
    void warn(std::string_view message) override { inner_.warn(message); }

  private:
    void tell(double fraction, std::string_view detail, std::span<const Point> shooter = {});

    ViewEvents& events_;
    Progress& inner_;
    std::string phase_;
    Stopwatch since_, since_shot_;
};

}  // namespace exitance
