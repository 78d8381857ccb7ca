// Surfaces that transmit light diffusely.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/sanitizers.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/transport/stage.hpp"
#include "support/checked_scene.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

constexpr double rho = 0.3, tau = 0.4;  // reflectance and transmittance of the pane

/// Two adjoining rooms, 2 x 1 x 1 m and 1 x 1 x 1 m, with a pane between them. Each room has a material for its walls.
struct TwoRooms {
    SceneDescription d;

    TwoRooms(const Material& first, const Material& second, const Material& front, const Material& back) {
        d.file = "rooms.obj";
        d.materials = {first, second, front, back};
        d.groups = {"all"};
        room(-2, 0, 0), room(0, 1, 1);
        face({{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}, 2);
        face({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, 3);
    }
    void room(double a, double b, std::uint32_t material) {
        face({{a, 0, 0}, {b, 0, 0}, {b, 1, 0}, {a, 1, 0}}, material);
        face({{a, 0, 1}, {a, 1, 1}, {b, 1, 1}, {b, 0, 1}}, material);
        face({{a, 0, 0}, {a, 0, 1}, {b, 0, 1}, {b, 0, 0}}, material);
        face({{a, 1, 0}, {b, 1, 0}, {b, 1, 1}, {a, 1, 1}}, material);
        if (a < 0)
            face({{a, 0, 0}, {a, 1, 0}, {a, 1, 1}, {a, 0, 1}}, material);
        else
            face({{b, 0, 0}, {b, 0, 1}, {b, 1, 1}, {b, 1, 0}}, material);
    }
    void face(const std::vector<Point>& corners, std::uint32_t material) {
        add_polygon(d, corners).material = material;
    }
    Scene scene() const { return checked_scene(d); }
};

Material wall(double reflectance, double exitance) {
    return {"wall", Spectrum(reflectance), Spectrum(exitance)};
}

Material pane(double exitance = 0, double through = tau / (rho + tau)) {
    return {"pane", Spectrum(rho + tau), Spectrum(exitance), {}, through};
}

/// A lamp in the first room, none in the second.
Scene lit_and_dark() {
    TwoRooms rooms(wall(0.5, 0), wall(0.6, 0), pane(), pane());
    rooms.d.materials.push_back(wall(0, 10));
    rooms.face({{-1.2, 0.4, 0.9}, {-1.2, 0.7, 0.9}, {-0.8, 0.7, 0.9}, {-0.8, 0.4, 0.9}}, 4);
    return rooms.scene();
}

const std::vector<ProbePoint> places = {{{0.5, 0.5, 0}, {0, 0, 1}}, {{1, 0.3, 0.6}, {-1, 0, 0}},
                                        {{0, 0.4, 0.3}, {1, 0, 0}}, {{0, 0.4, 0.3}, {-1, 0, 0}},
                                        {{-1, 0.5, 0}, {0, 0, 1}},  {{-0.1, 0.2, 0}, {0, 0, 1}}};

}  // namespace

constexpr double first = 5, second = 3;  // uniform radiosities of the two rooms

/// Both rooms have uniform radiosity, B_1 and B_2, whatever their shape: walls emit (1 - rho) B, and the pane emits the
/// difference on either side.
Scene two_uniform_rooms() {
    constexpr double white = 0.5;
    return TwoRooms(wall(white, (1 - white) * first), wall(white, (1 - white) * second),
                    pane(first - rho * first - tau * second), pane(second - rho * second - tau * first))
        .scene();
}

void expect_uniform(const SolveOptions& options, const std::string& name) {
    SCOPED_TRACE(name);
    const Scene scene = two_uniform_rooms();
    EXPECT_TRUE(scene.has_diffusing_panes());
    const Solution solution = solved(scene, options);
    const RadiosityFunction light(solution);
    const std::vector<Light> at = light.at(places);
    for (std::size_t i : {0u, 1u}) EXPECT_NEAR(at[i].radiosity[0], second, 0.01 * second) << i;
    for (std::size_t i : {4u, 5u}) EXPECT_NEAR(at[i].radiosity[0], first, 0.01 * first) << i;
    EXPECT_NEAR(at[2].radiosity[0], second, 0.01 * second);
    EXPECT_NEAR(at[3].radiosity[0], first, 0.01 * first);
    EXPECT_NEAR(at[3].irradiance[0], (rho * first + tau * second) / (rho + tau), 0.01 * first);
    EXPECT_LT(solution.statistics.energy.defect, 2e-3);
}

/// All methods and options that affect transport, with a requested error.
std::vector<std::pair<std::string, SolveOptions>> all_methods(double error) {
    std::vector<std::pair<std::string, SolveOptions>> out;
    const auto add = [&](const std::string& name, SolveOptions o) {
        o.error = error;
        out.emplace_back(name, o);
    };
    add("matrix", {.method = Method::matrix});
    add("analytic", {.method = Method::matrix, .form_factors = FormFactorKind::analytic});
    add("hemicube", {.method = Method::matrix, .form_factors = FormFactorKind::hemicube});
    add("linear", {.method = Method::matrix, .basis = BasisKind::linear});
    add("galerkin2", {.method = Method::matrix, .basis = BasisKind::galerkin2});
    add("progressive", {.method = Method::progressive});
    add("overshooting", {.method = Method::progressive, .overshooting = true});
    add("substructuring", {.method = Method::substructuring});
    add("monte-carlo", {.method = Method::monte_carlo});
    add("hierarchical", {.method = Method::hierarchical});
    add("links", {.method = Method::hierarchical, .basis = BasisKind::haar, .clusters = false});
    add("clusters", {.method = Method::hierarchical, .clusters = true});
    add("wavelet", {.method = Method::wavelet});
    add("multiwavelet3", {.method = Method::wavelet, .basis = BasisKind::multiwavelet3});
    add("flatlet2", {.method = Method::wavelet, .basis = BasisKind::flatlet2});
    add("discontinuity", {.method = Method::discontinuity});
    return out;
}

TEST(DiffusingPanes, TwoUniformRoomsStayUniform) {
    for (const auto& [name, options] : all_methods(0.1)) expect_uniform(options, name);
}

TEST(DiffusingPanes, LightInADarkRoomAgreesWithPathTracing) {
    const Scene scene = lit_and_dark();
    Progress progress;
    const std::vector<ReferenceLight> exact = reference_light(scene, places, 1 << 14, 1, progress, StopRequest());
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_GT(exact[i].irradiance[0], 0.01) << i;
    auto ways = all_methods(0.05);
    if (has_address_sanitizer) ways.resize(1);  // TwoUniformRoomsStayUniform runs all methods
    ways.push_back({"auto", {.error = 0.02}});
    for (auto [name, options] : ways) {
        SCOPED_TRACE(name);
        if (name == "galerkin2") options.error = 0.1;  // a coarse limit, since every leaf is linked to every other
        const Solution solution = solved(scene, options);
        EXPECT_TRUE(name != "auto" || solution.statistics.method == "matrix");
        const std::vector<Light> at = RadiosityFunction(solution).at(places);
        for (std::size_t i = 0; i < places.size(); ++i)
            EXPECT_NEAR(at[i].irradiance[0], exact[i].irradiance[0],
                        4 * exact[i].standard_error[0] + 0.03 * exact[i].irradiance[0])
                << i;
        EXPECT_LT(solution.statistics.energy.defect, 5e-3);
        EXPECT_LT(*solution.statistics.relative_error_estimate, 0.03);
    }
}

/// Few cells are coarse: all points except those at the pane's border are accurate to a tenth.
TEST(DiffusingPanes, GrowingCellsPassLight) {
    const Scene scene = lit_and_dark();
    Progress progress;
    const std::vector<ReferenceLight> exact = reference_light(scene, places, 1 << 14, 1, progress, StopRequest());
    const Solution solution = solved(scene, {.method = Method::growing_cells, .error = 0.05});
    const std::vector<Light> at = RadiosityFunction(solution).at(places);
    for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_NEAR(at[i].irradiance[0], exact[i].irradiance[0],
                    4 * exact[i].standard_error[0] + 0.1 * exact[i].irradiance[0])
            << i;
}

TEST(DiffusingPanes, DirectLightComesFromBothSides) {
    const Scene scene = lit_and_dark();
    const Stage stage(scene);
    DirectLight::Workspace workspace;
    ReceiverLight light;
    RegionId front, back;
    for (const RegionId r : scene.regions().ids())
        if (scene.material(r).is_diffusing_pane()) (scene.regions()[r].plane.n.x < 0 ? front : back) = r;
    ASSERT_EQ(scene.behind(front), back);
    ASSERT_EQ(scene.behind(back), front);
    const Point x{0, 0.3, 0.2};
    const double met = stage.direct.irradiance(x, {-1, 0, 0}, front, workspace)[0],
                 behind = stage.direct.irradiance(x, {1, 0, 0}, back, workspace)[0];
    EXPECT_GT(met, 0);
    EXPECT_NEAR(behind / met, tau / rho, 1e-9) << "the second room has no light of its own";
    stage.direct.prepare(scene.regions()[back].loops[0], {1, 0, 0}, back, light, workspace);
    EXPECT_FALSE(light.is_dark());
    EXPECT_NEAR(stage.direct.irradiance(light, x, workspace)[0], behind, 1e-9);
}

TEST(DiffusingPanes, AnOpaquePaneIsAWall) {
    const Scene scene = TwoRooms(wall(0.5, 1), wall(0.5, 0), pane(0, 0), pane(0, 0)).scene();
    EXPECT_FALSE(scene.has_diffusing_panes());
    const Solution solution = solved(scene, {.error = 0.05});
    EXPECT_EQ(RadiosityFunction(solution).at(places)[0].irradiance[0], 0);
}

TEST(DiffusingPanes, AFileMayDefineOneSideOnly) {
    TwoRooms rooms(wall(0.5, 1), wall(0.5, 0), pane(), pane());
    const std::size_t faces = rooms.d.faces.size();
    rooms.d.faces.pop_back();
    const Scene scene = rooms.scene();
    EXPECT_EQ(scene.surfaces().size(), faces);
    EXPECT_TRUE(scene.has_diffusing_panes());
}

TEST(DiffusingPanes, OneSidedMethodsRejectThem) {
    const Scene scene = lit_and_dark();
    Progress progress;
    for (const SolveOptions& options :
         std::initializer_list<SolveOptions>{{.method = Method::discontinuity, .local_pass = LocalPassRule::c},
                                             {.method = Method::growing_cells, .gcs = CellsKind::classic},
                                             {.relaxation = Relaxation::cg}}) {
        const Result<Solution> none = solve_scene(scene, options, progress, StopRequest());
        ASSERT_FALSE(none);
        EXPECT_EQ(none.error().code, ErrorCode::usage);
    }
}

}  // namespace exitance
