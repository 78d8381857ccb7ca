#include "exitance/methods/light/secondary_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/base/random.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/solution/continuous.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A floor, a wall that emits light, and boards in front of it.
Scene wall_before_boards() {
    return test::make({{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}},
                       {{{-0.4, 2, 0.5}, {0.4, 2, 0.5}, {0.4, 2, 2}, {-0.4, 2, 2}}, 1},
                       {{{-0.5, 0, 0.7}, {0.5, 0, 0.7}, {0.5, 1, 0.7}, {-0.5, 1, 0.7}}},
                       {{{0.1, 0.2, 0.2}, {0.6, 1.3, 0.3}, {0.2, 1.2, 1.5}}}});
}

/// Zero light on the pieces of a scene.
ElementFunction dark_pieces(const Stage& stage) {
    ElementFunction out;
    for (const Piece& piece : stage.pieces) out.tree.add_root(piece.region, piece.patch);
    out.first_value.resize(out.tree.size());
    for (const ElementId e : out.tree.leaves()) {
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int k = 0; k < out.tree.patch(e).corner_count(); ++k) out.add_value({});
    }
    return out;
}

TEST(SecondaryLight, HidesTheSameLightOfUniformPartsAsOfAnEmitter) {
    const Scene scene = wall_before_boards();
    const Stage stage(scene);
    const ElementFunction dark = dark_pieces(stage);
    SecondarySource source{RegionId(1), {}};
    const double u[] = {-0.4, -0.31, 0.05, 0.4}, v[] = {0.5, 0.6, 1.4, 2};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            source.parts.push_back(
                {{{u[i], 2, v[k]}, {u[i + 1], 2, v[k]}, {u[i + 1], 2, v[k + 1]}, {u[i], 2, v[k + 1]}},
                 Spectrum(1.0),
                 (u[i + 1] - u[i]) * (v[k + 1] - v[k])});
    const ElementLocator locator(dark.tree, scene.regions().size());
    const StopRequest stop;
    const SecondaryLight light(stage, dark, locator, {source}, stop);
    SecondaryLight::Workspace scratch;
    DirectLight::Workspace workspace;
    RandomStream random(3, Stream::mesh);
    double hidden = 0;
    for (int i = 0; i < 2000; ++i) {
        const double a = random.uniform(), b = random.uniform();
        const Point x{4 * a - 2, 4 * b - 2, 0};
        const double seen = mean(stage.direct.irradiance(x, {0, 0, 1}, RegionId(0), workspace)),
                     all = point_to_polygon(x, {0, 0, 1}, scene.regions()[RegionId(1)].loops.front());
        ASSERT_NEAR(mean(light.hidden(RegionId(0), x, scratch)), all - seen, 2e-12) << x.x << " " << x.y;  // rounding
        hidden += all - seen;
    }
    EXPECT_GT(hidden, 1);
}

