#include "exitance/methods/light/mesh_of_layers.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "exitance/error/area_samples.hpp"
#include "exitance/evaluate/layer_elements.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "exitance/scene/emitter_groups.hpp"
#include "exitance/solution/layers/light_layers.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"
#include "support/checked_scene.hpp"
#include "support/motion.hpp"
#include "support/solved.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// A closed room of 3 x 3 x 2 m with a board on legs of air, under two lamps of one material and a point light. If
/// `first`, `second` and `third` are not 1, these lights are dimmed.
Scene room(const Motion& motion = as_written, double first = 1, double second = 1, double third = 1) {
    SceneDescription d;
    d.materials = {{"wall", Spectrum(0.5), Spectrum()}, {"lamp", Spectrum(0), Spectrum(20)}};
    d.groups = {"room", "left", "right"};
    int line = 0;
    const auto face = [&](std::vector<Point> corners, std::uint32_t material, std::uint32_t group) {
        for (Point& p : corners) p = motion(p);
        SceneDescription::Face& f = add_polygon(d, corners);
        f.material = material, f.group = group, f.line = ++line;
    };
    face({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}}, 0, 0);
    face({{0, 0, 2}, {0, 3, 2}, {3, 3, 2}, {3, 0, 2}}, 0, 0);
    face({{0, 0, 0}, {0, 0, 2}, {3, 0, 2}, {3, 0, 0}}, 0, 0);
    face({{3, 0, 0}, {3, 0, 2}, {3, 3, 2}, {3, 3, 0}}, 0, 0);
    face({{3, 3, 0}, {3, 3, 2}, {0, 3, 2}, {0, 3, 0}}, 0, 0);
    face({{0, 3, 0}, {0, 3, 2}, {0, 0, 2}, {0, 0, 0}}, 0, 0);
    face({{1, 1, 0.7}, {1.9, 1.1, 0.7}, {1.8, 2, 0.7}, {0.9, 1.9, 0.7}}, 0, 0);
    face({{1, 1, 0.7}, {0.9, 1.9, 0.7}, {1.8, 2, 0.7}, {1.9, 1.1, 0.7}}, 0, 0);
    face({{0.4, 0.4, 1.9}, {0.4, 0.8, 1.9}, {0.8, 0.8, 1.9}, {0.8, 0.4, 1.9}}, 1, 1);
    face({{2.2, 2, 1.9}, {2.2, 2.4, 1.9}, {2.6, 2.4, 1.9}, {2.6, 2, 1.9}}, 1, 2);
    PunctualLight bulb;
    bulb.name = "bulb", bulb.position = motion({1.5, 0.5, 1.5});
    bulb.intensity = Spectrum(third * motion.scale * motion.scale);
    d.lights.push_back(bulb);
    part_emitters_by_group(d);
    const std::vector<double> factor{first, second};
    std::size_t next = 0;
    for (SceneDescription::Face& f : d.faces)
        if (d.materials[f.material].emits()) {
            d.materials.push_back(Material(d.materials[f.material]));
            d.materials.back().exitance *= factor[next++];
            f.material = static_cast<std::uint32_t>(d.materials.size() - 1);
        }
    return checked_scene(std::move(d));
}

SolveOptions options(bool layers, double error = 0.02) {
    SolveOptions out{.method = Method::discontinuity, .error = error, .error_interpolant = error};
    out.discontinuity.layers = layers;
    return out;
}

std::uintmax_t size_of(const std::string& path, const Solution& solution) {
    EXPECT_TRUE(write_solution(path, solution));
    return std::filesystem::file_size(path);
}

void expect_same_mesh(const SixNodeMesh& a, const SixNodeMesh& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.values, b.values);
    EXPECT_EQ(a.nodes, b.nodes);
    EXPECT_EQ(a.edge_order, b.edge_order);
    EXPECT_EQ(a.shadow, b.shadow);
    EXPECT_EQ(a.curves.size(), b.curves.size());
}

