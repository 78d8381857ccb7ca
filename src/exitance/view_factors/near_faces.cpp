#include "exitance/view_factors/near_faces.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace exitance {

NearFaces::NearFaces(std::span<const ViewFace> faces, std::span<const Point> middles, std::span<const double> radii) {
    std::map<int, std::vector<std::uint32_t>> by_radius;  // radii of one size differ by a factor of 2 at most
    for (std::uint32_t j = 0; j < faces.size(); ++j)
        by_radius[radii[j] > 0 ? std::ilogb(radii[j]) : std::numeric_limits<int>::min()].push_back(j);
    for (auto& [exponent, members] : by_radius) {
        Size& size = sizes_.emplace_back();
        std::vector<Box> boxes;
        boxes.reserve(members.size());
        for (const std::uint32_t j : members) {
            size.area = std::max(size.area, faces[j].area), size.radius = std::max(size.radius, radii[j]);
            boxes.emplace_back().add(middles[j]);
        }
        size.middles = Bvh(boxes);
        size.faces = std::move(members);
    }
}

}  // namespace exitance
