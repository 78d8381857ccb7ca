#pragma once

#include <vector>

#include "exitance/direct/direct_light.hpp"

namespace exitance {

/// Binary tree of clusters over all convex pieces of all emitters but the open sky and the sun, by position,
/// orientation and power. A cluster is split across the widest of its six extents (three of position, three of normals,
/// the latter times its radius) so that each half has about half of its power. The same emitters give the same tree.
/// O(n log^2 n) to build. Source: [Walter05].
class EmitterTree {
  public:
    /// Whether panes through which the sky shines are emitters.
    enum class Windows : std::uint8_t { included, left_out };
    explicit EmitterTree(const DirectLight& direct, Windows windows = Windows::included);

    /// A convex piece of an emitter.
    struct Source {
        DirectLight::SourceName name;
        RegionId region;
        double area = 0;   ///< m^2
        double power = 0;  ///< Mean over bands, W.
    };
    /// Sources in the order of the tree: every cluster is a contiguous range.
    const std::vector<Source>& sources() const { return sources_; }
    /// Prefix sums of the power of the sources; one entry more than there are sources.
    const std::vector<double>& power_before() const { return power_before_; }

    struct Node {
        Point centre;               ///< Centre of power.
        double spread_squared = 0;  ///< Mean squared distance of the sources from the centre, weighted by power, m^2.
        double radius = 0;          ///< Radius of a bounding ball about the centre, m.
        /// Extent along the axis, relative to the centre, m. 0 for lamps in one plane.
        double lowest = 0, highest = 0;
        Vec3 normal;                        ///< Mean normal, weighted by power; shorter than 1 if normals differ.
        double normal_spread = 0;           ///< RMS deviation of the normals from `normal`.
        Normal axis;                        ///< Axis of a cone that contains all normals.
        double cosine = 1, sine = 0;        ///< Cosine and sine of this cone's half angle.
        double power = 0;                   ///< Mean over bands, W.
        Spectrum colour;                    ///< Power per band, relative to the mean over bands.
        std::uint32_t first = 0, last = 0;  ///< Range of the node's sources.
        std::uint32_t left = 0, right = 0;  ///< Children; 0 for a single source.

        bool is_leaf() const { return left == 0; }
    };
    /// The first is the root; empty if there are no emitters.
    const std::vector<Node>& nodes() const { return nodes_; }

    /// Unoccluded light of a cluster at a point.
    struct Term {
        std::uint32_t node = 0;
        double light = 0;  ///< Irradiance without occlusion, mean over bands, W/m^2.
        double error = 0;  ///< Estimated error of `light`, W/m^2.
    };
    /// Disjoint clusters that together contain all emitters. Memory is reused.
    struct Cut {
        std::vector<Term> terms;  ///< Clusters that may contribute, in the order of the tree.
        double light = 0;         ///< Sum over terms, W/m^2.
        double error = 0;  ///< Error of `light`, W/m^2: the terms' errors, which have either sign, added in quadrature.
                           ///< The errors of clusters that count as 0 are then added in full.

        std::vector<Term> next;  ///< Temporary storage.
    };
    /// Splits the clusters with the largest errors until the total error is below max(relative * light, absolute), or
    /// until there are about `max_terms` clusters. About 100 ns per term.
    void cut(const SurfacePoint& at, double relative, double absolute, Cut& out) const;
    static constexpr std::size_t max_terms = 4096;

  private:
    Node make_node(std::uint32_t first, std::uint32_t last) const;
    std::uint32_t middle_of(const Node& node);
    bool is_dark(const Node& node, const Normal& n, const Vec3& d, double up) const;
    Term look_at(std::uint32_t node, const SurfacePoint& at) const;
    void open(const Term& term, const SurfacePoint& at, double most, std::vector<Term>& out) const;
    double exact(const Node& leaf, const SurfacePoint& at) const;

    const DirectLight* direct_;
    std::vector<Source> sources_;
    std::vector<double> power_before_;
    std::vector<Node> nodes_;
};

}  // namespace exitance
