#include "exitance/lab/layers/source_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A floor, a board above it, and a row of lamps of different exitances over that. As the lamps are in a row, some
/// edges of their shadows are collinear.
Scene lamps(std::size_t count) {
    const auto square = [](double x, double y, double half, double z, bool up) {
        std::vector<Point> out{
            {x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}};
        if (!up) std::swap(out[1], out[3]);
        return out;
    };
    std::vector<test::Face> faces{{square(0, 0, 2, 0, true)}, {square(0, 0, 0.4, 0.7, true)}};
    for (std::size_t i = 0; i < count; ++i)
        faces.push_back(
            {square(-0.8 + 1.6 * static_cast<double>(i), 0, 0.3, 2, false), 100.0 + 50 * static_cast<double>(i)});
    return test::make(faces);
}

struct Layered {
    Scene scene;
    Stage stage;
    StopRequest stop;
    LayersReport report;
    LightLayers layers;

    Layered(Scene s, double error) : scene(std::move(s)), stage(scene) {
        layers = make_light_layers(stage, {.error = error, .largest_error = 2 * error}, report, stop);
    }
};

TEST(SourceLayers, AddUpToTheLightOfAllSources) {
    for (const double error : {0.02, 0.001}) {  // layers of half floats, and of floats
        const Layered l(lamps(2), error);
        ASSERT_EQ(l.layers.sources.size(), 2u);
        EXPECT_NE(l.layers.sources[0], l.layers.sources[1]);
        EXPECT_LE(l.report.error, error);
        const auto form = error > 0.01 ? LightLayer::Form::halves : LightLayer::Form::floats;
        for (const auto& sheet : l.layers.sheets) EXPECT_EQ(sheet.light.contents().form, form);
        RandomStream random(1, Stream::mesh);
        DirectLight::Workspace workspace;
        double square = 0, light = 0, largest = 0, brightest = 0;
        constexpr int places = 4000;
        for (int i = 0; i < places; ++i) {
            const Point p{-2 + 4 * random.uniform(), -2 + 4 * random.uniform(), 0};
            const double exact = mean(l.stage.direct.irradiance(p, {0, 0, 1}, RegionId(0), workspace));
            const double off = std::abs(mean(light_at(l.layers, l.scene, RegionId(0), p)) - exact);
            square += off * off, light += exact;
            largest = std::max(largest, off), brightest = std::max(brightest, exact);
        }
        EXPECT_LE(std::sqrt(square / places) / (light / places), error);
        EXPECT_LE(largest / brightest, 2 * error);
    }
}

TEST(SourceLayers, EachHasTheLightOfOneSource) {
    const Layered both(lamps(2), 0.01);
    Layered first(lamps(2), 0.01);
    first.stage.direct.keep_only(std::array<std::uint32_t, 1>{0}, false);
    LightLayers alone = both.layers;
    std::erase_if(alone.sheets, [](const auto& sheet) { return sheet.source != 0; });
    DirectLight::Workspace workspace;
    for (const double x : {-1.5, -0.9, 0.3, 0.6, 1.2}) {
        const Point p{x, 0.1, 0};
        const double exact = mean(first.stage.direct.irradiance(p, {0, 0, 1}, RegionId(0), workspace));
        EXPECT_NEAR(mean(light_at(alone, both.scene, RegionId(0), p)), exact, 0.5);  // values are about 20
    }
}

TEST(SourceLayers, AreSelectedByTheNumberOrNameOfTheirSources) {
    const Layered l(lamps(2), 0.02);
    const auto named = [&](const char* word) { return named_sources(l.layers, l.scene, word); };
    const std::vector<std::uint32_t> first{0}, second{1}, both{0, 1}, none;
    EXPECT_EQ(named("1"), first);
    EXPECT_EQ(named("2"), second);
    EXPECT_EQ(named("all"), both) << "the group of all surfaces";
    for (const char* word : {"3", "0", "-1", "others", "lamp", ""}) EXPECT_EQ(named(word), none) << word;
    for (const double x : {-1.5, 0.3, 1.2}) {
        const Point p{x, 0.1, 0};
        const auto light = [&](const std::vector<std::uint32_t>& among) {
            return light_at(l.layers, l.scene, RegionId(0), p, among);
        };
        EXPECT_EQ(light(both), light_at(l.layers, l.scene, RegionId(0), p));
        EXPECT_NEAR(mean(light(first) + light(second)), mean(light(both)), 1e-12 * mean(light(both)));
    }
}

TEST(SourceLayers, OmitDarkTrianglesAndTakeLessThanHalfOfWingedEdges) {
    const Layered l(lamps(2), 0.01);
    EXPECT_LT(l.layers.size(), l.report.triangles);
    EXPECT_GT(l.layers.size(), 0u);
    EXPECT_LT(2 * l.layers.memory_bytes(), l.report.winged_edge_bytes);
    for (const auto& sheet : l.layers.sheets) EXPECT_EQ(l.scene.regions()[sheet.region].plane.n.z, 1);
}

TEST(SourceLayers, SourcesBeyondTheBrightest64ShareALayer) {
    const Layered l(lamps(70), 0.05);
    EXPECT_EQ(l.layers.sources.size(), 65u);
    EXPECT_TRUE(l.layers.sources.back().is_none());
    EXPECT_LE(l.report.error, 0.05);
}

TEST(SourceLayers, AreBitwiseIndependentOfThreads) {
    const auto bytes = [](int threads_used) {
        set_threads(threads_used);
        const Layered l(lamps(2), 0.02);
        std::vector<std::uint16_t> out;
        for (const auto& sheet : l.layers.sheets)
            for (const auto& v : sheet.light.contents().half_vertices) out.insert(out.end(), {v.u, v.v, v.value});
        return out;
    };
    const auto one = bytes(1), three = bytes(3);
    set_threads(0);
    EXPECT_FALSE(one.empty());
    EXPECT_EQ(one, three);
}

TEST(SourceLayers, AreEmptyAfterARequestToStop) {
    const Scene scene = lamps(2);
    const Stage stage(scene);
    StopRequest stop;
    stop.set_deadline(StopRequest::Clock::now());
    LayersReport report;
    EXPECT_TRUE(make_light_layers(stage, {.error = 0.02}, report, stop).empty());
    EXPECT_TRUE(report.interrupted);
}

}  // namespace
}  // namespace exitance
