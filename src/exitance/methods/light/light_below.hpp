#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// Light of a tree's leaves, pulled up to the elements above them. Results of large elements are cached, so that links
/// which are refined level by level do not read all leaves at each level.
class LightBelow {
  public:
    /// `of_leaf`: returns the values of a leaf, also of one that has been split since. Called from any thread.
    LightBelow(const LinkSites& sites, std::function<NodalValues(ElementId)> of_leaf)
        : sites_(sites), of_leaf_(std::move(of_leaf)) {}

    /// Returns the light of elements, none of which is part of another. Caches the light of large elements below them.
    /// O(elements below).
    std::vector<FromBelow> look_at(std::span<const ElementId> elements);
    /// Returns the light of any element. Below cached elements, this reads at most about 64 leaves per child.
    FromBelow at(ElementId e) const { return pull(e, nullptr).found; }

    std::size_t memory_bytes() const { return known_.size() * sizeof(Known); }

  private:
    using Known = std::pair<ElementId, FromBelow>;
    struct Pulled {
        FromBelow found;
        std::size_t leaves = 1;
    };
    Pulled pull(ElementId e, std::vector<Known>* large) const;

    const LinkSites& sites_;
    std::function<NodalValues(ElementId)> of_leaf_;
    std::vector<Known> known_;  ///< Sorted by element.
};

}  // namespace exitance
