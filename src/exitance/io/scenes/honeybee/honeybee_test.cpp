#include "exitance/io/scenes/honeybee/honeybee.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "exitance/base/polygon.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/io/scenes/honeybee/punched_outline.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Replaces single quotes, which keep JSON readable in C++, by double quotes.
std::string quoted(std::string json) {
    std::replace(json.begin(), json.end(), '\'', '"');
    return json;
}

/// Properties of an object with a material of its own.
std::string own(const std::string& material) {
    return "'properties': {'radiance': {'modifier': '" + material + "'}}";
}

std::string sheet(const std::string& name, const std::string& corners, const std::string& more) {
    return "{'identifier': '" + name + "', 'geometry': {'type': 'Face3D', 'boundary': [" + corners + "]}, " + more +
           "}";
}

const std::string outdoors = "'boundary_condition': {'type': 'Outdoors'}";
std::string beside(const std::string& name) {
    return "'boundary_condition': {'type': 'Surface', 'boundary_condition_objects': ['" + name + "', 'Room']}";
}

std::string model(const std::string& objects, const std::string& materials = "", const std::string& units = "Meters") {
    return quoted("{'type': 'Model', 'identifier': 'm', 'units': '" + units +
                  "', 'properties': {'radiance': {'modifiers': [" + materials + "]}}, " + objects + "}");
}

ReadScene read(const std::string& json) {
    const TemporaryFolder folder;
    std::ofstream(folder / "m.hbjson") << json;
    return read_honeybee(folder / "m.hbjson");
}

/// Area and area vector of the faces of one object.
struct Extent {
    double area = 0;
    Vec3 vector;
};
Extent extent_of(const SceneDescription& d, const std::string& group) {
    Extent out;
    for (const SceneDescription::Face& face : d.faces) {
        if (d.groups[face.group] != group) continue;
        std::vector<Point> corners;
        for (const std::uint32_t c : face.corners) corners.push_back(d.points[c]);
        out.area += norm(area_vector(corners)), out.vector = out.vector + area_vector(corners);
    }
    return out;
}

const Material& material_of(const SceneDescription& d, const std::string& group) {
    for (const SceneDescription::Face& face : d.faces)
        if (d.groups[face.group] == group) return d.materials[face.material];
    ADD_FAILURE() << "no face of " << group;
    return d.materials.front();
}

// A wall in the plane y = 0 whose front is towards -y, away from a room at y > 0, and a window in it.
const std::string wall = "[0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]",
                  window = "[1, 0, 1], [2, 0, 1], [2, 0, 2], [1, 0, 2]";

TEST(Honeybee, OuterWallsHaveTwoSidesAndAHoleWhereTheWindowIs) {
    const ReadScene scene = read(model(
        "'rooms': [{'faces': [" +
        sheet("w", wall, "'face_type': 'Wall', " + outdoors + ", 'apertures': [" + sheet("g", window, outdoors) + "]") +
        "]}]"));
    ASSERT_TRUE(scene.findings.empty()) << scene.findings[0].message;
    const Extent extent = extent_of(scene.description, "w");
    EXPECT_NEAR(extent.area, 2 * 11, 1e-12);
    EXPECT_NEAR(norm(extent.vector), 0, 1e-12);
    ASSERT_EQ(scene.description.panes.size(), 1u);
    // The generic window transmits 0.64 of perpendicular light.
    EXPECT_NEAR(scene.description.panes[0].transmission(1)[0], 0.64, 1e-3);
    EXPECT_EQ(material_of(scene.description, "w").reflectance[0], 0.5);
}

TEST(Honeybee, FacesInTheGroundShowOnlyTheRoomsSide) {
    const ReadScene scene =
        read(model("'rooms': [{'faces': [" +
                   sheet("w", wall, "'face_type': 'Wall', 'boundary_condition': {'type': 'Ground'}") + "]}]"));
    EXPECT_NEAR(extent_of(scene.description, "w").vector.y, 12, 1e-12);
}

