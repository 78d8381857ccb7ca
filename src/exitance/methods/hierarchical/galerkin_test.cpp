#include <gtest/gtest.h>

#include <map>

#include "exitance/mesh/element_locator.hpp"
#include "support/built_scene.hpp"
#include "support/solved.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

SolveOptions galerkin(BasisKind basis) {
    SolveOptions options;
    options.method = Method::matrix;
    options.basis = basis;
    options.smoothing = false;  // compare the light of the method's elements, unsmoothed
    options.residual = 1e-8;
    return options;
}

/// RMS difference of two functions' band means over the leaves of the first, at nine points per leaf.
double difference(const ElementFunction& f, const Solution& g) {
    double sum = 0, area = 0;
    const ElementLocator locator(g.indirect.tree, g.scene.regions().size());
    for (ElementId e : f.tree.leaves())
        for (int i = 0; i < 9; ++i) {
            const Vec2 uv{(i % 3 + 0.5) / 3, (i / 3 + 0.5) / 3};
            const Point x = f.tree.patch(e).at(uv);
            const double d = mean(f.at({e, uv})) - mean(g.indirect.at(locator.find(f.tree.region(e), x)));
            sum += f.tree.area(e) * d * d, area += f.tree.area(e);
        }
    return std::sqrt(sum / area);
}

/// Area (m^2) and mean indirect light (W/m^2) of every region.
std::map<RegionId, std::pair<double, double>> face_means(const Solution& solution) {
    const ElementTree& tree = solution.indirect.tree;
    std::map<RegionId, std::pair<double, double>> out;
    for (ElementId e : tree.leaves()) {
        auto& [area, light] = out[tree.region(e)];
        area += tree.area(e), light += tree.area(e) * mean(solution.indirect.at({e, tree.centre(e)}));
    }
    for (auto& [region, face] : out) face.second /= face.first;
    return out;
}

/// Two plates of 1 m x 1 m that face each other, 1 m apart. One of them emits: light is smooth everywhere.
Scene glowing_plates() {
    return test::make(
        {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1.0}, {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}});
}

}  // namespace

TEST(Galerkin, ConvergesWithTheOrderOfItsElements) {
    const Scene plates = glowing_plates();
    SolveOptions fine = galerkin(BasisKind::galerkin2);
    fine.mesh_size = 1.0 / 15.5;
    const Solution reference = solved(plates, fine);
    std::array<double, 2> coarse{};
    for (int order : {1, 2}) {
        std::array<double, 2> error{};
        for (int level : {0, 1}) {
            SolveOptions options = galerkin(order == 1 ? BasisKind::galerkin1 : BasisKind::galerkin2);
            options.mesh_size = level == 0 ? 0.51 : 0.26;
            options.epsilon = 1e-5;
            error[static_cast<std::size_t>(level)] = difference(solved(plates, options).indirect, reference);
        }
        coarse[static_cast<std::size_t>(order - 1)] = error[0];
        EXPECT_NEAR(std::log2(error[0] / error[1]), order, 0.25) << error[0] << " " << error[1];
    }
    EXPECT_LT(coarse[1], 0.2 * coarse[0]);
}

TEST(Galerkin, SolvesAFurnace) {
    const double rho = 0.8;
    const Scene furnace = box_scene(1, 2, 3, rho, 1, 1);
    for (const BasisKind basis : {BasisKind::galerkin1, BasisKind::galerkin2, BasisKind::galerkin3}) {
        SolveOptions options = galerkin(basis);
        options.mesh_size = 1.0;
        options.epsilon = 1e-4;
        const Solution solution = solved(furnace, options);
        double largest = 0;
        for (ElementId e : solution.indirect.tree.leaves())
            largest = std::max(largest, std::abs(solution.indirect.at({e, {0.3, 0.4}})[0] - rho / (1 - rho)));
        // Errors of quadrature rules, as small as the tolerance, are multiplied by five through reflections.
        EXPECT_LT(largest / 4, 1e-3) << name_in(basis_names, basis);
        EXPECT_EQ(solution.statistics.basis, name_in(basis_names, basis));
    }
}

TEST(Galerkin, OrderOneAgreesWithConstantRowsOfRays) {
    const Scene scene = built_scene("cornell");
    SolveOptions options = galerkin(BasisKind::galerkin1);
    options.mesh_size = 0.25;
    const Solution blocks = solved(scene, options);
    options.basis = BasisKind::constant;
    const Solution rays = solved(scene, options);
    double difference = 0, light = 0;
    const auto means_by_rays = face_means(rays);
    for (const auto& [region, of_blocks] : face_means(blocks)) {
        const auto& [area, of_rays] = means_by_rays.at(region);
        difference += area * std::pow(of_blocks.second - of_rays, 2), light += area * of_rays * of_rays;
    }
    // Constant elements of 0.25 m are off by about 0.5% in corners, and noise of rays adds as much to a face's mean.
    EXPECT_LT(std::sqrt(difference / light), 0.015);
}

TEST(Galerkin, MeetsTheRequestedError) {
    for (const BasisKind basis : {BasisKind::galerkin1, BasisKind::galerkin2}) {
        SolveOptions options;
        options.method = Method::matrix;
        options.basis = basis;
        options.error = 0.05;
        const Solution solution = solved(built_scene("cornell"), options);
        EXPECT_TRUE(solution.statistics.converged);
        EXPECT_LT(solution.statistics.relative_error_estimate, 0.05);
    }
}

}  // namespace exitance
