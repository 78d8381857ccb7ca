#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// The leaves of a tree, laid out for being found by rays in great numbers: every cut is a line in the coordinates of
/// its root, and a grid over the root says from which cut on to look. A handful of steps whatever the depth, where the
/// tree itself takes one or two a level. Immutable; O(elements) to make, about 100 bytes a leaf. Where the tree does
/// not store its fans' triangles, and they are many, they take nothing: they are found by the fans, which takes longer.
class LeafFinder {
  public:
    LeafFinder() = default;
    /// The tree may change or go afterwards; what is found is what was there.
    explicit LeafFinder(const ElementTree& tree);

    struct Found {
        std::uint32_t leaf;  ///< Its place among the leaves in the order of their ids.
        Vec2 uv;             ///< The point in the leaf's own coordinates, pushed into it.
    };
    /// The leaf that holds a point of a root, given in the root's coordinates and within its shape. `root` counts the
    /// tree's roots in the order of their ids.
    Found find(std::size_t root, Vec2 uv) const;

    /// A point of a root, and the leaf that holds it.
    struct Query {
        std::uint32_t root;
        Vec2 uv;
        std::uint32_t leaf;
    };
    /// Fills in the leaves of many points. Memory is asked for ahead of time, so the points do not wait for one
    /// another.
    void find(std::span<Query> queries) const;

    ElementId id(std::uint32_t leaf) const {
        return leaf < leaves_.size() ? leaves_[leaf].id
                                     : ElementId(tree_.first_of_fans().value + (leaf - leaves_.size()));
    }
    std::size_t size() const { return leaves_.size() + (tree_.size() - tree_.first_of_fans().value); }
    /// How many leaves, the first ones, are no such triangles.
    std::size_t own_leaves() const { return leaves_.size(); }
    /// Calls visit(span) for the plain arrays that most of it stands in.
    template <class Visit>
    void visit_arrays(const Visit& visit) const {
        visit(std::span(nodes_)), visit(std::span(leaves_)), visit(std::span(grids_)), visit(std::span(start_));
        visit(std::span(fans_));
    }

  private:
    /// A cut: points with normal . uv >= offset lie in the second part. Parts are nodes, or leaves by their number.
    struct Node {
        Vec2 normal;
        double offset;
        std::uint32_t part[2];

        std::uint32_t part_of(Vec2 uv) const { return part[dot(normal, uv) >= offset ? 1 : 0]; }
    };
    struct Leaf {
        Vec2 origin, du, dv;  ///< Own coordinates are du and dv . (root's - origin).
        ElementId id;
        Patch::Shape shape;
    };
    /// Cells of equal size, powers of two in number, over the unit square of a root.
    struct Grid {
        std::uint32_t first = 0, columns = 1, rows = 1;
    };
    struct Builder;
    struct Frame;
    class FanWalk;
    Leaf leaf_at(std::uint32_t part, Vec2 uv, std::uint32_t& number) const;
    std::size_t cell(std::size_t root, Vec2 uv) const;
    std::uint32_t deepest_around(std::uint32_t part, Vec2 lo, Vec2 hi) const;

    static constexpr std::uint32_t is_leaf = 0x80000000u, is_fan = 0x40000000u;
    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
    std::vector<Leaf> fans_;            ///< Elements cut into fans of triangles that the tree does not store,
    ElementTree tree_;                  ///< and that tree; without elements where there are none.
    std::vector<Grid> grids_;           ///< Of every root.
    std::vector<std::uint32_t> start_;  ///< Of every cell: the part that holds all of it.
};

}  // namespace exitance
