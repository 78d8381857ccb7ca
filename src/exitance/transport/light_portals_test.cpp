#include "exitance/transport/light_portals.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/transport/ray_rows.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Upright parallelogram of 10 cm by 20 cm, a metre from the origin.
PortalCell upright(double y = 0) {
    return {{1, y, 0.3}, {0, 0.1, 0}, {0, 0, 0.2}, {1, 0, 0}, 0.02, 1000};
}

TEST(PortalAim, BothHalvesOfTheRaysCoverTheHemisphere) {
    // Two parallelograms overlap as seen from the origin, and one is partly below the horizon.
    const std::vector<PortalCell> cells = {
        upright(), upright(0.05), {{0, 1, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, {0, 1, 0}, 0.04, 100}};
    const Normal n{0, 0, 1};
    PortalAim aim;
    aim.set(cells, {0, 0, 0}, n);
    const ScrambledSobol points(1);
    constexpr std::uint32_t rays = 1 << 16;
    double aimed = 0, rest = 0, towards = 0;
    for (std::uint32_t k = 0; k < rays; ++k) {
        const PortalAim::Ray ray = aim.aimed(points(k, 0), points(k, 1));
        EXPECT_TRUE(ray.weight == 0 || aim.is_aimed_at(ray.direction));
        aimed += ray.weight / rays, towards += ray.weight * ray.direction.x / rays;
        const Vec3 w = cosine_direction(Frame(n), points(k, 2), points(k, 3));
        if (!aim.is_aimed_at(w)) rest += 1.0 / rays;
    }
    EXPECT_GT(aimed, 0.003);
    // the rest is estimated from 65,536 points, of which only some hundreds contribute
    EXPECT_NEAR(aimed + rest, 1, 2e-4);
    EXPECT_GT(towards / aimed, 0.3);
}

TEST(PortalAim, DoesNotAimAtNearOrHiddenParallelograms) {
    PortalAim aim;
    const PortalCell cell = upright();
    aim.set(std::span(&cell, 1), {0.95, 0.05, 0.4}, {1, 0, 0});
    EXPECT_EQ(aim.aimed(0.5, 0.5).weight, 0);
    EXPECT_FALSE(aim.is_aimed_at({1, 0, 0}));
    aim.set(std::span(&cell, 1), {0, 0, 0}, {-1, 0, 0});
    EXPECT_EQ(aim.aimed(0.5, 0.5).weight, 0);
    aim.set({}, {0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(aim.aimed(0.5, 0.5).weight, 0);
    EXPECT_FALSE(aim.is_aimed_at({0.5, 0, 0.5}));
}

TEST(LightPortals, AHoleIsFoundAndAimedAtFromTheDarkSide) {
    for (const char* hole : {"0.03", "0.1", "0.3"}) {
        const double side = std::atof(hole);
        const Scene scene = built_scene("keyhole", {{"hole", hole}});
        Stage stage(scene);
        stage.rooms = find_light_rooms(stage, 1, StopRequest());
        ASSERT_EQ(stage.rooms.count(), 2u);
        ASSERT_NE(stage.rooms.portals(), nullptr) << hole;
        EXPECT_TRUE(stage.rooms.portals()
                        ->of_room(1)
                        .empty());  // room 1 is the box. It is the brighter room, so its light needs no portal
        const auto cells = stage.rooms.portals()->of_room(0);
        ASSERT_FALSE(cells.empty()) << hole;
        double area = 0;
        for (const PortalCell& cell : cells) {
            area += cell.area;
            const Point middle = cell.corner + 0.5 * (cell.u + cell.v);
            EXPECT_NEAR(middle.x, 1.48, 0.5 * side + 0.03);
            EXPECT_NEAR(middle.y, 1, side);
            EXPECT_NEAR(middle.z, 0.5, side);
        }
        EXPECT_GT(area, 0.6 * side * side) << hole;
        EXPECT_LT(area, 2 * side * side) << hole;
    }
}

TEST(LightPortals, ANarrowDoorIsCoveredWholeAndItsSidesBelongToTheLitRoom) {
    for (const char* door : {"0.05", "0.1", "0.2"}) {
        const double width = std::atof(door), height = 2.1, bright = 2, dim = 6;
        const Scene scene = built_scene("door", {{"width", door}});
        Stage stage(scene);
        stage.rooms = find_light_rooms(stage, 1, StopRequest());
        ASSERT_EQ(stage.rooms.count(), 2u);
        ASSERT_NE(stage.rooms.portals(), nullptr) << door;
        std::vector<std::size_t> dim_rooms;
        for (const Piece& piece : stage.pieces) {
            const Point at = piece.patch.centre();
            if (at.x > dim) dim_rooms.push_back(stage.rooms.at(piece.region, at));
        }
        ASSERT_FALSE(dim_rooms.empty());
        const std::size_t dim_room = dim_rooms.front();
        for (const std::size_t room : dim_rooms) EXPECT_EQ(room, dim_room);
        for (const Piece& piece : stage.pieces) {
            const Point at = piece.patch.centre();
            const bool is_in_door = at.x > 2 * bright && at.x < 2 * bright + 0.12 && at.z < height;
            EXPECT_NE(is_in_door && stage.rooms.at(piece.region, at) == dim_room, true) << door;
        }
        double area = 0, low = height, high = 0;
        for (const PortalCell& cell : stage.rooms.portals()->of_room(dim_room)) {
            area += cell.area;
            low = std::min({low, cell.corner.z, (cell.corner + cell.u + cell.v).z});
            high = std::max({high, cell.corner.z, (cell.corner + cell.u + cell.v).z});
        }
        EXPECT_GT(area, width * height) << door;
        EXPECT_LT(area, 1.5 * width * height) << door;
        EXPECT_LT(low, 0.01 * height) << door;
        EXPECT_GT(high, 0.99 * height) << door;
    }
}

TEST(RayRows, FindAHoleByAimedRays) {
    constexpr double hole = 0.1;
    const Scene scene = built_scene("keyhole", {{"hole", "0.1"}});
    Stage stage(scene);
    stage.rooms = find_light_rooms(stage, 1, StopRequest());
    ASSERT_NE(stage.rooms.portals(), nullptr);
    const ElementTree tree = stage.make_elements({.edge = 1, .grading_levels = 0});
    const LeafNumbering numbering(tree);
    const ElementLocator locator(tree, scene.regions().size());
    std::vector<Spectrum> b(numbering.leaves.size()), E(b.size());
    for (std::size_t i = 0; i < b.size(); ++i)
        if (stage.rooms.of(tree, numbering.leaves[i]) == 1) b[i] = Spectrum(1.0);
    constexpr std::uint64_t seeds = 8;
    double received = 0, square = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const RayRows F(stage, {tree, numbering, locator}, {{.average = 64, .min = 64, .max = 64}, seed});
        F.gather(b, E);
        double sum = 0;  // light outside the box from unit radiosity inside, W: the hole's area
        for (std::size_t i = 0; i < b.size(); ++i)
            if (b[i][0] == 0) sum += tree.area(numbering.leaves[i]) * E[i][0];
        received += sum / seeds, square += sum * sum / seeds;
        F.gather(std::vector<Spectrum>(b.size(), Spectrum(1.0)), E);
        const std::vector<double> kept = F.kept();
        for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(E[i][0], kept[i], 0.2);
    }
    EXPECT_NEAR(received, hole * hole,
                0.08 * hole * hole);  // each wall element of the hole counts for one of the rooms as a whole
    // Without aiming one ray in ten thousand hits the hole: 64 rays per element then give its light to within a half.
    EXPECT_LT(std::sqrt(square - received * received), 0.1 * hole * hole);
}

}  // namespace
}  // namespace exitance
