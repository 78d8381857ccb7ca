#include "exitance/direct/source_point.hpp"

#include <algorithm>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

Point uniform_on(std::span<const Point> corners, double area_of_all, double s, double t) {
    double rest = s * 2 * area_of_all;
    for (std::size_t i = 2;; ++i) {
        const Vec3 a = corners[i - 1] - corners[0], b = corners[i] - corners[0];
        const double area = norm(cross(a, b));
        if (rest < area || i + 1 == corners.size()) {
            const Vec2 uv = uniform_in_shape(Patch::Shape::triangle, std::min(rest / area, 1.0), t);
            return corners[0] + uv.x * a + uv.y * b;
        }
        rest -= area;
    }
}

}  // namespace exitance
