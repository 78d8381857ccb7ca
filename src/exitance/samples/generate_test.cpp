#include "exitance/samples/generate.hpp"

#include <gtest/gtest.h>

#include "exitance/samples/mersenne_twister.hpp"

namespace exitance {
namespace {

using Parameters = std::map<std::string, std::string>;

SceneDescription make(const std::string& family, const Parameters& parameters = {}) {
    Result<SceneDescription> scene = generate_scene(family, parameters);
    EXPECT_TRUE(scene) << family << ": " << (scene ? "" : scene.error().message);
    return scene ? *scene : SceneDescription{};
}

Vec3 area_vector_of(const SceneDescription& scene) {
    Vec3 sum;
    for (const auto& face : scene.faces) {
        std::vector<Point> outline;
        for (std::uint32_t c : face.corners) outline.push_back(scene.points[c]);
        sum += area_vector(outline);
    }
    return sum;
}

TEST(MersenneTwister, AgreesWithPython) {
    MersenneTwister seven(7);
    EXPECT_EQ(seven.uniform(0, 1), 0.32383276483316237);  // random.Random(7).random(), and following calls
    EXPECT_EQ(seven.uniform(0, 1), 0.15084917392450192);
    EXPECT_EQ(seven.uniform(0, 1), 0.6509344730398537);
    for (std::uint32_t expected : {0u, 4u, 0u, 2u, 4u, 0u, 4u, 1u}) EXPECT_EQ(seven.below(5), expected);
    EXPECT_EQ(MersenneTwister((1ull << 40) + 5).uniform(0, 1), 0.5043802970418443);
}

TEST(SceneFamilies, HaveTheStatedPolygonCounts) {
    const std::vector<std::tuple<std::string, Parameters, std::size_t>> expected = {
        {"blocker", {}, 3},
        {"tube", {}, 6},
        {"furnace", {}, 12},
        {"furnace", {{"inner", "0"}}, 6},
        {"complex", {}, 167},
        {"complex", {{"m", "1"}}, 32},
        {"complex", {{"m", "7"}}, 194},
        {"flat", {}, 2},
        {"boxes", {{"lights", "3"}}, 16},
        {"table", {}, 34},
        {"chair", {}, 65},
        {"float", {}, 214},
        {"spiral", {}, 112},
        {"spiral", {{"steps", "4"}, {"sides", "40"}}, 68},
        {"gcr1", {}, 3},
        {"gcr2", {}, 5},
        {"cornell", {}, 17},
        {"office", {{"nx", "2"}, {"ny", "1"}, {"nfurn", "2"}, {"books", "3"}}, 647},
        {"office", {{"nx", "1"}, {"ny", "1"}, {"nfurn", "0"}}, 42},
        {"carpet", {{"u", "7"}, {"v", "4"}, {"cuts", "2"}, {"books", "1"}}, 7 * 4 + 4 * (822 + 160)},
        {"cove", {}, 20},
        {"blinds", {{"slats", "9"}}, 7 + 18},
        {"clutter", {{"n", "20"}}, 12 + 40},
        {"gaps", {}, 28},
        {"door", {}, 26},
        {"keyhole", {}, 27},
        {"bright", {}, 22},
        {"tree", {{"leaves", "30"}}, 17 + 60},
        {"lightwell", {}, 14},
        {"atrium", {{"floors", "2"}}, 7 + 40},
        {"stair", {{"steps", "5"}}, 24 + 30},
        {"colonnade", {{"columns", "2"}, {"sides", "8"}}, 9 + 16},
        {"greenhouse", {{"ribs", "3"}, {"purlins", "1"}}, 12 + 66 + 12},
        {"furniture", {{"n", "0"}}, 12},
        {"canopy", {{"roofs", "2"}}, 14},
        {"canopy", {{"sun", "0"}}, 8}};
    for (const auto& [family, parameters, count] : expected) {
        const SceneDescription description = make(family, parameters);
        EXPECT_EQ(description.faces.size(), count) << family;
        const CheckedScene scene = make_scene(description);
        ASSERT_TRUE(scene.scene) << family << ": " << scene.scene.error().message;
        EXPECT_TRUE(scene.findings.empty()) << family << ": " << scene.findings[0].message;
        EXPECT_EQ(scene.scene->surfaces().size(), count);
        EXPECT_FALSE(scene.scene->emitters().empty());
    }
}

TEST(SceneFamilies, EveryFamilyCanBeMadeWithItsDefaults) {
    for (const SceneFamily& family : scene_families()) EXPECT_FALSE(make(family.name).faces.empty()) << family.name;
}

TEST(SceneFamilies, ClosedSolidsAreClosed) {
    // Corners are rounded to 12 decimals; an object on a floor hides as much of the floor as its own missing bottom.
    for (const char* family : {"tube", "furnace", "lightwell", "door"})
        EXPECT_LT(norm(area_vector_of(make(family))), 1e-10) << family;
}

TEST(SceneFamilies, TheFurnaceEmitsOneWattPerSquareMetre) {
    const SceneDescription furnace = make("furnace", {{"rho", "0.8"}});
    EXPECT_DOUBLE_EQ(furnace.materials[0].exitance[0], 1);
    EXPECT_EQ(furnace.materials[0].reflectance[0], 0.8);
    EXPECT_EQ(furnace.file, "furnace_r0p8.obj");
}

TEST(SceneFamilies, TheRoomOfChairsGrowsWithTheirNumber) {
    EXPECT_NEAR(make("complex", {{"m", "1"}}).points[0].y, 2.4, 1e-12);
    EXPECT_NEAR(make("complex", {{"m", "25"}}).points[0].y, 12, 1e-12);
}

TEST(SceneFamilies, MayBeRotatedScaledShiftedAndNamed) {
    const SceneDescription plain = make("flat");
    const SceneDescription moved =
        make("flat", {{"rot", "90,0,0,2"}, {"scale", "2"}, {"shift", "1,0,-1"}, {"name", "moved"}});
    EXPECT_EQ(moved.file, "moved.obj");
    ASSERT_EQ(moved.points.size(), plain.points.size());
    for (std::size_t i = 0; i < plain.points.size(); ++i) {
        const Point p = plain.points[i], expected{1 - 2 * p.y, 2 * p.x, 2 * p.z - 1};
        EXPECT_LT(norm(moved.points[i] - expected), 2e-12);  // rounded to 12 decimals
    }
}

TEST(SceneFamilies, WrongParametersAreUsageErrors) {
    const std::vector<std::pair<std::string, Parameters>> wrong = {{"palace", {}},
                                                                   {"flat", {{"light", "1"}}},
                                                                   {"flat", {{"lights", "5"}}},
                                                                   {"flat", {{"lights", "one"}}},
                                                                   {"flat", {{"lights", "1.5"}}},
                                                                   {"flat", {{"lights", ""}}},
                                                                   {"flat", {{"rot", "90,0,0"}}},
                                                                   {"flat", {{"rot", "90,0,0,0"}}},
                                                                   {"flat", {{"shift", "1,2,3,4"}}},
                                                                   {"flat", {{"scale", "0"}}},
                                                                   {"tube", {{"rho", "1"}}},
                                                                   {"tube", {{"rho", "nan"}}},
                                                                   {"office", {{"nx", "2000"}, {"ny", "2000"}}},
                                                                   {"cove", {{"at", "2.75"}}}};
    for (const auto& [family, parameters] : wrong) {
        const auto scene = generate_scene(family, parameters);
        ASSERT_FALSE(scene) << family;
        EXPECT_EQ(scene.error().code, ErrorCode::usage);
        EXPECT_FALSE(scene.error().message.empty());
    }
}

}  // namespace
}  // namespace exitance