TEST(SecondarySources, AreDividedWhereLightVariesAndSortedByPower) {
    // A lamp close to the centre of one wall, another far from a second wall.
    const Scene scene = test::make({{{{-1, 0, 0}, {1, 0, 0}, {1, 0, 2}, {-1, 0, 2}}},
                                    {{{5, 0, 0}, {5.5, 0, 0}, {5.5, 0, 0.5}, {5, 0, 0.5}}},
                                    {{{-0.1, -0.2, 1.1}, {0.1, -0.2, 1.1}, {0.1, -0.2, 0.9}, {-0.1, -0.2, 0.9}}, 100},
                                    {{{5, -3, 0}, {5, -3, 0.5}, {5.5, -3, 0.5}, {5.5, -3, 0}}, 10}});
    const Stage stage(scene);
    ASSERT_GT(scene.regions()[RegionId(2)].plane.n.y, 0.9);
    ASSERT_LT(scene.regions()[RegionId(0)].plane.n.y, -0.9);
    Solution solution{.scene = scene};
    solution.indirect = dark_pieces(stage);
    const ElementLocator locator(solution.indirect.tree, scene.regions().size());
    const StopRequest stop;
    const auto all = secondary_sources(stage, solution, locator, {.count = 10}, stop);
    ASSERT_EQ(all.size(), 2u);  // the lamps face away from each other
    EXPECT_EQ(all[0].region, RegionId(0));
    EXPECT_EQ(all[1].parts.size(), 1u);
    EXPECT_GT(all[0].parts.size(), 8u);
    EXPECT_LE(all[0].parts.size(), 66u);
    for (const SecondarySource& source : all) {
        double area = 0;
        for (const SecondarySource::Part& part : source.parts) {
            EXPECT_NEAR(norm(area_vector(part.outline)), part.area, 1e-12);
            area += part.area;
        }
        EXPECT_NEAR(area, scene.regions()[source.region].area, 1e-12);
    }
    // The smallest part is where light varies most.
    const auto smallest = std::min_element(all[0].parts.begin(), all[0].parts.end(),
                                           [](const auto& a, const auto& b) { return a.area < b.area; });
    EXPECT_LT(norm(centroid(smallest->outline) - Point{0, 0, 1}), 0.6);
    EXPECT_EQ(secondary_sources(stage, solution, locator, {.count = 1}, stop).size(), 1u);
}

TEST(SecondaryLight, ReplacesTheShadowsOfElements) {
    const Scene scene = wall_before_boards();
    const Stage stage(scene);
    ElementFunction held = dark_pieces(stage);
    const ElementLocator pieces(held.tree, scene.regions().size());
    const SecondarySource source{RegionId(1), {{scene.regions()[RegionId(1)].loops.front(), Spectrum(1.0), 1.2}}};
    const StopRequest stop;
    SecondaryLight::Workspace scratch;
    const SecondaryLight alone(stage, held, pieces, {source}, stop);
    // Elements with uniform light minus the wall's shadows, fitted by the rule of the local pass.
    const Spectrum even(0.5);
    for (const ElementId e : held.tree.leaves()) {
        const std::vector<WeightedPlace> rule = element_rule(held.tree, e, RuleOrder::fine);
        std::vector<Spectrum> values;
        for (const WeightedPlace& place : rule)
            values.push_back(even - alone.hidden(held.tree.region(e), held.tree.patch(e).at(place.uv), scratch));
        const ElementFit fit(held.tree, e, rule, values);
        for (int k = 0; k < held.tree.patch(e).corner_count(); ++k)
            for (std::size_t b = 0; b < bands; ++b)
                held.values[held.first_value[e] + static_cast<std::uint32_t>(k)][b] =
                    static_cast<float>(fit.corner(k)[b]);
    }
    held = nearest_continuous(held, scene, stage.contacts);
    const ElementLocator locator(held.tree, scene.regions().size());
    const SecondaryLight light(stage, held, locator, {source}, stop);
    RandomStream random(4, Stream::mesh);
    double before = 0;
    for (int i = 0; i < 500; ++i) {
        const double a = random.uniform(), b = random.uniform();
        const Point x{4 * a - 2, 4 * b - 2, 0};
        const double truth = mean(even - light.hidden(RegionId(0), x, scratch));
        before = std::max(before, std::abs(mean(held.at(locator.find(RegionId(0), x))) - truth));
        EXPECT_NEAR(mean(light.at(RegionId(0), x)), truth, 1e-6);  // floats
    }
    EXPECT_GT(before, 0.01);  // a floor of one element has no shadows
    // After a stop, light is unchanged.
    StopRequest now;
    now.interrupt();
    const SecondaryLight stopped(stage, held, locator, {source}, now);
    EXPECT_EQ(stopped.at(RegionId(0), {1, 1, 0}), held.at(locator.find(RegionId(0), {1, 1, 0})));
}

}  // namespace
}  // namespace exitance