std::vector<Spectrum> light_at(const Solution& s, std::span<const ProbePoint> points) {
    std::vector<Spectrum> out;
    for (const Light& light : RadiosityFunction(s).interpolant_at(points)) out.push_back(light.irradiance);
    return out;
}

double difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b) {
    double square = 0, sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) square += squared(a[i] - b[i]) / bands, sum += mean(b[i]);
    const auto n = static_cast<double>(a.size());
    return std::sqrt(square / n) / (sum / n);
}

}  // namespace

TEST(MeshOfLayers, FilesWithLayersAreSmallAndTheirMeshHasTheBitsOfOneWithout) {
    const TemporaryFolder folder;
    for (const Motion& motion : {as_written, turned_and_moved}) {
        const Solution single = solved(room(motion), options(false)), layered = solved(room(motion), options(true));
        EXPECT_TRUE(layered.discontinuity.empty());
        EXPECT_EQ(layered.indirect.values, single.indirect.values);
        EXPECT_LT(3 * size_of(folder / "layers.h5", layered), size_of(folder / "single.h5", single));
        Result<Solution> back = load_solution(folder / "layers.h5");
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->interpolant.values, layered.interpolant.values) << "the elements follow from the layers";
        const std::vector<ProbePoint> points = points_uniform_in_area(single.scene, 300, 2);
        EXPECT_EQ(light_at(*back, points), light_at(layered, points));
        const std::vector<Light> a = RadiosityFunction(*back).at(points), b = RadiosityFunction(single).at(points);
        for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(a[i].irradiance, b[i].irradiance) << i;
        ASSERT_TRUE(make_requested_mesh(*back));
        expect_same_mesh(back->discontinuity, single.discontinuity);
        EXPECT_EQ(back->interpolant.values, single.interpolant.values);
    }
}

TEST(MeshOfLayers, ElementsFollowTheLayersWithinTheErrorOfTheExport) {
    const Solution s = solved(room(), options(true));
    Solution plain = s;
    plain.layers = {};
    const std::vector<ProbePoint> points = points_uniform_in_area(s.scene, 2000, 5);
    // Their misfit is relative to reflected light, which is half of the arriving light, and it is measured at nodes.
    EXPECT_LT(difference(light_at(plain, points), light_at(s, points)), 0.05);
    EXPECT_EQ(elements_of_layers(s).values, s.interpolant.values);
}

TEST(MeshOfLayers, OptionsOfTheMeshAreReadBackExactly) {
    SolveOptions asked = options(true, 0.1 / 3);
    asked.seed = 12345678901234567ULL;
    asked.discontinuity.lines = ShadowLines{.kind = ShadowLines::Kind::on_surfaces, .names = {"a, b", "all"}};
    asked.discontinuity.largest_error = 0.2 / 3;
    asked.discontinuity.sources = SecondarySources{.power = 0.7 / 3};
    asked.discontinuity.structure = OccluderStructure::merged;
    asked.discontinuity.triangulation = TriangulationScheme::heuristic;
    const std::string text = describe_mesh(asked);
    const Result<SolveOptions> read = read_mesh_options(text);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(describe_mesh(*read), text);
    EXPECT_EQ(read->seed, asked.seed);
    EXPECT_EQ(*read->error_interpolant, asked.error_target());
    EXPECT_EQ(read->discontinuity.lines->names, asked.discontinuity.lines->names);
    EXPECT_EQ(read->discontinuity.largest_error, asked.discontinuity.largest_error);
    EXPECT_EQ(read->discontinuity.sources->power, asked.discontinuity.sources->power);
    for (const char* wrong : {"--layers on", "--seed x", "--error-interpolant -1", "--method matrix", "hello"})
        EXPECT_FALSE(read_mesh_options(wrong)) << wrong;
}

