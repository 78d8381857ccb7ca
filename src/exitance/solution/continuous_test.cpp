#include "exitance/solution/continuous.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "exitance/base/random.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {
namespace {

Scene square() {
    SceneDescription d;
    d.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    return std::move(*make_scene(std::move(d)).scene);
}

/// A square that is split `depth` times everywhere, and `more` times in some places.
ElementTree cut_square(int depth, int more) {
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram});
    for (int i = 0; i < depth; ++i)
        for (ElementId e : tree.leaves()) refine_element(tree, e);
    RandomStream random(2, Stream::mesh);
    for (int i = 0; i < more; ++i) refine_element(tree, tree.leaves()[random.bits() % tree.leaves().size()]);
    return tree;
}

/// Least-squares fit of g on every leaf, plus `noise` at its corners.
ElementFunction fitted(const ElementTree& tree, const std::function<double(Point)>& g, double noise) {
    ElementFunction out;
    out.tree = tree;
    out.first_value.resize(tree.size());
    RandomStream random(4, Stream::mesh);
    for (ElementId e : tree.leaves()) {
        const std::vector<WeightedPlace> rule = element_rule(tree, e, RuleOrder::fine);
        std::vector<Spectrum> values;
        for (const WeightedPlace& place : rule) values.emplace_back(g(tree.patch(e).at(place.uv)));
        const ElementFit fit(tree, e, rule, values);
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int i = 0; i < tree.patch(e).corner_count(); ++i)
            out.add_value(fit.corner(i) + Spectrum(noise * (2 * random.uniform() - 1)));
    }
    return out;
}

double mean_of(const ElementFunction& f, const std::function<double(Spectrum, Point)>& of) {
    double sum = 0;
    for (ElementId e : f.tree.leaves())
        for (const WeightedPlace& place : element_rule(f.tree, e, RuleOrder::fine))
            sum += f.tree.area(e) * place.weight * of(f.at({e, place.uv}), f.tree.patch(e).at(place.uv));
    return sum;
}

double rms_error(const ElementFunction& f, const std::function<double(Point)>& g) {
    return std::sqrt(mean_of(f, [&](Spectrum s, Point p) { return (s[0] - g(p)) * (s[0] - g(p)); }));
}

double wave(Point p) {
    return 1 + std::sin(3 * p.x) * std::cos(2 * p.y);
}

TEST(Continuous, KeepsLinearFunctionsAndTheFluxOfAllOthers) {
    const Scene scene = square();
    const ContactLines contacts(scene);
    const ElementTree tree = cut_square(2, 20);
    const auto slope = [](Point p) { return 3 - p.x + 2 * p.y; };
    const ElementFunction straight = nearest_continuous(fitted(tree, slope, 0), scene, contacts);
    EXPECT_LT(rms_error(straight, slope), 1e-6);  // values are stored in single precision
    const ElementFunction rough = fitted(tree, wave, 0.3);
    const auto light = [](Spectrum s, Point) { return s[0]; };
    EXPECT_NEAR(mean_of(nearest_continuous(rough, scene, contacts), light), mean_of(rough, light), 1e-6);
}

/// Strips that halve towards an edge have corners on the side of the neighbouring leaf that are too close for
/// triangles. Some nodes then belong to no triangle, which must not stop the solver at its initial values, the mean
/// values around each node: these are no linear function if sizes change.
TEST(Continuous, KeepsALinearFunctionBesideStripsThatHalveTowardsAnEdge) {
    const Scene scene = square();
    ElementTree tree = cut_square(1, 0);
    ElementId strip = tree.leaves().front();
    for (int i = 0; i < 30; ++i) strip = tree.split(strip, Cut::v);
    ASSERT_EQ(tree.patch(strip).origin.y, 0);
    const auto linear = [](Point p) { return 1 + 2 * p.x - 3 * p.y; };
    EXPECT_LT(rms_error(nearest_continuous(fitted(tree, linear, 0), scene, ContactLines(scene)), linear), 1e-5);
}

TEST(Continuous, IsAsCloseToContinuousLightAsItsInput) {
    const Scene scene = square();
    const ContactLines contacts(scene);
    for (const double noise : {0.0, 0.05}) {
        const ElementFunction apart = fitted(cut_square(3, 40), wave, noise);
        const double before = rms_error(apart, wave),
                     after = rms_error(nearest_continuous(apart, scene, contacts), wave);
        // Triangles lack the term uv: where they replace parallelograms, the error is at most half as large again.
        EXPECT_LT(after, (noise > 0 ? 0.8 : 1.5) * before);
    }
}

TEST(Continuous, ConvergesWithTheSquareOfTheSize) {
    const Scene scene = square();
    const ContactLines contacts(scene);
    const auto error = [&](int depth) {
        return rms_error(nearest_continuous(fitted(cut_square(depth, 0), wave, 0), scene, contacts), wave);
    };
    EXPECT_NEAR(std::log2(error(3) / error(4)), 2, 0.1);
}

TEST(Continuous, ReturnsItsInputOnAStopRequest) {
    const Scene scene = square();
    const ElementFunction f = fitted(
        cut_square(2, 9), [](Point p) { return p.x; }, 0.1);
    StopRequest stop;
    stop.interrupt();
    const ElementFunction out = nearest_continuous(f, scene, ContactLines(scene), &stop);
    EXPECT_EQ(out.tree.size(), f.tree.size());
    EXPECT_EQ(out.values, f.values);
}

}  // namespace
}  // namespace exitance
