#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// The leaves of a tree in a layout for finding them for very many rays. Every cut is a line in the coordinates of its
/// root, and a grid over the root gives the cut to start from. A query takes a few steps whatever the depth, whereas
/// the tree itself needs one or two per level. Immutable. Construction: O(elements), about 100 bytes per leaf. If the
/// tree has very many unstored triangles of fans, they are not stored here either but found from the fans, which is
/// slower.
class LeafFinder {
  public:
    LeafFinder() = default;
    /// The tree may be changed or destroyed afterwards; results refer to the tree as it was.
    explicit LeafFinder(const ElementTree& tree);

    struct Found {
        std::uint32_t leaf;  ///< Index among the leaves in the order of their ids.
        Vec2 uv;             ///< The point in the leaf's own coordinates, clamped to it.
    };
    /// Returns the leaf that contains a point of a root, given in the root's coordinates and inside its shape. `root`:
    /// index among the tree's roots in the order of their ids.
    Found find(std::size_t root, Vec2 uv) const;

    /// A point of a root, and the leaf that contains it.
    struct Query {
        std::uint32_t root;
        Vec2 uv;
        std::uint32_t leaf;
    };
    /// Sets `leaf` in all queries. Prefetches memory, so that the queries do not wait for each other.
    void find(std::span<Query> queries) const;

    ElementId id(std::uint32_t leaf) const {
        return leaf < leaves_.size() ? leaves_[leaf].id
                                     : ElementId(tree_.first_of_fans().value + (leaf - leaves_.size()));
    }
    std::size_t size() const { return leaves_.size() + (tree_.size() - tree_.first_of_fans().value); }
    /// Number of leaves that are not unstored triangles of fans; they come first.
    std::size_t own_leaves() const { return leaves_.size(); }
    /// Calls visit(span) for the arrays that hold most of the memory.
    template <class Visit>
    void visit_arrays(const Visit& visit) const {
        visit(std::span(nodes_)), visit(std::span(leaves_)), visit(std::span(grids_)), visit(std::span(start_));
        visit(std::span(fans_));
    }

  private:
    /// A cut: points with normal . uv >= offset are in the second part. A part is a node, or a leaf by its index.
    struct Node {
        Vec2 normal;
        double offset;
        std::uint32_t part[2];

        std::uint32_t part_of(Vec2 uv) const { return part[dot(normal, uv) >= offset ? 1 : 0]; }
    };
    struct Leaf {
        /// For coordinates uv in the root, those in the leaf are du . (uv - origin) and dv . (uv - origin).
        Vec2 origin, du, dv;
        ElementId id;
        Patch::Shape shape;
    };
    /// Equal cells over the unit square of a root; their numbers are powers of two.
    struct Grid {
        std::uint32_t first = 0, columns = 1, rows = 1;
    };
    struct Builder;
    struct Frame;
    class FanWalk;
    Leaf leaf_at(std::uint32_t part, Vec2 uv, std::uint32_t& number) const;
    std::size_t cell(std::size_t root, Vec2 uv) const;
    void join(std::vector<Builder>& blocks);
    static std::uint32_t deepest_around(std::span<const Node> nodes, std::uint32_t part, Vec2 lo, Vec2 hi);

    static constexpr std::uint32_t is_leaf = 0x80000000u, is_fan = 0x40000000u;
    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
    std::vector<Leaf> fans_;            ///< Elements split into fans whose triangles are not stored.
    ElementTree tree_;                  ///< The tree of these fans; empty if there are none.
    std::vector<Grid> grids_;           ///< Per root.
    std::vector<std::uint32_t> start_;  ///< Per cell: the smallest part that contains all of it.
};

}  // namespace exitance
