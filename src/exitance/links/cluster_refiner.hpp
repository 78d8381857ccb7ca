#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/links/cluster_links.hpp"
#include "exitance/links/error/link_judge.hpp"

namespace exitance {

/// Finds which light may pass between clusters. The whole scene begins as linked to itself; of a pair that is not good
/// enough the larger part is cut; pairs of elements are left to the LinkRefiner. So pairs of far and dim bodies are
/// never judged: O(k log k) pairs in place of k^2.
///
/// The error of a link is what it brings (bounded, cosines taken at their largest over both balls) times how large the
/// bodies are beside their distance, and what rays between points of their members leave open of their visibility: as
/// much as all of it where some members see each other and others do not. So clusters that hold both sides of a wall
/// are cut as long as what would leak matters. Source: [Smits94].
class ClusterRefiner {
  public:
    ClusterRefiner(const LinkSites& sites, const ClusterTree& clusters) : bodies_(sites, clusters) {}

    /// Refines the links of clusters that it found before. Returns the pairs of elements that are to be linked, new
    /// ones only.
    std::vector<LinkPair> refine(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop);

    /// Root of areas times squared errors, W/m^2 m.
    double error() const { return error_; }
    double light() const { return light_; }  ///< Flux that all links bring, mean of the bands, W.
    std::size_t size() const { return links_.size(); }
    std::size_t rays() const { return rays_; }
    ClusterLinks make_links() const;

    /// Writes or reads what was found so far, for checkpoints.
    template <class Archive>
    void archive_state(Archive& a) {
        a(links_, rays_, begun_);
    }

  private:
    /// A link, or a pair that is not decided yet.
    struct Found {
        ClusterLink link;
        unsigned rays = 0, open = 0;  ///< Cast so far, and how many of them met nothing.
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
