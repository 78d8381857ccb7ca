#include "exitance/io/scenes/cityjson.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "exitance/io/scenes/scene_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// A block of 2 x 1 x 3 units with integer vertices, at two levels of detail: the lower one is a flat roof only.
std::string block(const std::string& version, const std::string& low, const std::string& high) {
    return R"({"type":"CityJSON","version":")" + version + R"(",
"transform":{"scale":[0.001,0.001,0.001],"translate":[85000.0,447000.0,-1.5]},
"CityObjects":{"b1":{"type":"Building","geometry":[
 {"type":"MultiSurface","lod":)" +
           low + R"(,"boundaries":[[[4,5,6,7]]]},
 {"type":"Solid","lod":)" +
           high + R"(,"boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]],
  "semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"}],"values":[[0,1,2,2,2,null]]}}]}},
"vertices":[[0,0,0],[2000,0,0],[2000,1000,0],[0,1000,0],[0,0,3000],[2000,0,3000],[2000,1000,3000],[0,1000,3000]]})";
}

ReadScene read_city(const std::string& text, const std::string& lod = "") {
    const TemporaryFolder folder;
    std::ofstream(folder / "c.city.json") << text;
    return read_cityjson(folder / "c.city.json", lod);
}

TEST(CityJson, ReadsTheHighestLevelWithSemanticsAndMovesTheOrigin) {
    for (const auto& [version, low, high] :
         {std::tuple{"1.0", "1", "2.2"}, {"1.1", R"("1.2")", R"("2.2")"}, {"2.0", R"("0.1")", R"("2.0")"}}) {
        const ReadScene scene = read_city(block(version, low, high));
        const SceneDescription& d = scene.description;
        ASSERT_EQ(d.faces.size(), 6U) << version;
        EXPECT_EQ(d.materials[d.faces[0].material].name, "GroundSurface");
        EXPECT_EQ(d.materials[d.faces[1].material].name, "RoofSurface");
        EXPECT_EQ(d.materials[d.faces[5].material].name, "Building");  // a surface without a semantic type
        EXPECT_EQ(d.groups[d.faces[0].group], "b1");
        EXPECT_EQ(scene.origin.x, 85000);
        EXPECT_EQ(scene.origin.y, 447000);
        EXPECT_EQ(scene.origin.z, 0);  // heights are near 0
        Box box;
        for (const Point& p : d.points) box.add(p);
        EXPECT_NEAR(box.hi.x, 2, 1e-9);
        EXPECT_NEAR(box.lo.z, -1.5, 1e-9);
    }
}

TEST(CityJson, ReadsARequestedLevelAndWarnsOfObjectsWithoutIt) {
    const std::string text = block("1.1", R"("1.2")", R"("2.2")");
    EXPECT_EQ(read_city(text, "1.2").description.faces.size(), 1U);
    const ReadScene none = read_city(text, "3.0");
    EXPECT_TRUE(none.description.faces.empty());
    ASSERT_FALSE(none.findings.empty());
    EXPECT_NE(none.findings.back().message.find("1 city objects have no geometry of level of detail 3.0"),
              std::string::npos);
}

TEST(CityJson, HolesAreCutOut) {
    const TemporaryFolder folder;
    std::ofstream(folder / "h.city.json")
        << R"({"type":"CityJSON","version":"2.0","CityObjects":{"w":{"type":"Building",
"geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2,3],[4,7,6,5],[8,11,10,9]]]}]}},
"vertices":[[0,0,0],[10,0,0],[10,4,0],[0,4,0],[1,1,0],[2,1,0],[2,2,0],[1,2,0],[5,1,0],[7,1,0],[7,3,0],[5,3,0]]})";
    const CheckedScene checked = load_scene(folder / "h.city.json");
    ASSERT_TRUE(checked.scene);
    double area = 0;
    for (const Surface& s : checked.scene->surfaces()) area += s.area;
    EXPECT_NEAR(area, 40 - 1 - 4, 1e-9);
}

TEST(CityJson, PlacesInstancesOfTemplates) {
    const ReadScene scene =
        read_city(R"({"type":"CityJSON","version":"1.1","CityObjects":{"tree":{"type":"SolitaryVegetationObject",
"geometry":[{"type":"GeometryInstance","template":0,"boundaries":[1],"transformationMatrix":[2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1]}]}},
"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}],
"vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},"vertices":[[0,0,0],[5,6,7]]})");
    ASSERT_EQ(scene.description.faces.size(), 1U);
    EXPECT_EQ(scene.description.points[1].x, 7);
    EXPECT_EQ(scene.description.points[2].y, 8);
    EXPECT_EQ(scene.description.points[0].z, 7);
}

TEST(CityJson, SaysWhatIsWrong) {
    const auto first = [](const std::string& text) {
        const ReadScene scene = read_city(text);
        return scene.findings.empty() ? std::string() : scene.findings.front().message;
    };
    EXPECT_NE(first("{").find("is not valid JSON"), std::string::npos);
    EXPECT_NE(first(R"({"type":"FeatureCollection"})").find("is neither a CityJSON file nor a Honeybee model"),
              std::string::npos);
    EXPECT_NE(first(R"({"type":"CityJSON","version":"3.0"})").find("version '3.0' is not supported"),
              std::string::npos);
    EXPECT_NE(first(R"({"type":"CityJSON","version":"1.1","vertices":[[0,0]]})").find("vertex 0"), std::string::npos);
    EXPECT_NE(first(R"({"type":"CityJSON","version":"1.1","vertices":[[0,0,0]],"CityObjects":{"a":{"type":"Road",
"geometry":[{"type":"MultiSurface","lod":"1","boundaries":[[[0,1,2]]]}]}}})")
                  .find("names a vertex that does not exist"),
              std::string::npos);
    EXPECT_NE(first(std::string(1000, '[')).find("nested too deeply"), std::string::npos);
}

}  // namespace
}  // namespace exitance