TEST(Honeybee, WallsBetweenRoomsShowEachItsOwnSideAndWindowsAreOnePane) {
    const auto turned = [](const std::string& name, const std::string& partner, const std::string& corners,
                           const std::string& glass) {
        return sheet(
            name, corners,
            "'face_type': 'Wall', " + beside(partner) + ", 'apertures': [" + glass + "], " + own("paint " + name));
    };
    const std::string back = "[0, 0, 3], [4, 0, 3], [4, 0, 0], [0, 0, 0]",
                      window_back = "[1, 0, 2], [2, 0, 2], [2, 0, 1], [1, 0, 1]";
    const std::string paints =
        "{'type': 'Plastic', 'identifier': 'paint a', 'r_reflectance': 0.1, 'g_reflectance': 0.1,"
        " 'b_reflectance': 0.1}, {'type': 'Plastic', 'identifier': 'paint b', 'r_reflectance': "
        "0.2, 'g_reflectance': 0.2, 'b_reflectance': 0.2}";
    const ReadScene scene =
        read(model("'rooms': [{'faces': [" + turned("a", "b", wall, sheet("ga", window, beside("gb"))) +
                       "]}, {'faces': [" + turned("b", "a", back, sheet("gb", window_back, beside("ga"))) + "]}]",
                   paints));
    ASSERT_TRUE(scene.findings.empty()) << scene.findings[0].message;
    EXPECT_NEAR(extent_of(scene.description, "a").vector.y, 11, 1e-12);
    EXPECT_NEAR(extent_of(scene.description, "b").vector.y, -11, 1e-12);
    EXPECT_EQ(material_of(scene.description, "a").reflectance[0], 0.1);
    EXPECT_EQ(material_of(scene.description, "b").reflectance[0], 0.2);
    ASSERT_EQ(scene.description.panes.size(), 1u);
    EXPECT_NEAR(scene.description.panes[0].transmission(1)[0], 0.88, 1e-3);
}

TEST(Honeybee, AirBoundariesAreOpen) {
    const ReadScene scene =
        read(model("'rooms': [{'faces': [" + sheet("air", wall, "'face_type': 'AirBoundary', " + beside("other")) +
                   "," + sheet("w", wall, "'face_type': 'Wall', " + outdoors) + "]}]"));
    EXPECT_EQ(extent_of(scene.description, "air").area, 0);
    EXPECT_EQ(scene.description.faces.size(), 2u);
}

TEST(Honeybee, MaterialsComeFromTheObjectItsRoomTheModelOrTheGenericSet) {
    const auto paint = [](const std::string& name, const std::string& value) {
        return "{'type': 'Plastic', 'identifier': '" + name + "', 'r_reflectance': " + value +
               ", 'g_reflectance': " + value + ", 'b_reflectance': " + value + ", 'specularity': 0}";
    };
    const auto face = [&](const std::string& name, const std::string& more) {
        return sheet(name, wall, "'face_type': 'Wall', " + outdoors + more);
    };
    const std::string json = quoted(
        "{'type': 'Model', 'properties': {'radiance': {'modifiers': [" + paint("one", "0.1") + "," +
        paint("two", "0.2") + "," + paint("three", "0.3") +
        "], 'modifier_sets': [{'identifier': 'set', 'wall_set': {'exterior_modifier': 'two'}}], 'global_modifier_set': "
        "{'wall_set': {'exterior_modifier': 'three'}}}}, 'rooms': [{'properties': {'radiance': {'modifier_set': "
        "'set'}}, 'faces': [" +
        face("own", ", " + own("one")) + "," + face("room", "") + "]}, {'faces': [" + face("model", "") + "," +
        sheet("floor", wall, "'face_type': 'Floor', " + outdoors) + "]}]}");
    const ReadScene scene = read(json);
    ASSERT_TRUE(scene.findings.empty()) << scene.findings[0].message;
    EXPECT_EQ(material_of(scene.description, "own").reflectance[0], 0.1);
    EXPECT_EQ(material_of(scene.description, "room").reflectance[0], 0.2);
    EXPECT_EQ(material_of(scene.description, "model").reflectance[0], 0.3);
    EXPECT_EQ(material_of(scene.description, "floor").reflectance[0], 0.2);  // generic
}

