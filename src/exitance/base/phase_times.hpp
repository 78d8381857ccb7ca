#pragma once

#include <initializer_list>
#include <map>
#include <string>

#include "exitance/base/progress.hpp"

namespace exitance {

/// Forwards everything to another Progress and measures the time of every phase. Must not outlive that Progress.
class PhaseTimes : public Progress {
  public:
    explicit PhaseTimes(Progress& progress) : progress_(progress) {}

    void phase(std::string_view name) override {
        close();
        name_ = name;
        progress_.phase(name);
    }
    void advance(double fraction, std::string_view detail = {}) override { progress_.advance(fraction, detail); }
    void note(std::string_view message) override { progress_.note(message); }
    void warn(std::string_view message) override { progress_.warn(message); }
    Progress& inner() { return progress_; }

    /// Returns the total time in phases of these names so far, seconds. The current phase is included only after the
    /// next one begins or after close().
    double seconds(std::initializer_list<const char*> names) const {
        double sum = 0;
        for (const char* name : names)
            if (const auto at = seconds_.find(name); at != seconds_.end()) sum += at->second;
        return sum;
    }
    void close() {
        if (!name_.empty()) seconds_[name_] += watch_.seconds();
        watch_.restart();
        name_.clear();
    }

  private:
    Progress& progress_;
    std::string name_;
    Stopwatch watch_;
    std::map<std::string, double, std::less<>> seconds_;
};

}  // namespace exitance
