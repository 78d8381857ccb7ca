#pragma once

#include <array>
#include <vector>

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// Unoccluded share of the light between two elements, by rays: one share for all of it, or one per pair of nodes. One
/// object per thread; reuses its memory.
class PairVisibility {
  public:
    /// `at_nodes`: rays join the nodes themselves, as quadrature rules require; otherwise points around them.
    PairVisibility(const LinkSites& sites, bool at_nodes, std::uint64_t seed)
        : sites_(sites), n_(sites.nodes()), at_nodes_(at_nodes), seed_(seed) {}

    /// Casts `count` rays from random points of the receiver to random points of the source, and stores their
    /// unoccluded share in share(0). Returns its standard error.
    double look(ElementId p, ElementId q, unsigned count);

    /// Casts `each` rays per pair of nodes, between points near the two nodes. The points are in scaled-down copies of
    /// the elements around the nodes. few: only one ray per node of the receiver, to a random point of the source.
    void look_by_node(ElementId p, ElementId q, unsigned each, bool few);

    /// Share for node k of the receiver and node l of the source: pair = k n + l.
    double share(std::size_t pair) const { return share_[pair]; }
    void set_all(double share) { share_.fill(share); }
    /// Variance of the share at node k, after look_by_node().
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