TEST(Honeybee, DiffusingSheetsHaveTwoSidesWithoutARepair) {
    const std::string trans =
        "{'type': 'Trans', 'identifier': 'opal', 'r_reflectance': 0.8, 'g_reflectance': 0.8, 'b_reflectance': 0.8, "
        "'specularity': 0, 'roughness': 0, 'transmitted_diff': 0.6, 'transmitted_spec': 0}";
    ReadScene read_scene = read(
        model("'orphaned_apertures': [" + sheet("o", "[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]", own("opal")) + "]",
              trans));
    EXPECT_TRUE(read_scene.findings.empty());
    const CheckedScene checked = make_scene(std::move(read_scene.description));
    ASSERT_TRUE(checked.scene);
    EXPECT_EQ(checked.scene->surfaces().size(), 2u);
    for (const Finding& finding : checked.findings) EXPECT_NE(finding.kind, Finding::Kind::repair) << finding.message;
}

TEST(Honeybee, ShadesAndMeshesHaveTwoSidesAndTheUnitOfTheModelCounts) {
    const ReadScene scene =
        read(model("'orphaned_shades': [" + sheet("s", wall, own("generic_context_0.20")) +
                       "], 'shade_meshes': [{'identifier': 'mesh', 'geometry': {'vertices': [[0, 0, "
                       "0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], 'faces': [[0, 1, 2], [0, 2, 3]]}}]",
                   "", "Feet"));
    constexpr double foot = 0.3048;
    EXPECT_NEAR(extent_of(scene.description, "s").area, 2 * 12 * foot * foot, 1e-12);
    EXPECT_NEAR(extent_of(scene.description, "mesh").area, 2 * foot * foot, 1e-12);
    EXPECT_EQ(material_of(scene.description, "mesh").reflectance[0], 0.2);
}

TEST(Honeybee, DynamicObjectsAreInTheirFirstState) {
    const std::string states = "'properties': {'radiance': {'states': [{'modifier': 'first', 'shades': [" +
                               sheet("awning", wall, "'x': 0") + "]}, {'modifier': 'second'}]}}";
    const std::string glass =
        "{'type': 'Glass', 'identifier': 'first', 'r_transmissivity': 0.1, 'g_transmissivity': "
        "0.1, 'b_transmissivity': 0.1}";
    const ReadScene scene =
        read(model("'orphaned_apertures': [" + sheet("g", window, outdoors + ", " + states) + "]", glass));
    ASSERT_EQ(scene.description.panes.size(), 1u);
    EXPECT_EQ(scene.description.panes[0].transmissivity[0], 0.1);
    EXPECT_NEAR(extent_of(scene.description, "awning").area, 24, 1e-12);
    ASSERT_EQ(scene.findings.size(), 1u);
    EXPECT_EQ(scene.findings[0].message, "1 object with several states is in the first of them");
}

TEST(Honeybee, DynamicObjectsAreInTheChosenState) {
    const TemporaryFolder folder;
    const std::string states =
        "'properties': {'radiance': {'states': [{'modifier': 'generic_context_0.20'}, {'modifier': "
        "'generic_wall_0.50', 'shades': [" +
        sheet("awning", wall, "'x': 0") + "]}]}}";
    std::ofstream(folder / "m.hbjson") << model("'orphaned_shades': [" + sheet("s", window, states) + "]");
    for (const std::size_t state : {0, 1}) {
        const ReadScene scene = read_honeybee(folder / "m.hbjson", {{"s", state}});
        EXPECT_EQ(material_of(scene.description, "s").reflectance[0], state == 0 ? 0.2 : 0.5);
        EXPECT_NEAR(extent_of(scene.description, "awning").area, state == 0 ? 0 : 24, 1e-12);
    }
}

