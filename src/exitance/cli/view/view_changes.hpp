#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "exitance/cli/view/view_words.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// Reads the parameters `dim=NAME:FACTOR,...` and `paint=MATERIAL:r/g/b,...` of a request. Error (usage): malformed
/// words.
Result<LightChange> read_light_change(const ViewServer::Parameters& parameters);

/// Changes the light groups and reflectances of a solution as requests specify. Caches the last three results, since a
/// page fetches the elements of a solution in parts. Safe from any thread.
template <class Viewed>
class ViewChanges {
  public:
    explicit ViewChanges(LightGroups groups) : groups_(std::move(groups)) {}

    /// Replaces the groups by those of a finished solve.
    void set_groups(LightGroups groups) {
        const std::lock_guard lock(mutex_);
        groups_ = std::move(groups);
        kept_.clear();
    }
    /// Returns the groups, for a file.
    LightGroups groups() {
        const std::lock_guard lock(mutex_);
        return groups_;
    }
    /// Returns read(groups). Requests that change the groups wait meanwhile.
    template <class Read>
    auto read_groups(const Read& read) {
        const std::lock_guard lock(mutex_);
        return read(groups_);
    }
    /// True if the request contains changes.
    bool are_asked_for(const ViewServer::Parameters& parameters) const {
        return !view_text(parameters, "dim").empty() || !view_text(parameters, "paint").empty();
    }

    /// The solution `base` with the changes of a request. Concurrent calls wait for one another. Error: malformed
    /// changes, or unknown groups or materials.
    Result<std::shared_ptr<const Viewed>> find(const Viewed& base, const ViewServer::Parameters& parameters) {
        const std::string words = view_text(parameters, "dim") + "\n" + view_text(parameters, "paint");
        const std::lock_guard lock(mutex_);
        for (const auto& [of, viewed] : kept_)
            if (of == words) return viewed;
        const Result<LightChange> change = read_light_change(parameters);
        if (!change) return change.error();
        Solution solution = base.solution;
        std::vector<double> factors;
        for (const LightGroup& group : groups_.groups) factors.push_back(group.factor);
        const Result<void> changed = change_light(solution, groups_, *change);
        for (std::size_t g = 0; g < factors.size(); ++g) groups_.groups[g].factor = factors[g];
        if (!changed) return changed.error();
        auto viewed = std::make_shared<const Viewed>(std::move(solution), base.camera);
        kept_.emplace_back(words, viewed);
        if (kept_.size() > most_kept) kept_.erase(kept_.begin());
        return std::shared_ptr<const Viewed>(viewed);
    }

  private:
    static constexpr std::size_t most_kept = 3;
    LightGroups groups_;
    std::mutex mutex_;
    std::vector<std::pair<std::string, std::shared_ptr<const Viewed>>> kept_;
};

}  // namespace exitance
