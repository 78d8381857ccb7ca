#pragma once

#include "exitance/direct/emitter_tree.hpp"

namespace exitance {

/// Chooses emitters for shadow rays, each by about its unoccluded light: by a descent through the tree of emitters.
/// Every emitter that may be visible has a chance. O(log emitters) per choice. Windows to the sky are left out.
class LightChoice {
  public:
    /// `direct` must outlive this object.
    explicit LightChoice(const DirectLight& direct);

    bool empty() const { return tree_.sources().empty(); }
    std::size_t size() const { return tree_.sources().size(); }
    const EmitterTree::Source& source(std::uint32_t number) const { return tree_.sources()[number]; }

    /// A source, by its number, and the probability of its choice; 0 if the receiver is behind the source.
    struct Chosen {
        std::uint32_t number = 0;
        double chance = 0;
    };
    /// `u`: uniform in [0, 1).
    Chosen choose(const Point& x, const Normal& n, double u) const;
    /// Probability that choose() chooses a source.
    double chance_of(std::uint32_t number, const Point& x, const Normal& n) const;
    /// Number of the source of a region on which `at` lies; none if the region does not emit.
    std::optional<std::uint32_t> source_at(RegionId region, const Point& at) const;

  private:
    double light_of(const EmitterTree::Node& node, const Point& x, const Normal& n) const;
    double chance_of_left(const EmitterTree::Node& node, const Point& x, const Normal& n) const;

    const DirectLight* direct_;
    EmitterTree tree_;
    std::vector<std::pair<RegionId, std::uint32_t>> by_region_;  ///< Sorted.
};

}  // namespace exitance
