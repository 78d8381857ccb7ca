#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "exitance/cli/view/view_gallery.hpp"
#include "exitance/cli/view/view_words.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// Changes the light groups and reflectances of a solution as requests specify. Caches the last three results, since a
/// page fetches the elements of a solution in parts. Safe from any thread.
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

    /// Returns the solution `base` with the changes of a request: `dim=NAME:FACTOR,...` and `paint=MATERIAL:r/g/b,...`.
    /// Concurrent calls wait for one another. Error: malformed changes, or unknown groups or materials.
    Result<std::shared_ptr<const Viewed>> find(const Viewed& base, const ViewServer::Parameters& parameters);

  private:
    static constexpr std::size_t max_kept = 3;
    LightGroups groups_;
    std::mutex mutex_;
    std::vector<std::pair<std::string, std::shared_ptr<const Viewed>>> kept_;
};

}  // namespace exitance
