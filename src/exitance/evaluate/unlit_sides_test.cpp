#include "exitance/evaluate/unlit_sides.hpp"

#include <gtest/gtest.h>

#include "exitance/scene/add_polygon.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using test::Face;

void add_both_sides(std::vector<Face>& faces, Face face) {
    faces.push_back(face);
    std::reverse(face.corners.begin(), face.corners.end());
    faces.push_back(face);
}

/// A room of sheets 2 m wide with a lamp below its ceiling, and a box of sheets on its floor.
std::vector<Face> room_with_box(bool open) {
    std::vector<Face> faces;
    for (const Face& f : test::closed_box({0, 0, 0}, {2, 2, 2})) add_both_sides(faces, f);
    const std::vector<Face> box = test::closed_box({0.5, 0.5, 0}, {0.4, 0.4, 0.4});
    for (std::size_t i = open ? 2 : 1; i < box.size(); ++i)
        add_both_sides(faces, box[i]);  // the bottom is omitted; if `open`, the next face, too
    faces.push_back({{{0.9, 0.9, 1.9}, {0.9, 1.1, 1.9}, {1.1, 1.1, 1.9}, {1.1, 0.9, 1.9}}, 10});
    return faces;
}

/// Front sides have even indices, as closed_box makes them; those of the room and of the box face inwards.
TEST(UnlitSides, AreTheOutsideOfARoomAndTheInsideOfABox) {
    const Scene scene = test::make(room_with_box(false));
    const Stage stage(scene);
    const Field<RegionId, std::uint8_t> unlit = find_unlit_sides(stage, 1, StopRequest());
    ASSERT_EQ(unlit.size(), scene.regions().size());
    for (SurfaceId s : scene.surfaces().ids()) {
        const bool of_room = s.value < 12, inwards = s.value % 2 == 0, lamp = s.value == 22;
        EXPECT_EQ(unlit[scene.surfaces()[s].region] != 0, !lamp && of_room != inwards) << s.value;
    }
}

TEST(UnlitSides, AreNoneInAnOpenBox) {
    const Scene scene = test::make(room_with_box(true));
    const Stage stage(scene);
    const Field<RegionId, std::uint8_t> unlit = find_unlit_sides(stage, 1, StopRequest());
    for (SurfaceId s : scene.surfaces().ids())
        EXPECT_EQ(unlit[scene.surfaces()[s].region] != 0, s.value < 12 && s.value % 2 == 1) << s.value;
}

/// A closed room of sheets with a hole of 5 cm in its ceiling, through which a sun shines on a plate of two sides.
TEST(UnlitSides, AreNotTheSidesThatSeeAPatchOfSun) {
    std::vector<Face> faces = test::closed_box({0, 0, 0}, {4, 4, 3});
    faces.erase(faces.begin() + 1);  // the ceiling
    const auto ceiling = [&](double x0, double y0, double x1, double y1) {
        faces.push_back({{{x0, y0, 3}, {x0, y1, 3}, {x1, y1, 3}, {x1, y0, 3}}});
    };
    ceiling(0, 0, 4, 2), ceiling(0, 2.05, 4, 4), ceiling(0, 2, 2, 2.05), ceiling(2.05, 2, 4, 2.05);
    faces.push_back({{{1, 1, 1}, {3, 1, 1}, {3, 3, 1.4}, {1, 3, 1.4}}});
    std::vector<Face> sheets;
    for (const Face& face : faces) add_both_sides(sheets, face);
    SceneDescription d;
    d.groups = {"all"}, d.materials = {{"grey", Spectrum(0.5), {}}};
    for (const Face& face : sheets) add_polygon(d, face.corners);
    const Vec3 sun = normalized(Vec3{0.02, 0.01, 1});
    d.distant.discs.push_back({sun, 0.005, Spectrum(700.0)});
    CheckedScene checked = make_scene(std::move(d));
    ASSERT_TRUE(checked.scene);
    const Field<RegionId, std::uint8_t> unlit = find_unlit_sides(Stage(*checked.scene), 1, StopRequest());
    ASSERT_EQ(unlit.size(), checked.scene->regions().size());
    for (SurfaceId s : checked.scene->surfaces().ids()) {
        const bool is_plate = s.value >= sheets.size() - 2, inwards = s.value % 2 == 0;
        // true if the sun illuminates the face, provided that it faces outwards
        const bool is_in_sun = dot(checked.scene->surfaces()[s].normal, sun) > 0;
        EXPECT_EQ(unlit[checked.scene->surfaces()[s].region] != 0, !is_plate && !inwards && !is_in_sun) << s.value;
    }
}

TEST(UnlitSides, AreAlsoLargeRegionsThatAreNoSheets) {
    std::vector<Face> faces = test::closed_box({0, 0, 0}, {1, 1, 1});
    faces[0].exitance = 1;
    faces.push_back({{{-20, -20, -1}, {20, -20, -1}, {20, 20, -1}, {-20, 20, -1}}});  // the ground, in the dark
    faces.push_back({{{3, 3, 0}, {4, 3, 0}, {4, 4, 0}, {3, 4, 0}}});                  // dark, too, but small
    const Scene scene = test::make(faces);
    Stage stage(scene);
    stage.set_unlit_sides(find_unlit_sides(stage, 1, StopRequest()));
    for (SurfaceId s : scene.surfaces().ids())
        EXPECT_EQ(stage.is_unlit(scene.surfaces()[s].region), s.value == 6) << s.value;
    EXPECT_NEAR(stage.area, 7, 1e-9);
}

// A lamp in a hood on the ground lights a fiftieth of it.
TEST(UnlitSides, AreNotRegionsOfWhichASmallPartIsLit) {
    std::vector<Face> faces = test::closed_box({3, 3, 0}, {1, 1, 0.5});
    faces.erase(faces.begin());  // the bottom
    faces[0].exitance = 1;       // the top
    faces.push_back({{{0, 0, 0}, {7, 0, 0}, {7, 7, 0}, {0, 7, 0}}});
    const Scene scene = test::make(faces);
    const Field<RegionId, std::uint8_t> unlit = find_unlit_sides(Stage(scene), 1, StopRequest());
    EXPECT_TRUE(unlit.size() == 0 || !unlit[scene.surfaces()[SurfaceId(5)].region]);
}

TEST(UnlitSides, AreNotTheFacesOfALitScene) {
    std::vector<Face> faces = test::closed_box({0, 0, 0}, {1, 1, 1});
    faces[0].exitance = 1;
    const Scene scene = test::make(faces);
    EXPECT_EQ(find_unlit_sides(Stage(scene), 1, StopRequest()).size(), 0u);
}

TEST(UnlitSides, DoNotCountInTheAreaAndAreNotMeshed) {
    const Scene scene = test::make(room_with_box(false));
    Stage stage(scene);
    stage.set_unlit_sides(find_unlit_sides(stage, 1, StopRequest()));
    EXPECT_NEAR(stage.area, 24 + 5 * 0.16 + 0.04, 1e-9);  // room, box and lamp, m^2; coordinates have few digits
    const ElementTree tree = stage.make_elements({0.1, 2});
    std::size_t whole = 0;
    for (ElementId leaf : tree.leaves()) whole += stage.is_unlit(tree.region(leaf)) ? 1 : 0;
    EXPECT_EQ(whole, 11u);
    EXPECT_GT(tree.leaves().size(), 2400u);  // the room's faces become squares of 0.1 m
}

}  // namespace
}  // namespace exitance
