#include <gtest/gtest.h>

#include <filesystem>

#include "exitance/base/random.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/io/scenes/obj/obj.hpp"
#include "exitance/samples/generate.hpp"
#include "support/load_obj.hpp"
#include "support/places.hpp"

namespace exitance {
namespace {

/// Splits every face into triangles with points of their own. Some triangles are split again at a random position on an
/// edge, so that neighbours meet in T-vertices.
SceneDescription cut_up(const SceneDescription& whole) {
    SceneDescription out = whole;
    out.points.clear(), out.faces.clear();
    RandomStream random(1, Stream::mesh);
    const auto add = [&](const SceneDescription::Face& face, std::initializer_list<Point> corners) {
        out.faces.push_back(face);
        out.faces.back().corners.clear();
        for (const Point& p : corners) {
            out.faces.back().corners.push_back(static_cast<std::uint32_t>(out.points.size()));
            out.points.push_back(p);
        }
    };
    for (const auto& face : whole.faces) {
        std::vector<Point> outline;
        for (std::uint32_t c : face.corners) outline.push_back(whole.points[c]);
        for (const auto& [i, j, k] : triangulate(outline, normalized(area_vector(outline)))) {
            const Point &a = outline[i], &b = outline[j], &c = outline[k];
            const Point on_edge = a + (0.2 + 0.6 * random.uniform()) * (b - a);
            if (random.uniform() < 0.5)
                add(face, {a, b, c});
            else
                add(face, {a, on_edge, c}), add(face, {on_edge, b, c});
        }
    }
    return out;
}

/// Expects equal regions in the scene and its split copy, in the same order although surface numbers differ.
void expect_same_regions(const SceneDescription& description, const std::string& name) {
    const CheckedScene whole = make_scene(description), cut = make_scene(cut_up(description));
    ASSERT_TRUE(whole.scene && cut.scene) << name;
    EXPECT_GT(cut.scene->surfaces().size(), whole.scene->surfaces().size());
    ASSERT_EQ(cut.scene->regions().size(), whole.scene->regions().size()) << name;
    for (RegionId r : whole.scene->regions().ids()) {
        const Region &a = whole.scene->regions()[r], &b = cut.scene->regions()[r];
        EXPECT_EQ(a.material, b.material) << name;
        EXPECT_EQ(a.plane.n, b.plane.n) << name << ", line " << whole.scene->surfaces()[a.surfaces[0]].line;
        EXPECT_EQ(a.plane.offset, b.plane.offset) << name;
        EXPECT_EQ(a.loops, b.loops) << name << ", line " << whole.scene->surfaces()[a.surfaces[0]].line;
    }
}

TEST(Regions, AreIdenticalInASplitScene) {
    for (const SceneFamily& family : scene_families()) {
        const auto scene = generate_scene(family.name, {});
        ASSERT_TRUE(scene);
        expect_same_regions(*scene, family.name);
    }
    const auto turned = generate_scene("cornell", {{"rot", "33,1,2,3"}, {"shift", "100,200,300"}});
    ASSERT_TRUE(turned);
    expect_same_regions(*turned, "turned");
}

TEST(Regions, OfPublishedScenesDoNotDependOnSplits) {
    for (const char* name : {"complex_m20", "office_2x1x2", "degenerate/slivers", "degenerate/coords_1e6",
                             "degenerate/coplanar_touching", "degenerate/t_vertices", "degenerate/nonplanar_1e-6"}) {
        const std::string path = test::data_folder() + "/scenes/" + name + ".obj";
        const auto scene = load_obj(path);
        ASSERT_TRUE(scene) << scene.error().message;
        expect_same_regions(*scene, name);
    }
}

}  // namespace
}  // namespace exitance
