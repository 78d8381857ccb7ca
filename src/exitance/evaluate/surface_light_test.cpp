#include "exitance/evaluate/surface_light.hpp"

#include <gtest/gtest.h>

#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// Sets the interpolant to 1 + x + 2 y + 3 z, which every leaf represents exactly.
Solution linear_solution() {
    Solution s = sample_solution(60);
    const ElementTree& tree = s.interpolant.tree;
    for (ElementId e : tree.leaves())
        for (int k = 0; k < tree.patch(e).corner_count(); ++k) {
            const Point p = tree.patch(e).corner(k);
            s.interpolant.values[s.interpolant.first_value[e] + static_cast<unsigned>(k)].fill(
                static_cast<float>(1 + p.x + 2 * p.y + 3 * p.z));
        }
    return s;
}

TEST(MeanLight, IsTheValueAtTheCentroidForALinearFunction) {
    const Solution s = linear_solution();
    const Field<SurfaceId, SurfaceLight> light = mean_light(s);
    for (SurfaceId f : s.scene.surfaces().ids()) {
        const Point c = centroid(s.scene.outline(f));
        const Material& m = s.scene.material(f);
        for (std::size_t b = 0; b < bands; ++b) {
            const double expected = 1 + c.x + 2 * c.y + 3 * c.z;
            EXPECT_NEAR(light[f].irradiance[b], expected, 2e-6) << f.value;  // values are stored as float
            EXPECT_NEAR(light[f].radiosity[b], m.exitance[b] + m.reflectance[b] * expected, 2e-6);
        }
    }
}

TEST(MeanLight, OfARegionsFacesAddsUpToThatOfItsLeaves) {
    const Solution s = sample_solution(100);
    const ElementTree& tree = s.interpolant.tree;
    const Field<SurfaceId, SurfaceLight> light = mean_light(s);
    double of_faces = 0, of_leaves = 0;
    for (SurfaceId f : s.scene.surfaces().ids()) of_faces += s.scene.surfaces()[f].area * mean(light[f].irradiance);
    for (ElementId e : tree.leaves()) {
        const Spectrum sum = integral(s.interpolant, e, tree.outline(e), tree.patch(e).normal());
        if (!tree.is_cell(e)) {  // the mean of a bilinear function is that of its corners
            Spectrum corners;
            const int n = tree.patch(e).corner_count();
            for (int k = 0; k < n; ++k) corners += s.interpolant.at({e, tree.patch(e).corner_uv(k)}) / n;
            EXPECT_NEAR(mean(sum), tree.area(e) * mean(corners), 1e-12);  // rounding
        }
        of_leaves += mean(sum);
    }
    EXPECT_NEAR(of_faces, of_leaves, 1e-10);  // rounding
}

}  // namespace
}  // namespace exitance
