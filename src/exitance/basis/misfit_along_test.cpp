#include "exitance/basis/misfit_along.hpp"

#include <gtest/gtest.h>

#include "exitance/basis/element_fit.hpp"

namespace exitance {
namespace {

/// Fits a linear or bilinear polynomial to f on one element; returns the two directional parts of its misfit and the
/// whole mean square misfit.
template <class Function>
std::array<double, 3> along_and_all(Patch::Shape shape, const Function& f) {
    ElementTree tree;
    const ElementId e = tree.add_root(RegionId(0), {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, shape});
    const std::vector<WeightedPlace> places = element_rule(tree, e, RuleOrder::fine);
    std::vector<Spectrum> rest;
    for (const WeightedPlace& p : places) rest.emplace_back(f(p.uv));
    const ElementFit fit(tree, e, places, rest);
    double square = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        rest[i] -= fit.at(places[i].uv);
        square += places[i].weight * rest[i][0] * rest[i][0];
    }
    const auto [u, v] = misfit_along(tree, e, places, rest, Degree::straight);
    return {u, v, square};
}

TEST(MisfitAlong, IsTheWholeMisfitIfLightVariesAlongOneDirection) {
    const auto step = [](double x) { return x < 0.4 ? 1.0 : 0.0; };
    for (const auto shadow : {0, 1}) {
        const auto [u, v, all] =
            along_and_all(Patch::Shape::parallelogram, [&](Vec2 p) { return step(shadow == 0 ? p.x : p.y); });
        EXPECT_GT(all, 1e-3);
        EXPECT_NEAR(shadow == 0 ? u : v, all, 1e-12);
        EXPECT_NEAR(shadow == 0 ? v : u, 0, 1e-12);
    }
}

TEST(MisfitAlong, IsSmallInEachDirectionForADiagonalShadow) {
    const auto [u, v, all] =
        along_and_all(Patch::Shape::parallelogram, [](Vec2 p) { return p.x + p.y < 0.9 ? 1.0 : 0.0; });
    EXPECT_LT(u, 0.7 * all);
    EXPECT_LT(v, 0.7 * all);
}

TEST(MisfitAlong, IsZeroOnTriangles) {
    const auto [u, v, all] = along_and_all(Patch::Shape::triangle, [](Vec2 p) { return p.x * p.x; });
    EXPECT_GT(all, 1e-6);
    EXPECT_EQ(u + v, 0);
}

}  // namespace
}  // namespace exitance
