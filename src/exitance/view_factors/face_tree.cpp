#include "exitance/view_factors/face_tree.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "exitance/base/limits.hpp"

namespace exitance {
namespace {

using Coordinates = std::array<double, 6>;

/// Middles of boxes over the size of the scene, and halves of normals, so that none extends over more than 1.
std::vector<Coordinates> coordinates_of(std::span<const ViewFace> faces) {
    Box all;
    for (const ViewFace& face : faces) all.add(face.box);
    const double size = std::max(all.diagonal(), min_divisor);
    std::vector<Coordinates> out;
    out.reserve(faces.size());
    for (const ViewFace& face : faces) {
        const Vec3 at = (1 / size) * (face.box.centre() - all.lo), n = 0.5 * face.plane.n;
        out.push_back({at.x, at.y, at.z, n.x, n.y, n.z});
    }
    return out;
}

std::size_t widest(const std::vector<Coordinates>& coordinates, std::span<const std::uint32_t> faces) {
    Coordinates lo = coordinates[faces[0]], hi = lo;
    for (const std::uint32_t j : faces)
        for (std::size_t d = 0; d < lo.size(); ++d)
            lo[d] = std::min(lo[d], coordinates[j][d]), hi[d] = std::max(hi[d], coordinates[j][d]);
    std::size_t best = 0;
    for (std::size_t d = 1; d < lo.size(); ++d)
        if (hi[d] - lo[d] > hi[best] - lo[best]) best = d;
    return best;
}

}  // namespace

FaceTree::FaceTree(std::span<const ViewFace> faces) : order_(faces.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    number_nodes();
    const std::vector<Coordinates> coordinates = coordinates_of(faces);
    for (const Range& range : ranges_) {  // parents before children
        const std::span<std::uint32_t> members = std::span(order_).subspan(range.first, range.size());
        const std::size_t d = widest(coordinates, members);
        std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
            return coordinates[a][d] < coordinates[b][d] || (coordinates[a][d] == coordinates[b][d] && a < b);
        });
    }
}

FaceTree::FaceTree(std::vector<std::uint32_t> order) : order_(std::move(order)) {
    number_nodes();
}

void FaceTree::number_nodes() {
    if (order_.size() < 2) return;
    ranges_.resize(order_.size() - 1);
    ranges_[0] = {0, static_cast<std::uint32_t>(order_.size())};
    for (std::size_t k = 0; k < ranges_.size(); ++k) {
        const Range range = ranges_[k], left{range.first, range.middle()}, right{range.middle(), range.last};
        if (left.size() > 1) ranges_[first_child(k)] = left;
        if (right.size() > 1) ranges_[second_child(k)] = right;
    }
}

void FaceTree::sum_up(std::span<const double> of_faces, std::span<double> of_nodes) const {
    for (std::size_t k = ranges_.size(); k-- > 0;) {
        const Range range = ranges_[k];
        const std::uint32_t middle = range.middle();
        of_nodes[k] = (middle - range.first > 1 ? of_nodes[first_child(k)] : of_faces[order_[range.first]]) +
                      (range.last - middle > 1 ? of_nodes[second_child(k)] : of_faces[order_[middle]]);
    }
}

void FaceTree::hand_down(std::span<double> of_nodes, std::span<double> of_faces) const {
    for (std::size_t k = 0; k < ranges_.size(); ++k) {
        const Range range = ranges_[k];
        const std::uint32_t middle = range.middle();
        (middle - range.first > 1 ? of_nodes[first_child(k)] : of_faces[order_[range.first]]) += of_nodes[k];
        (range.last - middle > 1 ? of_nodes[second_child(k)] : of_faces[order_[middle]]) += of_nodes[k];
    }
}

}  // namespace exitance
