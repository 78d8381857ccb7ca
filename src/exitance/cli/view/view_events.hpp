#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "exitance/solve/shot_progress.hpp"

namespace exitance {

/// What a running solve has told so far, for pages that follow it. Safe from any thread. Of progress only the newest
/// counts: a page that comes late is not told the past.
class ViewEvents {
  public:
    void tell(const std::string& name, const std::string& json);
    void tell_progress(const std::string& json);
    void end(const std::string& json);

    /// Text of the events from number `next` on, waiting for one second at most; false once all is told.
    bool wait(std::size_t& next, std::string& text);

  private:
    std::mutex mutex_;
    std::condition_variable told_;
    std::vector<std::string> events_;
    std::string progress_;
    std::size_t progress_number_ = 0;
    bool ended_ = false;
};

/// Sends on what a solve tells, to pages.
class ViewProgress : public ShotProgress {
  public:
    ViewProgress(ViewEvents& events, Progress& inner) : events_(events), inner_(inner) {}
    void phase(std::string_view name) override;
    void advance(double fraction, std::string_view detail) override;
    void shot(std::span<const Point> outline, double unshot) override;
    void note(std::string_view message) override { inner_.note(message); }
    void warn(std::string_view message) override { inner_.warn(message); }
    /// What is asked for in this round, before the phase's name.
    void set_round(std::string words) { round_ = std::move(words); }

  private:
    void tell(double fraction, std::string_view detail, std::span<const Point> shooter = {});

    ViewEvents& events_;
    Progress& inner_;
    std::string round_, phase_;
    Stopwatch since_, since_shot_;
};

}  // namespace exitance