TEST(MeshOfLayers, EveryLayerIsThatOfALightGroupAndIsDimmedWithIt) {
    for (const Motion& motion : {as_written, turned_and_moved}) {
        Solution s = solved(room(motion), options(true));
        EXPECT_EQ(layers_of(s).groups, (std::vector<std::string>{"left", "right", "bulb"}));
        Progress silent;
        const StopRequest stop;
        Result<LightGroups> groups = keep_light_groups(s, options(true), silent, stop);
        ASSERT_TRUE(groups) << groups.error().message;
        ASSERT_EQ(groups->groups.size(), 3u);
        const std::vector<ProbePoint> points = points_uniform_in_area(s.scene, 1000, 4);
        const std::vector<Spectrum> before = light_at(s, points);
        for (const std::array<double, 3>& f : {std::array{0.5, 1.0, 2.0}, std::array{0.0, 0.25, 0.0}}) {
            ASSERT_TRUE(change_light(s, *groups, {.dim = {{"left", f[0]}, {"right", f[1]}, {"bulb", f[2]}}}));
            const Solution fresh = solved(room(motion, f[0], f[1], f[2]), options(true));
            // 2% each, and the layers of brighter lamps have up to twice their error.
            EXPECT_LT(difference(light_at(s, points), light_at(fresh, points)), 0.05);
        }
        ASSERT_TRUE(change_light(s, *groups, {.dim = {{"left", 1}, {"right", 1}, {"bulb", 1}}}));
        EXPECT_LT(difference(light_at(s, points), before), 1e-6) << "layers keep undimmed light";
    }
}

TEST(MeshOfLayers, DimmedLayersAreWrittenAndMeshedLikeOthers) {
    const TemporaryFolder folder;
    Solution s = solved(room(), options(true));
    Progress silent;
    const StopRequest stop;
    Result<LightGroups> groups = keep_light_groups(s, options(true), silent, stop);
    ASSERT_TRUE(groups);
    ASSERT_TRUE(change_light(s, *groups, {.dim = {{"left", 0.5}, {"bulb", 0}}}));
    ASSERT_TRUE(write_solution(folder / "mixed.h5", s, &*groups));
    LightGroups groups_back;
    Result<Solution> back = load_solution(folder / "mixed.h5", Rehearsed::not_yet, &groups_back);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(layers_of(*back).factors, (std::vector<double>{0.5, 1, 0}));
    EXPECT_EQ(back->interpolant.values, s.interpolant.values);
    const std::vector<ProbePoint> points = points_uniform_in_area(s.scene, 1000, 4);
    EXPECT_EQ(light_at(*back, points), light_at(s, points));
    ASSERT_TRUE(make_requested_mesh(*back));
    back->layers = {};
    EXPECT_LT(difference(light_at(*back, points), light_at(s, points)), 0.05);
}

TEST(MeshOfLayers, SnapshotsHoldTheSourcesSoFar) {
    SolveOptions asked = options(true);
    asked.snapshots.rounds = true;
    std::vector<Solution> shown;
    Progress silent;
    const StopRequest stop;
    const Result<Solution> s =
        solve_scene(room(), asked, silent, stop, nullptr, [&](Solution snapshot) { shown.push_back(snapshot); });
    ASSERT_TRUE(s);
    ASSERT_EQ(shown.size(), 3u);
    const std::vector<ProbePoint> points = points_uniform_in_area(s->scene, 300, 4);
    double before = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        EXPECT_EQ(layers_of(shown[i]).sources.size(), i + 1);
        EXPECT_FALSE(shown[i].statistics.converged);
        EXPECT_FALSE(make_requested_mesh(shown[i])) << "the scene has all sources";
        double sum = 0;
        for (const Spectrum& light : light_at(shown[i], points)) sum += mean(light);
        EXPECT_GT(sum, before);
        before = sum;
    }
    EXPECT_EQ(light_at(shown.back(), points), light_at(*s, points));
}

}  // namespace exitance
