#pragma once

#include <array>
#include <vector>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// What part of the light between two elements meets nothing on its way, by rays: one share for all of it, or one for
/// each pair of their nodes. One a thread; keeps its memory.
class PairVisibility {
  public:
    /// `at_nodes`: rays join the nodes themselves, as quadrature rules have it; else they join places around them.
    PairVisibility(const LinkSites& sites, bool at_nodes, std::uint64_t seed)
        : sites_(sites), n_(sites.nodes()), at_nodes_(at_nodes), seed_(seed) {}

    /// Rays from anywhere on the receiver to anywhere on the source; their share is share(0). Returns its standard
    /// error.
    double look(ElementId p, ElementId q, unsigned count);

    /// `each` rays join a place near a receiver's node with one near a source's node: copies of the elements, so much
    /// smaller, stand around the nodes. `few`: one a receiver's node, to anywhere on the source.
    void look_by_node(ElementId p, ElementId q, unsigned each, bool few);

    /// Of node k of the receiver and node l of the source, at k n + l.
    double share(std::size_t pair) const { return share_[pair]; }
    void set_all(double share) { share_.fill(share); }
    /// Of the share of what arrives at node k: by look_by_node.
    double variance(std::size_t k) const { return variance_[k]; }

    std::size_t rays() const { return rays_; }

  private:
    void cast(ElementId p, ElementId q);
    bool add_ray(ElementId p, ElementId q, const Point& x, const Point& y);

    const LinkSites& sites_;
    std::size_t n_;
    bool at_nodes_;
    std::uint64_t seed_;
    std::vector<Point> from_, to_;
    std::vector<std::size_t> pair_of_ray_;
    std::array<bool, 81 * 16> blocked_;
    std::array<double, 81> share_{};
    std::array<double, 9> variance_{};
    std::size_t rays_ = 0;
};

}  // namespace exitance
