#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "exitance/reconstruct/solution.hpp"

namespace exitance {

inline constexpr std::uint8_t vtk_triangle = 5, vtk_quad = 9;

/// The leaves of a solution's interpolant as cells for other programs; every cell has points of its own, its corners
/// counter-clockwise seen from the front.
struct ElementMesh {
    std::vector<ElementId> leaves;
    std::vector<double> points;  ///< x, y, z of each corner of each leaf; metres
    std::vector<float> irradiance, radiosity;  ///< `bands` values a point, W/m^2
    /// Per leaf. A region of many faces may have leaves that lie on several of them: the face at the leaf's centre.
    std::vector<std::int32_t> surface, region, material, group;

    std::size_t point_count() const { return points.size() / 3; }
    std::array<std::pair<const char*, const std::vector<std::int32_t>*>, 4> cell_ids() const {
        return {{{"surface", &surface}, {"region", &region}, {"material", &material}, {"group", &group}}};
    }
};

ElementMesh make_element_mesh(const Solution& solution);

}  // namespace exitance
