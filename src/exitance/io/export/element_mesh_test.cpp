#include "exitance/io/export/element_mesh.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// Cubic Lagrange polynomials on a triangle, in VTK's order of points: corners, two on each of the edges 01, 12, 20,
/// the centroid.
std::array<double, 10> lagrange(const std::array<double, 3>& L) {
    std::array<double, 10> out;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        out[i] = L[i] * (3 * L[i] - 1) * (3 * L[i] - 2) / 2;
        out[3 + 2 * i] = 4.5 * L[i] * L[j] * (3 * L[i] - 1);
        out[4 + 2 * i] = 4.5 * L[i] * L[j] * (3 * L[j] - 1);
    }
    out[9] = 27 * L[0] * L[1] * L[2];
    return out;
}

TEST(ElementMesh, CubicCellsRepresentCloughTocherElementsExactly) {
    Solution s{.scene = test::make({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1}})};
    SixNodeMesh& mesh = s.discontinuity;
    RandomStream random(1, Stream::mesh);
    const auto any = [&] { return static_cast<float>(random.uniform()); };
    mesh.points = {{0, 0, 0},   {1, 0, 0},     {1, 1, 0},   {0, 1, 0},  {0.5, 0, 0},
                   {1, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 1, 0}, {0, 0.5, 0}};
    mesh.nodes = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 6, 7, 8}};
    mesh.values.resize(mesh.points.size()), mesh.gradients.resize(4), mesh.slopes.resize(2);
    for (auto& value : mesh.values) value.fill(any());
    for (auto& g : mesh.gradients) g[0].fill(any()), g[1].fill(any()), g[2].fill(0);
    for (auto& triangle : mesh.slopes)
        for (auto& slope : triangle) slope.fill(any());
    mesh.gradient_of = {{0, 1, 2}, {0, 2, 3}};
    mesh.region = {RegionId(0), RegionId(0)}, mesh.shadow.resize(2), mesh.edge_order.resize(2);
    const ElementMesh cells = make_cells(s);
    ASSERT_EQ(cells.size(), 6u);
    EXPECT_EQ(cells.cell_types(), std::vector<std::uint8_t>(6, 69));
    // Four corners and two points of the diagonal are shared.
    EXPECT_EQ(cells.points.size(), 4u + 5 * 2 + 2 * 10);
    const SixNodeLocator locator(mesh, s.scene);
    constexpr double rounding = 1e-6;  // rounding of 32-bit floats
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (int k = 0; k < 20; ++k) {
            const double a = random.uniform(), b = random.uniform() * (1 - a);
            const std::array<double, 10> weight = lagrange({a, b, 1 - a - b});
            Point p;
            double light = 0;
            for (std::size_t i = 0; i < 10; ++i) {
                const std::uint32_t node = cells.connectivity[cells.first_point[c] + i];
                p += weight[i] * cells.points[node];
                light += weight[i] * static_cast<double>(cells.irradiance[node][0]);
            }
            EXPECT_NEAR(light, locator.at(RegionId(0), p)[0], rounding);
        }
}

}  // namespace
}  // namespace exitance
