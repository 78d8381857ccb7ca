#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/view_factors/view_face.hpp"

namespace exitance {

/// Finds the faces whose view factor from a point is not negligible, in much less time than a loop over all faces: one
/// bounding tree over the middles of the faces of each size. O(n log n) to build; memory O(n).
class NearFaces {
  public:
    NearFaces() = default;
    /// `middles`: mean of the corners of each face. `radii`: largest distance of a face's corner from its middle,
    /// metres.
    NearFaces(std::span<const ViewFace> faces, std::span<const Point> middles, std::span<const double> radii);

    /// Calls visit(face) for every face j with A_j >= pi d^2 `negligible` or d <= 2 (`reach` + radius of j), d the
    /// distance of its middle from x, and for some of the others. The order depends on the faces only.
    template <class Visit>
    void visit(const Point& x, double reach, double negligible, const Visit& visit) const {
        for (const Size& size : sizes_) {
            const double d = std::max(std::sqrt(size.area / (pi * negligible)), 2 * (reach + size.radius));
            Box around;
            around.add(x - Vec3{d, d, d}), around.add(x + Vec3{d, d, d});
            size.middles.visit_box(around, [&](std::uint32_t k) { visit(size.faces[k]); });
        }
    }

  private:
    /// Faces of about the same size.
    struct Size {
        double area = 0, radius = 0;  ///< Largest area (m^2) and largest radius (m) of these faces.
        std::vector<std::uint32_t> faces;
        Bvh middles;  ///< Items are indices in `faces`.
    };
    std::vector<Size> sizes_;
};

}  // namespace exitance
