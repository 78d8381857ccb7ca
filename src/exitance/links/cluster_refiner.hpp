#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/links/cluster_links.hpp"
#include "exitance/links/error/link_judge.hpp"

namespace exitance {

/// Finds the links between clusters. It starts with a single link of the whole scene to itself. If a pair is not
/// accurate enough, the larger body is split; pairs of two elements are left to the LinkRefiner. Pairs of distant and
/// dim bodies are thus never examined one by one: O(k log k) pairs instead of k^2.
///
/// The error of a link has two parts. The first is an upper bound of its contribution (with the largest cosines over
/// both balls) times the ratio of the bodies' size to their distance. The second is the uncertainty of visibility from
/// rays between points of their members: as large as the whole contribution if some members see each other and others
/// do not. Clusters that contain both sides of a wall are thus split as long as the leaking light matters. Source:
/// [Smits94].
class ClusterRefiner {
  public:
    ClusterRefiner(const LinkSites& sites, const ClusterTree& clusters) : bodies_(sites, clusters) {}

    /// Refines the cluster links found so far. Returns the pairs of elements that must be linked, new ones only.
    std::vector<LinkPair> refine(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop);

    /// Total error of the links: root of the sum of areas times squared errors, W/m^2 m.
    double error() const { return error_; }
    double light() const { return light_; }  ///< Flux of all links, mean of the bands, W.
    std::size_t size() const { return links_.size(); }
    std::size_t rays() const { return rays_; }
    ClusterLinks make_links() const;

    /// Writes or reads the state of the refinement, for checkpoints.
    template <class Archive>
    void archive_state(Archive& a) {
        a(links_, rays_, begun_);
    }

  private:
    /// A link, or a pair that is still undecided.
    struct Found {
        ClusterLink link;
        unsigned rays = 0, open = 0;  ///< Rays cast so far, and how many of them were unoccluded.
        double squared_error = 0, light = 0;
    };
    struct Block;
    class Judge;

    Bodies bodies_;
    std::vector<Found> links_;
    double error_ = 0, light_ = 0;
    std::size_t rays_ = 0;
    bool begun_ = false;
};

}  // namespace exitance
