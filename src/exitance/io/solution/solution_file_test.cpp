#include "exitance/io/solution/solution_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "exitance/base/parallel.hpp"
#include "exitance/io/solution/checkpoint_file.hpp"
#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "support/built_scene.hpp"
#include "support/places.hpp"
#include "support/sample_solution.hpp"
#include "support/solved.hpp"
#include "support/temporary_folder.hpp"

/// HDF5 1.10 leaks memory when it finds damaged metadata; the leak sanitizer ignores its leaks.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libhdf5";
}

namespace exitance {
namespace {

namespace fs = std::filesystem;

class SolutionFiles : public testing::Test {
  protected:
    std::string path(const std::string& name) const { return folder / name; }
    std::string bytes(const std::string& name) const {
        std::ifstream in(folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void put(const std::string& name, const std::string& content) const {
        std::ofstream(folder / name, std::ios::binary) << content;
    }
    TemporaryFolder folder;
};

void expect_same(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.file(), b.file());
    ASSERT_EQ(a.surfaces().size(), b.surfaces().size());
    for (SurfaceId s : a.surfaces().ids()) {
        const Surface &x = a.surfaces()[s], &y = b.surfaces()[s];
        EXPECT_TRUE(std::ranges::equal(a.outline(s), b.outline(s)));
        EXPECT_TRUE(x.material == y.material && x.group == y.group && x.region == y.region && x.line == y.line);
        EXPECT_TRUE(x.normal == y.normal && x.area == y.area && x.first_corner == y.first_corner);
    }
    ASSERT_EQ(a.materials().size(), b.materials().size());
    for (MaterialId m : a.materials().ids()) {
        EXPECT_EQ(a.materials()[m].name, b.materials()[m].name);
        EXPECT_EQ(a.materials()[m].reflectance, b.materials()[m].reflectance);
        EXPECT_EQ(a.materials()[m].exitance, b.materials()[m].exitance);
    }
    EXPECT_TRUE(std::ranges::equal(a.groups(), b.groups()));
    ASSERT_EQ(a.regions().size(), b.regions().size());
    for (RegionId r : a.regions().ids()) {
        const Region &x = a.regions()[r], &y = b.regions()[r];
        EXPECT_TRUE(x.material == y.material && x.plane.n == y.plane.n && x.plane.offset == y.plane.offset);
        EXPECT_TRUE(x.area == y.area && x.surfaces == y.surfaces && x.loops == y.loops);
    }
    EXPECT_EQ(a.emitters(), b.emitters());
    ASSERT_EQ(a.lights().size(), b.lights().size());
    for (std::size_t i = 0; i < a.lights().size(); ++i) {
        const PunctualLight &x = a.lights()[i], &y = b.lights()[i];
        EXPECT_TRUE(x.name == y.name && x.kind == y.kind && x.position == y.position && x.direction == y.direction);
        EXPECT_TRUE(x.intensity == y.intensity && x.inner_cone == y.inner_cone && x.outer_cone == y.outer_cone);
    }
    ASSERT_EQ(a.cameras().size(), b.cameras().size());
    for (std::size_t i = 0; i < a.cameras().size(); ++i) {
        const SceneCamera &x = a.cameras()[i], &y = b.cameras()[i];
        EXPECT_TRUE(x.name == y.name && x.eye == y.eye && x.target == y.target && x.up == y.up);
        EXPECT_TRUE(x.fov == y.fov && x.width == y.width);
    }
    EXPECT_TRUE(a.box().lo == b.box().lo && a.box().hi == b.box().hi);
}

void expect_same(const ElementFunction& a, const ElementFunction& b) {
    ASSERT_EQ(a.tree.size(), b.tree.size());
    EXPECT_EQ(a.tree.roots(), b.tree.roots());
    for (ElementId e : a.tree.ids()) {
        const Patch &p = a.tree.patch(e), &q = b.tree.patch(e);
        ASSERT_TRUE(p.origin == q.origin && p.a == q.a && p.b == q.b && p.shape == q.shape);
        ASSERT_EQ(a.tree.parent(e), b.tree.parent(e));
        ASSERT_EQ(a.tree.region(e), b.tree.region(e));
        ASSERT_EQ(a.tree.cut_of(e), b.tree.cut_of(e));
        ASSERT_EQ(a.tree.children(e).size(), b.tree.children(e).size());
        ASSERT_EQ(a.tree.domain(e), b.tree.domain(e));
        ASSERT_EQ(a.tree.area(e), b.tree.area(e));
        if (a.tree.is_leaf(e)) {
            const ElementTree::Place place = {e, {0.3, 0.4}};
            ASSERT_EQ(a.at(place), b.at(place));
        } else {
            ASSERT_EQ(a.tree.ratio(e), b.tree.ratio(e));
            if (a.tree.cut_of(e) == Cut::line) {
                ASSERT_TRUE(a.tree.line(e).normal == b.tree.line(e).normal &&
                            a.tree.line(e).offset == b.tree.line(e).offset);
            }
            ASSERT_EQ(a.tree.children(e).front(), b.tree.children(e).front());
        }
    }
}

TEST_F(SolutionFiles, RestoreASolutionBitForBit) {
    const Solution s = sample_solution();
    const Result<void> written = write_solution(path("s.h5"), s);
    ASSERT_TRUE(written) << written.error().message;
    const Result<Solution> t = load_solution(path("s.h5"));
    ASSERT_TRUE(t) << t.error().message;
    expect_same(s.scene, t->scene);
    expect_same(s.indirect, t->indirect);
    EXPECT_EQ(s.direct_share, t->direct_share);
    expect_same(s.interpolant, t->interpolant);
    EXPECT_EQ(s.options, t->options);
    EXPECT_EQ(s.bounces, t->bounces);
    EXPECT_EQ(s.direct_in_elements, t->direct_in_elements);
    EXPECT_EQ(s.statistics.method, t->statistics.method);
    EXPECT_EQ(s.statistics.links, t->statistics.links);
    EXPECT_EQ(s.statistics.converged, t->statistics.converged);
    EXPECT_EQ(s.statistics.seconds, t->statistics.seconds);
    EXPECT_EQ(s.statistics.warnings, t->statistics.warnings);
    EXPECT_EQ(s.statistics.relative_error_estimate_interpolant, t->statistics.relative_error_estimate_interpolant);
    EXPECT_EQ(s.statistics.energy.defect, t->statistics.energy.defect);
}

TEST_F(SolutionFiles, OfOlderFormatsAreRead) {
    for (const std::string format : {"1", "2"}) {
        const Result<Solution> old = load_solution(test::data_folder() + "/solutions/format_" + format + ".h5");
        ASSERT_TRUE(old) << old.error().message;
        ASSERT_EQ(old->scene.surfaces().size(), 14u);  // two boxes, a floor and a lamp
        EXPECT_EQ(old->discontinuity.empty(), format == "1");
        EXPECT_GT(old->statistics.relative_error_estimate.value_or(0), 0);
        // The values that HDF5's own tools show in the files.
        const Point corner = old->scene.outline(SurfaceId(1))[1], loop = old->scene.regions()[RegionId(0)].loops[0][3];
        EXPECT_LT(norm(corner - Point{0.73677476, 0.80926041, 0.3}), 1e-7);
        EXPECT_LT(norm(loop - Point{-2.5, 2.5, 0}), 1e-12);
        double mean_value = 0;
        for (const auto& value : old->indirect.values)
            mean_value += value[0] / static_cast<double>(old->indirect.values.size());
        EXPECT_NEAR(mean_value, format == "1" ? 0.04112564 : 0.04079096, 1e-7);
        ASSERT_TRUE(write_solution(path("new.h5"), *old));
        const Result<Solution> renewed = load_solution(path("new.h5"));
        ASSERT_TRUE(renewed) << renewed.error().message;
        expect_same(old->scene, renewed->scene);
        expect_same(old->indirect, renewed->indirect);
        expect_same(old->interpolant, renewed->interpolant);
    }
}

TEST_F(SolutionFiles, HoldEveryVertexOnce) {
    const Solution s = sample_solution();
    ASSERT_TRUE(write_solution(path("s.h5"), s));
    Result<Hdf5Reader> file = Hdf5Reader::open(path("s.h5"));
    ASSERT_TRUE(file) << file.error().message;
    const auto vertices = file->read<double>("exitance/scene/vertex", 3);
    const auto corners = file->read<std::uint32_t>("exitance/scene/corner_vertex");
    ASSERT_FALSE(file->failed()) << file->error().message;
    std::set<std::array<double, 3>> different;
    for (std::size_t i = 0; i < vertices.size(); i += 3)
        different.insert({vertices[i], vertices[i + 1], vertices[i + 2]});
    EXPECT_EQ(3 * different.size(), vertices.size());
    EXPECT_LT(different.size(), corners.size());
}

TEST_F(SolutionFiles, NameTheUnitsOfEnergyAndLight) {
    for (const bool photometric : {false, true}) {
        const Solution s = sample_solution(40, photometric);
        ASSERT_TRUE(write_solution(path("s.h5"), s));
        const Result<Solution> t = load_solution(path("s.h5"));
        ASSERT_TRUE(t) << t.error().message;
        EXPECT_EQ(t->statistics.energy.emitted, s.statistics.energy.emitted);
        Result<Hdf5Reader> file = Hdf5Reader::open(path("s.h5"));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->text_attribute("exitance/statistics", "energy_unit"), photometric ? "lm" : "W");
        EXPECT_EQ(file->text_attribute("VTKHDF/PointData/radiosity", "units"), photometric ? "lm/m^2" : "W/m^2");
    }
}

TEST_F(SolutionFiles, CanLeaveOutTheGroupForOtherPrograms) {
    const Solution s = sample_solution();
    ASSERT_TRUE(write_solution(path("whole.h5"), s));
    ASSERT_TRUE(write_solution(path("small.h5"), s, nullptr, VtkGroup::left_out));
    Result<Hdf5Reader> file = Hdf5Reader::open(path("small.h5"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_FALSE(file->has("VTKHDF"));
    const Result<Solution> whole = load_solution(path("whole.h5")), small = load_solution(path("small.h5"));
    ASSERT_TRUE(whole && small);
    expect_same(whole->interpolant, small->interpolant);
    expect_same(whole->scene, small->scene);
}

TEST_F(SolutionFiles, HoldEqualRootsOfTwoFunctionsOnce) {
    Solution shared = sample_solution();
    shared.interpolant = shared.indirect;
    ASSERT_TRUE(write_solution(path("shared.h5"), shared));
    Solution apart = shared;
    ElementTree moved;
    for (const ElementId e : shared.indirect.tree.roots()) {
        Patch patch = shared.indirect.tree.patch(e);
        patch.a *= 0.5;
        moved.add_root(shared.indirect.tree.region(e), patch);
    }
    apart.interpolant.tree = moved;
    apart.interpolant.first_value = {}, apart.interpolant.values = {};
    apart.interpolant.first_value.resize(moved.size());
    for (const ElementId e : moved.ids()) {
        apart.interpolant.first_value[e] = static_cast<std::uint32_t>(apart.interpolant.values.size());
        for (int k = 0; k < moved.patch(e).corner_count(); ++k) apart.interpolant.add_value(Spectrum(1.0));
    }
    ASSERT_TRUE(write_solution(path("apart.h5"), apart));
    for (const auto& [name, solution] : {std::pair("shared.h5", &shared), std::pair("apart.h5", &apart)}) {
        const Result<Solution> read = load_solution(path(name));
        ASSERT_TRUE(read) << read.error().message;
        expect_same(read->interpolant, solution->interpolant);
    }
}

TEST_F(SolutionFiles, WithoutEnergyUnitHoldTheSumOfAllBands) {
    Hdf5Writer out(path("old.h5"));
    out.make_group("statistics");
    out.set_attribute("statistics", "energy_emitted", 9.0 * bands);
    out.set_attribute("statistics", "energy_defect", 0.25);
    ASSERT_TRUE(out.commit());
    Result<Hdf5Reader> in = Hdf5Reader::open(path("old.h5"));
    ASSERT_TRUE(in) << in.error().message;
    const SolveStatistics statistics = read_statistics(*in, "statistics");
    EXPECT_DOUBLE_EQ(statistics.energy.emitted, 9);
    EXPECT_EQ(statistics.energy.defect, 0.25);
}

TEST_F(SolutionFiles, HoldADiscontinuityMeshAndRejectAnInvalidOne) {
    Solution s = sample_solution();
    SixNodeMesh& mesh = s.discontinuity;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};
    mesh.values.resize(6);
    for (std::size_t i = 0; i < 6; ++i) mesh.values[i].fill(static_cast<float>(i) / 3);
    mesh.nodes = {{0, 1, 2, 3, 4, 5}};
    mesh.region = {RegionId(0)};
    mesh.edge_order = {{CurveOrder::border, CurveOrder::d2, CurveOrder::none}};
    mesh.shadow = {ShadowClass::umbra};
    mesh.curves = {{RegionId(0), {0, 0, 0}, {1, 0.5, 0}, CurveOrder::d2, CurveCause::edge_vertex, RegionId(1)}};
    s.statistics.discontinuity = DiscontinuityCounts{.d2 = 1, .wedges = 7, .triangles = 1, .mean_radius_ratio = 0.4};
    ASSERT_TRUE(write_solution(path("s.h5"), s));
    const Result<Solution> t = load_solution(path("s.h5"));
    ASSERT_TRUE(t) << t.error().message;
    const SixNodeMesh& held = t->discontinuity;
    EXPECT_TRUE(held.points == mesh.points && held.values == mesh.values && held.nodes == mesh.nodes);
    EXPECT_TRUE(held.region == mesh.region && held.edge_order == mesh.edge_order && held.shadow == mesh.shadow);
    ASSERT_EQ(held.curves.size(), 1u);
    EXPECT_EQ(held.curves[0].b, mesh.curves[0].b);
    EXPECT_EQ(held.curves[0].cause, CurveCause::edge_vertex);
    ASSERT_TRUE(t->statistics.discontinuity);
    EXPECT_EQ(t->statistics.discontinuity->wedges, 7u);
    EXPECT_EQ(t->statistics.discontinuity->mean_radius_ratio, 0.4);
    EXPECT_FALSE(held.is_clough_tocher());
    mesh.values[3][0] = std::nanf("");
    ASSERT_TRUE(write_solution(path("bad.h5"), s));
    EXPECT_FALSE(load_solution(path("bad.h5")));
    mesh.values[3][0] = 1;
    mesh.gradients.resize(2), mesh.slopes.resize(1), mesh.gradient_of = {{0, 1, 1}};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t b = 0; b < bands; ++b)
            mesh.gradients[1][axis][b] = static_cast<float>(10 * axis + b),
            mesh.slopes[0][axis][b] = static_cast<float>(b);
    ASSERT_TRUE(write_solution(path("smooth.h5"), s));
    const Result<Solution> smooth = load_solution(path("smooth.h5"));
    ASSERT_TRUE(smooth) << smooth.error().message;
    EXPECT_TRUE(smooth->discontinuity.gradients == mesh.gradients && smooth->discontinuity.slopes == mesh.slopes);
    EXPECT_EQ(smooth->discontinuity.gradient_of, mesh.gradient_of);
    // The invalid mesh must not be evaluated, so its group is written alone.
    mesh.gradient_of[0][2] = 2;
    Hdf5Writer out(path("bad.h5"));
    write_discontinuity(out, "mesh", mesh);
    ASSERT_TRUE(out.commit());
    Result<Hdf5Reader> in = Hdf5Reader::open(path("bad.h5"));
    ASSERT_TRUE(in) << in.error().message;
    read_discontinuity(*in, "mesh", 2);
    ASSERT_TRUE(in->failed());
    EXPECT_TRUE(in->error().message.ends_with("leads to a gradient that does not exist")) << in->error().message;
}

TEST_F(SolutionFiles, DoNotHoldElementsThatFollowFromTheDiscontinuityMesh) {
    for (const MeshElement element : {MeshElement::quadratic, MeshElement::clough_tocher}) {
        SolveOptions options{.method = Method::discontinuity, .error = 0.1};
        options.discontinuity.element = element;
        Solution s = solved(built_scene("cornell"), options);
        ASSERT_FALSE(s.discontinuity.empty());
        ASSERT_TRUE(write_solution(path("s.h5"), s));
        Result<Hdf5Reader> file = Hdf5Reader::open(path("s.h5"));
        ASSERT_TRUE(file);
        EXPECT_FALSE(file->has("exitance/interpolant"));
        const Result<Solution> t = load_solution(path("s.h5"));
        ASSERT_TRUE(t) << t.error().message;
        expect_same(s.interpolant, t->interpolant);
        // Elements of another origin are stored.
        s.interpolant.values[0][0] *= 2;
        ASSERT_TRUE(write_solution(path("other.h5"), s));
        const Result<Solution> other = load_solution(path("other.h5"));
        ASSERT_TRUE(other) << other.error().message;
        expect_same(s.interpolant, other->interpolant);
    }
}

/// A lamp below a pane of two faces that transmits half of what leaves it.
Scene scene_with_pane(double through) {
    SceneDescription d;
    d.file = "pane.obj";
    d.materials = {{"lamp", Spectrum(0.5), Spectrum(1)}, {"pane", Spectrum(0.7), Spectrum(0), {}, through}};
    d.groups = {"all"};
    const auto face = [&](const std::vector<Point>& corners, std::uint32_t material) {
        add_polygon(d, corners).material = material;
    };
    face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 0);
    face({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, 1);
    face({{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, 1);
    return std::move(*make_scene(std::move(d)).scene);
}

TEST(StoredSceneInMemory, KeepsDiffusingPanesAndTheirOtherSides) {
    const Scene scene = scene_with_pane(0.5);
    ASSERT_TRUE(scene.has_diffusing_panes());
    const Result<Scene> back = StoredScene::from_bytes(StoredScene::bytes_of(scene));
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->has_diffusing_panes());
    for (const MaterialId m : scene.materials().ids())
        EXPECT_EQ(back->materials()[m].through, scene.materials()[m].through);
    for (const RegionId r : scene.regions().ids()) EXPECT_EQ(back->regions()[r].behind, scene.regions()[r].behind);
}

TEST(StoredScene, KeepsTheWholesOfParts) {
    SceneDescription d;
    d.file = "parts.obj";
    d.materials = {{"lamp", Spectrum(0.5), Spectrum(1)}};
    d.groups = {"all"};
    d.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    for (const std::uint32_t whole : {0u, 7u}) {
        d.faces = {{{0, 1, 2, 3}, 0, 0, 3, whole}, {{1, 4, 5, 2}, 0, 0, 3, whole}};
        const CheckedScene made = make_scene(d);
        ASSERT_TRUE(made.scene);
        const TemporaryFolder folder;
        {
            Hdf5Writer file(folder / "scene.h5");
            StoredScene::write(file, "scene", *made.scene);
            ASSERT_TRUE(file.commit());
        }
        Result<Hdf5Reader> file = Hdf5Reader::open(folder / "scene.h5");
        ASSERT_TRUE(file);
        EXPECT_EQ(file->has("scene/face_whole"), whole > 0);
        const Scene back = StoredScene::read(*file, "scene");
        ASSERT_FALSE(file->failed());
        for (const Surface& s : back.surfaces()) EXPECT_EQ(s.whole, whole);
        const Result<Scene> sent = StoredScene::from_bytes(StoredScene::bytes_of(*made.scene));
        ASSERT_TRUE(sent);
        for (const Surface& s : sent->surfaces()) EXPECT_EQ(s.whole, whole);
    }
}

TEST(StoredSceneInMemory, FingerprintsDependOnWhatPanesTransmit) {
    EXPECT_EQ(scene_fingerprint(scene_with_pane(0.5)), scene_fingerprint(scene_with_pane(0.5)));
    EXPECT_NE(scene_fingerprint(scene_with_pane(0.5)), scene_fingerprint(scene_with_pane(0.4)));
}

TEST_F(SolutionFiles, OfEqualSolutionsAreEqual) {
    ASSERT_TRUE(write_solution(path("a.h5"), sample_solution()));
    set_threads(1);
    ASSERT_TRUE(write_solution(path("b.h5"), sample_solution()));
    set_threads(0);
    const Result<Solution> loaded = load_solution(path("a.h5"));
    ASSERT_TRUE(loaded);
    ASSERT_TRUE(write_solution(path("c.h5"), *loaded));
    EXPECT_EQ(bytes("a.h5"), bytes("b.h5"));
    EXPECT_EQ(bytes("a.h5"), bytes("c.h5"));
}

TEST_F(SolutionFiles, HoldEmptyTextsAndNoWarnings) {
    Solution s = sample_solution();
    s.options.clear(), s.statistics.warnings.clear(), s.statistics.seconds = {}, s.statistics.method.clear();
    ASSERT_TRUE(write_solution(path("s.h5"), s));
    const Result<Solution> t = load_solution(path("s.h5"));
    ASSERT_TRUE(t) << t.error().message;
    EXPECT_TRUE(t->options.empty() && t->statistics.warnings.empty() && t->statistics.method.empty());
}

TEST_F(SolutionFiles, HoldManyElements) {
    const Solution s = sample_solution(4000);
    ASSERT_TRUE(write_solution(path("s.h5"), s));
    const Result<Solution> t = load_solution(path("s.h5"));
    ASSERT_TRUE(t) << t.error().message;
    expect_same(s.interpolant, t->interpolant);
}

TEST_F(SolutionFiles, OfOtherKindsAreErrors) {
    EXPECT_EQ(load_solution(path("none.h5")).error().code, ErrorCode::cannot_read);
    EXPECT_EQ(load_solution(fs::path(folder / "").parent_path().string()).error().code, ErrorCode::cannot_read);
    put("empty.h5", "");
    put("text.h5", "v 0 0 0\n");
    for (const char* name : {"empty.h5", "text.h5"}) {
        const Result<Solution> s = load_solution(path(name));
        ASSERT_FALSE(s);
        EXPECT_EQ(s.error().code, ErrorCode::bad_input);
        EXPECT_NE(s.error().where.find(name), std::string::npos);
    }
}

TEST_F(SolutionFiles, TruncatedAnywhereAreErrors) {
    ASSERT_TRUE(write_solution(path("s.h5"), sample_solution()));
    const std::string whole = bytes("s.h5");
    for (int i = 0; i < 60; ++i) {
        put("cut.h5", whole.substr(0, whole.size() * std::size_t(i) / 60));
        EXPECT_FALSE(load_solution(path("cut.h5"))) << i;
    }
}

TEST_F(SolutionFiles, WithFlippedBitsNeverCrash) {
    ASSERT_TRUE(write_solution(path("s.h5"), sample_solution()));
    const std::string whole = bytes("s.h5");
    RandomStream random(3, Stream::mesh);
    int noticed = 0;
    for (int i = 0; i < 400; ++i) {
        std::string flipped = whole;
        const std::size_t at = i < 100 ? std::size_t(i) : random.bits() % whole.size();
        flipped[at] = static_cast<char>(flipped[at] ^ (1 << random.bits() % 8));
        put("flipped.h5", flipped);
        noticed += load_solution(path("flipped.h5")) ? 0 : 1;
    }
    // Most of a small file is padding between blocks; data and metadata have checksums.
    EXPECT_GT(noticed, 100);
}

TEST_F(SolutionFiles, ReportWhyTheyCannotBeWritten) {
    const Result<void> written = write_solution(path("no/s.h5"), sample_solution());
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::cannot_write);
}

}  // namespace
}  // namespace exitance
