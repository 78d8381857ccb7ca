#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// What the leaves of a tree hold, as the elements above them see it. What large elements come to is kept, so that
/// links which go down from level to level do not read all leaves at each of them.
class LightBelow {
  public:
    /// `of_leaf`, on any thread: the values of a leaf; a leaf that is cut hands its function on.
    LightBelow(const LinkSites& sites, std::function<NodalValues(ElementId)> of_leaf)
        : sites_(sites), of_leaf_(std::move(of_leaf)) {}

    /// What some elements come to, none of them part of another. Keeps what is large below them. O(elements below).
    std::vector<FromBelow> look_at(std::span<const ElementId> elements);
    /// The same of any element: below those, some 64 leaves are read at most for each of its children.
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
    std::vector<Known> known_;  ///< By element.
};

}  // namespace exitance