TEST(Honeybee, GridsAndViewsAreRead) {
    const TemporaryFolder folder;
    std::ofstream(folder / "m.hbjson") << quoted(
        "{'type': 'Model', 'units': 'Centimeters', 'properties': {'radiance': {'sensor_grids': [{'identifier': 'desk', "
        "'sensors': [{'pos': [100, 200, 80], 'dir': [0, 0, 2]}]}], 'views': [{'identifier': 'v', 'position': [0, 0, "
        "100], 'direction': [0, 1, 0], 'up_vector': [0, 0, 1], 'h_size': 50}]}}}");
    const HoneybeeModel model = read_honeybee_model(folder / "m.hbjson");
    ASSERT_EQ(model.grids.size(), 1u);
    EXPECT_EQ(model.grids[0].name, "desk");
    EXPECT_NEAR(norm(model.grids[0].points[0] - Point{1, 2, 0.8}), 0, 1e-15);
    EXPECT_EQ(model.grids[0].normals[0], (Normal{0, 0, 1}));
    ASSERT_EQ(model.views.size(), 1u);
    EXPECT_EQ(model.views[0].fov, 50);
    EXPECT_EQ(model.views[0].eye.z, 1);
}

TEST(Honeybee, OldModelsWithSmallLettersAndUnknownGlassAreRead) {
    const std::string glass =
                          "{'type': 'glass', 'identifier': 'pane', 'r_transmissivity': 0.5, 'g_transmissivity': "
                          "0.5, 'b_transmissivity': 0.5, 'refraction_index': 0.0}",
                      paint =
                          "{'type': 'plastic', 'identifier': 'paint', 'r_reflectance': 0.3, 'g_reflectance': 0.3, "
                          "'b_reflectance': 0.3}";
    const ReadScene scene = read(model("'orphaned_shades': [" + sheet("s", wall, own("paint")) +
                                           "], 'orphaned_apertures': [" + sheet("a", window, own("pane")) + "]",
                                       paint + "," + glass));
    ASSERT_EQ(scene.findings.size(), 1u);
    EXPECT_NE(scene.findings[0].message.find("an index of refraction of 0"), std::string::npos);
    EXPECT_EQ(scene.findings[0].kind, Finding::Kind::warning);
    EXPECT_EQ(material_of(scene.description, "s").reflectance[0], 0.3);
    ASSERT_EQ(scene.description.panes.size(), 1u);
    EXPECT_EQ(scene.description.panes[0].index, Pane().index);
}

TEST(Honeybee, ModelsInJsonFilesAreFoundByTheirType) {
    const TemporaryFolder folder;
    std::ofstream(folder / "m.json") << model("'orphaned_shades': [" + sheet("s", wall, "'x': 0") + "]");
    std::ofstream(folder / "c.json") << quoted("{'note': {'type': 'Model'}, 'type' :\n 'CityJSON'}");
    std::ofstream(folder / "d.json") << quoted("{'type': 'Models', 'name': 'type'}");
    EXPECT_TRUE(is_honeybee_file(folder / "m.json"));
    EXPECT_TRUE(is_honeybee_file(folder / "not_there.hbjson"));
    EXPECT_FALSE(is_honeybee_file(folder / "c.json"));
    EXPECT_FALSE(is_honeybee_file(folder / "d.json"));
    EXPECT_FALSE(is_honeybee_file(folder / "not_there.json"));
    EXPECT_GT(load_scene(folder / "m.json").scene->surfaces().size(), 0u);
}

