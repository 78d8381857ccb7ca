#pragma once

#include <vector>

#include "exitance/links/link_sites.hpp"
#include "exitance/mesh/cluster_tree.hpp"

namespace exitance {

/// A way for light between two bodies, at least one of them a cluster, receiver first.
struct ClusterLink {
    Body receiver, source;
    float visible = 1;  ///< Share of what passes between them that nothing stops.
};

/// Elements and clusters as bodies far away: a middle, a ball about it, and vector areas.
class Bodies {
  public:
    Bodies(const LinkSites& sites, const ClusterTree& clusters) : sites_(&sites), clusters_(&clusters) {}

    const LinkSites& sites() const { return *sites_; }
    const ElementTree& elements() const { return sites_->tree(); }
    const ClusterTree& clusters() const { return *clusters_; }

    Point centre(Body b) const { return b.is_cluster() ? clusters_->centre(b.cluster()) : sites_->centre(b.element()); }
    double radius(Body b) const {
        return b.is_cluster() ? clusters_->radius(b.cluster()) : sites_->radius(b.element());
    }
    double area(Body b) const { return b.is_cluster() ? clusters_->area(b.cluster()) : elements().area(b.element()); }
    bool is_leaf(Body b) const { return !b.is_cluster() && elements().is_leaf(b.element()); }
    std::vector<Body> parts(Body b) const;

    /// Input polygon that it begins with, for traces.
    RegionId region(Body b) const;

  private:
    const LinkSites* sites_;
    const ClusterTree* clusters_;
};

/// For each band, the sum of A b n over the members of a facing, W: what it sends towards w is that times w / pi.
using VectorPower = std::array<Vec3, bands>;

VectorPower power_of(const LinkSites& sites, ElementId e, const NodalField& b);

/// What clusters send, by facing, from the light of the elements. O(pieces + facings).
Field<FacingId, VectorPower> find_vector_powers(const Bodies& bodies, const NodalField& b);

/// All links to or from clusters.
///
/// From a facing of the source, whose vector power is v, light of intensity v.w / pi goes towards w, where its vector
/// area faces w; it arrives over the distance r as
///
///     E = V v.w / (pi r^2)
///
/// on a plane at right angles to w. A cluster that receives holds E w by facing, which comes to each member as
/// -w.n. Elements that receive take it at each node. Linear in b. Source: [Willmott99]. O(links) and 12 bytes each.
class ClusterLinks {
  public:
    /// `links` in any order.
    ClusterLinks(const Bodies& bodies, std::vector<ClusterLink> links);

    std::size_t size() const { return links_.size(); }
    std::size_t memory_bytes() const;

    /// Adds what arrives by these links to E of every element that they lead to; what clusters receive, to their
    /// pieces'.
    void add_to(NodalField& E, const NodalField& b) const;

    /// Marks the elements that links lead to or come from.
    void mark(Field<ElementId, std::uint8_t>& marked) const;

  private:
    Bodies bodies_;
    std::vector<ClusterLink> links_;  ///< By receiver, then by source.
    std::vector<std::size_t> first_;  ///< Row i, one receiver, stands in links_[first_[i], first_[i + 1]).
};

}  // namespace exitance
