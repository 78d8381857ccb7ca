#include "exitance/cli/view/view_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace exitance {

void ViewEvents::tell(const std::string& name, const std::string& json) {
    const std::lock_guard lock(mutex_);
    events_.push_back(fmt::format("event: {}\ndata: {}\n\n", name, json));
    told_.notify_all();
}

void ViewEvents::tell_progress(const std::string& json) {
    const std::lock_guard lock(mutex_);
    progress_ = fmt::format("event: progress\ndata: {}\n\n", json);
    ++progress_number_;
    told_.notify_all();
}

void ViewEvents::end(const std::string& json) {
    const std::lock_guard lock(mutex_);
    events_.push_back(fmt::format("event: end\ndata: {}\n\n", json));
    ended_ = true;
    told_.notify_all();
}

bool ViewEvents::wait(std::size_t& next, std::string& text) {
    std::unique_lock lock(mutex_);
    const std::size_t before = progress_number_;
    told_.wait_for(lock, std::chrono::seconds(1),
                   [&] { return next < events_.size() || progress_number_ != before || ended_; });
    if (!ended_) text = progress_;
    for (; next < events_.size(); ++next) text += events_[next];
    return !ended_;
}

void ViewProgress::phase(std::string_view name) {
    phase_ = name;
    inner_.phase(name);
    tell(0, "");
}

void ViewProgress::advance(double fraction, std::string_view detail) {
    inner_.advance(fraction, detail);
    constexpr double every = 0.1;  // seconds
    if (since_.seconds() < every) return;
    tell(fraction, detail);
}

void ViewProgress::shot(std::span<const Point> outline, double unshot) {
    constexpr double every = 0.1, first_decades = 3;  // seconds; powers of ten of unshot light that count as 100%
    if (since_shot_.seconds() < every) return;
    since_shot_.restart();
    const double done = unshot > 0 ? -std::log10(unshot) / first_decades : 1;
    tell(done, fmt::format("{:.2g}% of the light unshot", 100 * unshot), outline);
}

void ViewProgress::tell(double fraction, std::string_view detail, std::span<const Point> shooter) {
    since_.restart();
    std::string words = fmt::format("{}{}{}", phase_, detail.empty() ? "" : ", ", detail);
    std::replace_if(
        words.begin(), words.end(), [](char c) { return c == '"' || c == '\\' || (c >= 0 && c < ' '); }, '\'');
    std::string outline;
    for (const Point& p : shooter)
        outline += fmt::format("{}[{:.7g}, {:.7g}, {:.7g}]", outline.empty() ? "" : ", ", p.x, p.y, p.z);
    events_.tell_progress(fmt::format(R"({{"phase": "{}", "fraction": {:.3f}, "shooter": [{}]}})", words,
                                      std::clamp(fraction, 0.0, 1.0), outline));
}

}  // namespace exitance
