#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/bsp/shadow_volume.hpp"

namespace exitance {

/// The shadow volumes of many occluders of one source, merged into one SVBSP tree: an inner node holds a plane of one
/// of the volumes, a leaf the penumbra volumes and umbra volumes that it lies in. A polygon goes down the tree, cut by
/// the planes that it crosses, and is told at once what may hide the source from it, and whether its parts all lie in
/// umbrae, be they of different occluders. Classes are those of the volumes one by one, but exact for polygons, of
/// which ShadowVolume says "partly" where they pass by a corner of a volume. Source: [Chin92], [Gatenby95].
///
/// Volumes of occluders overlap, so that their planes make up to O(planes^3) leaves: past `most_nodes` no more volumes
/// are merged, and the rest is asked one by one.
class MergedVolumes {
  public:
    static constexpr std::size_t most_nodes = 1u << 16;

    /// `space`: what polygons to classify lie in, metres; volumes are cut to it. What is nearer to a plane than
    /// `thickness` lies in it. `most`: of nodes; one volume more may be begun below it.
    MergedVolumes(const Box& space, double thickness, std::size_t most = most_nodes);

    /// Adds a volume, which is the next in order; those that hide nothing have a number, too.
    void add(const ShadowVolume& volume);

    /// What one polygon may be hidden by.
    struct Classes {
        std::vector<std::uint32_t> reached;  ///< Volumes whose penumbra it reaches into, by number.
        bool is_hidden = false;              ///< All of it lies in umbrae.
    };

    /// Classifies a convex polygon within the space; of a part that lies in a plane of the tree, what is behind it
    /// counts. `tests` counts looks at a plane. O(depth) of polygons that no plane cuts.
    void classify(std::span<const Point> polygon, Classes& out, std::size_t& tests) const;

    std::size_t nodes() const { return nodes_.size(); }  ///< Inner nodes and leaves.
    std::size_t unmerged() const { return rest_.size(); }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// A part of space with flat faces, each of a plane of the volume at hand or of another cut.
    struct Face {
        Plane plane;  ///< Its front is within.
        bool is_own = false;
        std::vector<Point> corners;
    };
    using Body = std::vector<Face>;
    struct Node {
        Plane plane;
        std::uint32_t front = none, back = none;  ///< Of leaves: none, and
        std::uint32_t labels = none;              ///< the last of their labels in `labels_`.
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
    std::size_t most_;
    std::vector<Node> nodes_;
    std::vector<Label> labels_;
    std::vector<Unmerged> rest_;
    std::uint32_t count_ = 0;
};

}  // namespace exitance
