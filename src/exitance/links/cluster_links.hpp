#pragma once

#include <vector>

#include "exitance/links/link_sites.hpp"
#include "exitance/mesh/cluster_tree.hpp"

namespace exitance {

/// A transport link between two bodies, at least one of which is a cluster; receiver first.
struct ClusterLink {
    Body receiver, source;
    float visible = 1;  ///< Unoccluded share of the light from source to receiver.
};

/// Elements and clusters seen from far away: a centre, a bounding ball, and vector areas.
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

    /// Returns the region of the first element of a body.
    RegionId region(Body b) const;

  private:
    const LinkSites* sites_;
    const ClusterTree* clusters_;
};

/// Vector power of a facing: per band, the sum of A b n over its members, W. The intensity towards w is its component
/// along w, divided by pi.
using VectorPower = std::array<Vec3, bands>;

VectorPower power_of(const LinkSites& sites, ElementId e, const NodalField& b);

/// Vector powers of all facings of the clusters, from the radiosity b of the elements. O(pieces + facings).
Field<FacingId, VectorPower> find_vector_powers(const Bodies& bodies, const NodalField& b);

/// All links to or from clusters.
///
/// A facing of the source with vector power v emits the intensity v.w / pi towards w, if its vector area faces w. At
/// distance r the irradiance is
///
///     E = V v.w / (pi r^2)
///
/// on a plane perpendicular to w. A receiving cluster stores E w per facing, which contributes -E w.n to each member
/// with normal n. A receiving element evaluates it at each node. Linear in b. Source: [Willmott99]. O(links) time, 12
/// bytes per link.
class ClusterLinks {
  public:
    /// `links` may be in any order.
    ClusterLinks(const Bodies& bodies, std::vector<ClusterLink> links);

    std::size_t size() const { return links_.size(); }
    std::size_t memory_bytes() const;

    /// Adds the contribution of these links to E, for b at the sources: to each receiving element, and for receiving
    /// clusters to their pieces.
    void add_to(NodalField& E, const NodalField& b) const;

    /// Marks the elements that are receivers or sources of links.
    void mark(Field<ElementId, std::uint8_t>& marked) const;

  private:
    Bodies bodies_;
    std::vector<ClusterLink> links_;  ///< Sorted by receiver, then by source.
    std::vector<std::size_t> first_;  ///< Row i (one receiver) is links_[first_[i], first_[i + 1]).
};

}  // namespace exitance