TEST(Honeybee, FaultsAreNamed) {
    const auto message = [](const std::string& json) {
        const ReadScene scene = read(json);
        return scene.findings.empty() ? std::string() : scene.findings[0].message;
    };
    EXPECT_EQ(message("{\n\"type\": }"), "is not valid JSON here");
    EXPECT_EQ(message("{\"type\": \"Room\"}"), "is not a Honeybee model but 'Room'");
    EXPECT_EQ(message(model("'rooms': []", "", "Cubits")), "the unit of length 'Cubits' is unknown");
    EXPECT_EQ(message(model("'orphaned_shades': [" + sheet("s", "[0, 0], [1, 0, 0], [1, 1, 0]", "'x': 0") + "]")),
              "'s' has a corner that is not three finite numbers");
    EXPECT_EQ(message(model("'orphaned_shades': [" + sheet("s", "[0, 0, 0], [1, 0, 0]", "'x': 0") + "]")),
              "'s' has an outline of fewer than three corners");
    EXPECT_EQ(message(model("'orphaned_shades': [" + sheet("s", wall, own("nothing")) + "]")),
              "the model has no modifier 'nothing', which 's' names");
    EXPECT_EQ(message(model("'rooms': []", "{'type': 'BSDF', 'identifier': 'blind', 'bsdf_data': '<xml/>'}")),
              "material 'blind' is a table of scattered light (BSDF), which is not read");
}

double area(const std::vector<std::vector<Point>>& polygons, const Normal& n) {
    double sum = 0;
    for (const std::vector<Point>& polygon : polygons) {
        EXPECT_GT(dot(area_vector(polygon), n), 0);
        sum += norm(area_vector(polygon));
    }
    return sum;
}

TEST(PunchedOutline, LosesExactlyTheUnionOfItsOpeningsInAnyPlane) {
    // Openings within, at the border, beyond it, beside each other along an edge, and overlapping.
    struct Rectangle {
        double x0, y0, x1, y1;
    };
    struct Case {
        std::vector<Rectangle> openings;
        double left;
    };
    const std::vector<Case> cases{{{{1, 1, 2, 2}}, 11},
                                  {{{0, 0, 1, 3}}, 9},
                                  {{{3, 2, 5, 4}}, 11},
                                  {{{1, 1, 2, 2}, {2, 1, 3, 2}}, 10},
                                  {{{1, 1, 2, 2}, {1.5, 1, 2.5, 2}}, 10.5},
                                  {{{0, 0, 4, 3}}, 0},
                                  {{{0, 0, 4, 1}, {0, 1, 4, 3}}, 0}};
    for (const Normal n : {Normal{0, 0, 1}, Normal{0, -1, 0}, normalized(Vec3{1, 2, -3})})
        for (const Case& c : cases) {
            const Frame frame(n);
            const auto place = [&](const Rectangle& r) {
                const Point o{5, -7, 11};
                return std::vector<Point>{o + frame.to_world(r.x0, r.y0, 0), o + frame.to_world(r.x1, r.y0, 0),
                                          o + frame.to_world(r.x1, r.y1, 0), o + frame.to_world(r.x0, r.y1, 0)};
            };
            std::vector<HoneybeeOutline> openings;
            for (const Rectangle& r : c.openings) {
                openings.push_back({place(r)});
                if (openings.size() % 2 == 0)
                    std::reverse(openings.back().boundary.begin(), openings.back().boundary.end());
            }
            // A sliver of rounding along edges that coincide may be left or missing.
            EXPECT_NEAR(area(punched({place({0, 0, 4, 3})}, openings), n), c.left, 1e-12);
            if (!c.openings.empty()) {
                HoneybeeOutline with_holes{place({0, 0, 4, 3})};
                for (const HoneybeeOutline& opening : openings) with_holes.holes.push_back(opening.boundary);
                EXPECT_NEAR(area(punched(with_holes, {}), n), c.left, 1e-12);
            }
        }
}

}  // namespace
}  // namespace exitance
