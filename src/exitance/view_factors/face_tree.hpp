#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/view_factors/view_face.hpp"

namespace exitance {

/// A balanced binary tree over faces, in which faces of similar direction and place share nodes. A node is a range of
/// `order()`; its children are the two halves of the range. Nodes with at least two faces are numbered from 0, parents
/// before children, first children before second ones. Memory: 12 bytes per face.
class FaceTree {
  public:
    struct Range {
        std::uint32_t first = 0, last = 0;
        std::uint32_t size() const { return last - first; }
        std::uint32_t middle() const { return first + size() / 2; }  ///< Start of the second child.
    };

    FaceTree() = default;
    /// Halves the faces at the median of the coordinate that varies most: the middle of the face's box over the size of
    /// the scene, or half of its normal. O(n log^2 n). The result depends on the faces only.
    explicit FaceTree(std::span<const ViewFace> faces);
    /// Restores a tree from a permutation of the numbers of all faces.
    explicit FaceTree(std::vector<std::uint32_t> order);

    std::size_t size() const { return order_.size(); }    ///< Number of faces.
    std::size_t nodes() const { return ranges_.size(); }  ///< size() - 1, or 0 without faces.
    /// Faces in the order of the tree: the faces of a node are consecutive.
    std::span<const std::uint32_t> order() const { return order_; }
    const Range& range(std::size_t node) const { return ranges_[node]; }
    static std::size_t first_child(std::size_t node) { return node + 1; }  ///< Valid for nodes with at least two faces.
    std::size_t second_child(std::size_t node) const { return node + ranges_[node].size() / 2; }  ///< Likewise.

    /// Sets `of_nodes[k]` to the sum of the values of the faces of node k.
    void sum_up(std::span<const double> of_faces, std::span<double> of_nodes) const;
    /// Adds to each face the values of all nodes that contain it. Changes `of_nodes`. Adjoint of sum_up().
    void hand_down(std::span<double> of_nodes, std::span<double> of_faces) const;

  private:
    void number_nodes();

    std::vector<std::uint32_t> order_;
    std::vector<Range> ranges_;
};

}  // namespace exitance
