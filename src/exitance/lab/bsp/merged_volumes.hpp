#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/bsp/shadow_volume.hpp"

namespace exitance {

/// Shadow volumes of many occluders of one source, merged into one SVBSP tree. An inner node holds a plane of one of
/// the volumes; a leaf holds the penumbra and umbra volumes that contain it. Classifying a polygon filters it down the
/// tree, splitting it at the planes that it crosses. This yields all occluders that may hide the source from it, and
/// whether every part of it is in the umbra of some occluder (not necessarily the same one). The classes equal those of
/// the separate volumes, but are exact for polygons that pass a corner of a volume, for which ShadowVolume returns
/// `partly`. Source: [Chin92], [Gatenby95].
///
/// Overlapping volumes make O(planes^3) leaves. Once the tree has `max_nodes` nodes no more volumes are merged; the
/// remaining ones are tested one by one.
class MergedVolumes {
  public:
    static constexpr std::size_t max_nodes = 1u << 16;

    /// space  bounds of all polygons that will be classified, metres; volumes are clipped to it
    /// thickness  metres: points nearer to a plane than this are in the plane
    /// most  limit on the number of nodes; the volume during which it is exceeded is still merged
    MergedVolumes(const Box& space, double thickness, std::size_t most = max_nodes);

    /// Adds the next volume. Volumes are numbered in the order of the calls; empty ones get a number, too.
    void add(const ShadowVolume& volume);

    /// Occluders that may hide the source from one polygon.
    struct Classes {
        std::vector<std::uint32_t> reached;  ///< Numbers of the volumes whose penumbra the polygon reaches into.
        bool is_hidden = false;              ///< True if every part of the polygon is in an umbra.
    };

    /// Classifies a convex polygon inside `space`. A part that is in a plane of the tree is classified as if it were
    /// behind the plane. Adds the number of plane tests to `tests`. O(depth) for polygons that no plane cuts.
    void classify(std::span<const Point> polygon, Classes& out, std::size_t& tests) const;

    std::size_t nodes() const { return nodes_.size(); }  ///< Number of inner nodes and leaves.
    std::size_t unmerged() const { return rest_.size(); }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// A face of a convex body. Its plane belongs either to the volume being merged or to an earlier cut.
    struct Face {
        Plane plane;  ///< Plane of the node; its front is the inside of the body.
        bool is_own = false;
        std::vector<Point> corners;
    };
    using Body = std::vector<Face>;
    struct Node {
        Plane plane;
        std::uint32_t front = none, back = none;  ///< `none` in leaves.
        std::uint32_t labels = none;  ///< Leaves: index into `labels_` of the last label; `before` links to the others.
    };
    struct Label {
        std::uint32_t volume = 0;
        bool is_umbra = false;
        std::uint32_t before = none;
    };
    struct Unmerged {
        std::uint32_t number;
        ShadowVolume volume;
    };

    void merge(std::span<const Plane> planes, std::uint32_t volume, bool is_umbra);
    void merge_below(std::uint32_t node, Body body, std::uint32_t volume, bool is_umbra);
    void grow_leaf(std::uint32_t leaf, const Body& body, std::uint32_t volume, bool is_umbra);
    Body cut(const Body& body, const Plane& plane, bool is_own) const;
    void look_below(std::uint32_t node, std::span<const Point> polygon, Classes& out, std::size_t& tests) const;
    void read_leaf(const Node& leaf, Classes& out) const;

    double thickness_, reach_;
    Body space_;
    std::size_t max_;
    std::vector<Node> nodes_;
    std::vector<Label> labels_;
    std::vector<Unmerged> rest_;
    std::uint32_t count_ = 0;
};

}  // namespace exitance
