#include "exitance/lab/bsp/ordered_light.hpp"

#include <gtest/gtest.h>

#include <set>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/discontinuity/receiver_curves.hpp"
#include "support/solved.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A floor, random triangles above it, which may intersect, and two lamps, the second one not convex.
Scene crowd(std::uint64_t seed, int count) {
    RandomStream random(seed, Stream::mesh);
    std::vector<test::Face> faces = {{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 0},
                                     {{{-0.5, 0.5, 2}, {0.5, 0.5, 2}, {0.5, -0.5, 2}, {-0.5, -0.5, 2}}, 100},
                                     {{{1, 1.5, 2}, {1.5, 1.5, 2}, {1.2, 1.3, 2}, {1.4, 0.9, 2}, {1, 1, 2}}, 100}};
    for (int i = 0; i < count; ++i) {
        const Point middle = Point{0, 0, 1} + 1.2 * test::any_in_cube(random);
        faces.push_back({{}, 0});
        for (int k = 0; k < 3; ++k) faces.back().corners.push_back(middle + 0.8 * test::any_in_cube(random));
    }
    return test::make(faces);
}

TEST(OrderedLight, EqualsTheLightFoundByShafts) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Scene scene = crowd(seed, 14);
        const Occluders occluders(scene);
        const DirectLight direct(scene, occluders);
        const OrderedLight ordered(direct, seed % 2 == 0);
        DirectLight::Workspace workspace;
        RandomStream random(seed, Stream::mesh, 1);
        for (const RegionId r : scene.regions().ids()) {
            const Region& region = scene.regions()[r];
            if (region.loops.size() != 1 || !is_convex(region.loops[0], region.plane.n)) continue;
            OrderedLight::Counts counts;
            const ReceiverLight whole = ordered.look(region.loops[0], r, workspace, counts);
            // The faces are a fan of triangles around an interior point.
            const Point middle = centroid(region.loops[0]);
            FaceOutlines outlines{{}, {}, {}};
            const auto& loop = region.loops[0];
            for (std::size_t i = 0; i < loop.size(); ++i)
                outlines.faces.push_back({loop[i], loop[(i + 1) % loop.size()], middle});
            std::vector<ReceiverLight> lights(outlines.faces.size());
            const StopRequest stop;
            ordered.look(outlines, whole, lights, stop, workspace, counts);
            for (std::size_t f = 0; f < lights.size(); ++f)
                for (int k = 0; k < 20; ++k) {
                    const double a = random.uniform(), b = random.uniform() * (1 - a);
                    const auto& face = outlines.faces[f];
                    const Point x = face[0] + a * (face[1] - face[0]) + b * (face[2] - face[0]);
                    const double expected = mean(direct.irradiance(x, region.plane.n, r, workspace));
                    // Tolerance: rounding, and slivers of that width at the borders of volumes.
                    EXPECT_NEAR(mean(direct.irradiance(whole, x, workspace)), expected, 1e-8);
                    EXPECT_NEAR(mean(direct.irradiance(lights[f], x, workspace)), expected, 1e-8);
                }
            EXPECT_TRUE(counts.plane_tests > 0 || whole.is_unshadowed());
        }
    }
}

TEST(OrderedLight, WedgesAreClippedToTheSameCurvesAsByATreeOfBoxes) {
    const auto curves = [](const Scene& scene, OccluderStructure structure) {
        SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.01};
        options.discontinuity.structure = structure;
        return solved(scene, options);
    };
    std::size_t found = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Scene scene = crowd(seed, 6);
        const Solution by_lists = curves(scene, OccluderStructure::bsp),
                       by_boxes = curves(scene, OccluderStructure::bvh);
        const auto set_of = [](const Solution& s) {
            std::multiset<std::array<long, 8>> out;  // nanometres
            const auto nm = [](double v) { return std::lround(1e9 * v); };
            for (const DiscontinuityCurve& c : s.discontinuity.curves)
                out.insert({static_cast<long>(c.region.value), nm(c.a.x), nm(c.a.y), nm(c.a.z), nm(c.b.x), nm(c.b.y),
                            nm(c.b.z), static_cast<long>(c.order)});
            return out;
        };
        EXPECT_EQ(set_of(by_lists), set_of(by_boxes)) << seed;
        EXPECT_EQ(set_of(curves(scene, OccluderStructure::merged)), set_of(by_boxes)) << seed;
        found += by_lists.discontinuity.curves.size();
        const auto& figures = by_lists.statistics.figures;
        EXPECT_GT(figures.at("plane_tests"), 0);
        EXPECT_GE(figures.at("fragments"), static_cast<double>(scene.regions().size()));
        // Lists are counted before shadow volumes remove pieces that do not reach a face.
        EXPECT_GE(figures.at("candidate_share"), by_boxes.statistics.figures.at("candidate_share"));
    }
    EXPECT_GT(found, 200u);
}

}  // namespace
}  // namespace exitance
