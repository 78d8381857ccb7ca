#include "exitance/gather/bright_places.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/gather/gather.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A box of 4 x 4 x 3 m whose walls reflect 1 W/m^2, but a square of 0.3 m on the floor `patch` W/m^2.
struct PatchedBox {
    static constexpr double from = 1.8, to = 2.1;
    double patch;
    Scene scene = box_scene(4, 4, 3, 0.5, 1);
    Stage stage{scene};
    ElementTree tree = stage.make_elements({.edge = 0.1});
    PointwiseLight b{[this](RegionId, const Point& y) {
        const bool is_inside = y.z < 0.1 && y.x > from && y.x < to && y.y > from && y.y < to;
        return Spectrum(is_inside ? patch : 1);
    }};
    BrightPlaces bright = find_bright_places(stage, tree, b);

    explicit PatchedBox(double value) : patch(value) {}

    RegionId ceiling() const {
        for (RegionId r : scene.regions().ids())
            if (scene.regions()[r].plane.n.z < -0.5) return r;
        return {};
    }
    /// Mean and variance of the estimates of the irradiance at (1, 1, 3) from `count` gathers of 64 rays.
    std::pair<double, double> gathered(unsigned count) const {
        GatherWorkspace workspace;
        double sum = 0, square = 0;
        for (unsigned k = 0; k < count; ++k) {
            const double E =
                mean(gather_reflected(stage, {1, 1, 3}, {0, 0, -1}, ceiling(), 64, k, b, workspace).irradiance);
            sum += E, square += E * E;
        }
        return {sum / count, square / count - sum * sum / count / count};
    }
};

TEST(BrightPlaces, AreCoveredAndLeaveTheExpectedLight) {
    PatchedBox box(1000);
    ASSERT_FALSE(box.bright.of_room(0).empty());
    double covered = 0;
    for (const PortalCell& cell : box.bright.of_room(0)) {
        covered += cell.area;
        EXPECT_NEAR(cell.corner.z, 0, 1e-9);
    }
    EXPECT_GT(covered, 0.09);  // the patch
    EXPECT_LT(covered, 0.25);  // the rectangles cover only the bright patch and an element around it
    // The rectangle is small for its distance d, so that its form factor is A cos^2 / (pi d^2) to a percent.
    const double d2 = 0.95 * 0.95 + 0.95 * 0.95 + 9, exact = 1 + 999 * 0.09 * 9 / (pi * d2 * d2);
    constexpr unsigned count = 2000;
    const auto [without, spread] = box.gathered(count);
    box.b.aim_at(box.bright);
    const auto [aimed, aimed_spread] = box.gathered(count);
    EXPECT_NEAR(aimed, exact, 0.01 * exact + 4 * std::sqrt(aimed_spread / count));
    EXPECT_NEAR(aimed, without, 4 * std::sqrt(spread / count));
    // Only 0.2 of 64 rays meet the patch, with a variance near their number; aimed rays all meet it or its border.
    EXPECT_LT(aimed_spread, spread / 20);
}

/// The inside of a reflector of 24 facets, 0.3 m wide and open at the bottom, in a room of 4 x 4 x 3 m that reflects
/// 1 W/m^2. `up` is the direction from the floor to the ceiling.
struct RoomWithReflector {
    static constexpr double bright = 1000;
    Frame frame;
    Scene scene;
    Stage stage{scene};
    ElementTree tree = stage.make_elements({.edge = 0.2});
    PointwiseLight b{[this](RegionId, const Point& y) {
        const Vec3 to = y - Point{};
        const double height = dot(to, frame.n), aside = std::hypot(dot(to, frame.u) - 2, dot(to, frame.v) - 2);
        return Spectrum(aside < 0.2 && height > 1.5 && height < 2.5 ? bright : 1);
    }};

    explicit RoomWithReflector(const Normal& up) : frame(up), scene(faces(frame)) {}
    static Scene faces(const Frame& frame) {
        std::vector<test::Face> out = test::closed_box({0, 0, 0}, {4, 4, 3});
        constexpr int count = 24;
        for (int i = 0; i < count; ++i) {
            const auto at = [&](int k, double radius, double z) {
                const double angle = 2 * pi * k / count;
                return Point{2 + radius * std::cos(angle), 2 + radius * std::sin(angle), z};
            };
            out.push_back({{at(i + 1, 0.15, 2), at(i, 0.15, 2), at(i, 0.05, 2.3), at(i + 1, 0.05, 2.3)}});
        }
        for (test::Face& face : out)
            for (Point& p : face.corners) p = Point{} + frame.to_world(p.x, p.y, p.z);
        return test::make(out);
    }
};

TEST(BrightPlaces, AReflectorOfManyFacetsIsCoveredByABox) {
    for (const Normal& up : {Normal{0, 0, 1}, normalized(Vec3{0.3, -0.5, 0.7})}) {
        RoomWithReflector room(up);
        const BrightPlaces bright = find_bright_places(room.stage, room.tree, room.b);
        ASSERT_FALSE(bright.of_room(0).empty());
        GatherWorkspace workspace;
        const RegionId floor = room.scene.surfaces()[SurfaceId(0)].region;
        constexpr unsigned count = 400;
        const auto gathered = [&] {
            double sum = 0, square = 0;
            for (unsigned k = 0; k < count; ++k) {
                const double E = mean(
                    gather_reflected(room.stage, {2.3, 2.2, 0}, {0, 0, 1}, floor, 64, k, room.b, workspace).irradiance);
                sum += E, square += E * E;
            }
            return std::pair(sum / count, square / count - sum * sum / count / count);
        };
        const auto [without, spread] = gathered();
        room.b.aim_at(bright);
        const auto [aimed, aimed_spread] = gathered();
        EXPECT_NEAR(aimed, without, 4 * std::sqrt((spread + aimed_spread) / count));
        // Only 0.4 of 64 rays meet the reflector by chance, but a third of the aimed ones.
        EXPECT_LT(aimed_spread, spread / 10);
    }
}

TEST(BrightPlaces, EvenLightHasNone) {
    const PatchedBox box(3);
    EXPECT_TRUE(box.bright.of_room(0).empty());
}

}  // namespace
}  // namespace exitance
