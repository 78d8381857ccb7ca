#include "exitance/discontinuity/misfit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// A unit square of many triangles, and a function's values at all nodes.
struct MisfitSheet {
    template <class Light>
    MisfitSheet(const Light& light, int bisections) : mesh(1e-9) {
        const std::vector<std::vector<Vec2>> loops = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        mesh.add(labelled_triangles(loops, {}), PlaneFrame({0, 0, 0}, {0, 0, 1}));
        for (int i = 0; i < bisections; ++i)
            for (std::uint32_t t = 0, n = static_cast<std::uint32_t>(mesh.triangles().size()); t < n; ++t)
                mesh.bisect(t);
        for (const auto& node : mesh.nodes()) values.push_back(Spectrum(light(node.at)));
    }
    std::vector<std::uint32_t> untried(const MisfitLimits& limits) {
        tried.forget_changed(mesh);
        return tried.untried(
            mesh, values, [](std::uint32_t) { return Spectrum(1.0); }, limits);
    }
    BisectionMesh mesh;
    std::vector<Spectrum> values;
    TriedTriangles tried;
};

TEST(TriedTriangles, FlatTrianglesAreTestedOnlyIfLarge) {
    MisfitSheet plane([](const Point& p) { return 3 + p.x - 2 * p.y; }, 4);
    const MisfitLimits limits{.squared = 1e-6, .largest = 1e-3, .tried_area = 1};
    EXPECT_TRUE(plane.untried(limits).empty());
    MisfitLimits small = limits;
    small.tried_area = 1e-6;
    EXPECT_EQ(plane.untried(small).size(), plane.mesh.triangles().size());
}

TEST(TriedTriangles, EachLimitSelectsTheTrianglesAtAShadowEdge) {
    const auto edge = [](const Point& p) { return std::clamp(20 * (p.x - 0.45), 0.0, 1.0); };
    MisfitSheet sheet(edge, 5);
    const auto reaches_edge = [&](std::uint32_t t) {
        double lo = 1, hi = 0;
        for (const std::uint32_t c : sheet.mesh.triangles()[t].corner)
            lo = std::min(lo, sheet.mesh.nodes()[c].at.x), hi = std::max(hi, sheet.mesh.nodes()[c].at.x);
        return hi > 0.45 && lo < 0.5;
    };
    for (const MisfitLimits& limits : {MisfitLimits{.squared = 1e9, .largest = 0.02, .tried_area = 1},
                                       MisfitLimits{.squared = 1e-9, .largest = 1e9, .tried_area = 1}}) {
        const std::vector<std::uint32_t> tried = sheet.untried(limits);
        EXPECT_FALSE(tried.empty());
        EXPECT_LT(tried.size(), sheet.mesh.triangles().size() / 2);
        EXPECT_TRUE(std::all_of(tried.begin(), tried.end(), reaches_edge));
    }
}

TEST(TriedTriangles, TrianglesAreTestedOnceATighterLimitRequiresItAndOnlyOnce) {
    MisfitSheet bowl([](const Point& p) { return p.x * p.x; }, 4);
    MisfitLimits limits{.squared = 1e9, .largest = 1, .tried_area = 1};
    EXPECT_TRUE(bowl.untried(limits).empty());
    limits.largest = 1e-6;
    const std::vector<std::uint32_t> tried = bowl.untried(limits);
    ASSERT_FALSE(tried.empty());
    for (const std::uint32_t t : tried) bowl.tried.set(t, misfit(bowl.mesh, t, bowl.values, Spectrum(1.0)));
    EXPECT_TRUE(bowl.untried(limits).empty());
    // A triangle that is bisected needs light at its nodes only, and counts as untested again.
    bowl.mesh.bisect(tried.front());
    EXPECT_FALSE(bowl.tried.forget_changed(bowl.mesh).empty());
}

}  // namespace
}  // namespace exitance
