#include "exitance/methods/plan/delivery_forecast.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/methods/plan/plan.hpp"
#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

/// A white room, 2.5 m high, with a regular polygon as floor and a luminous ceiling.
Scene round_room(int corners) {
    SceneDescription d;
    d.file = "round.obj";
    const auto corner = [&](int k, double z) {
        const double angle = 2 * pi * k / corners;
        return Point{2 * std::cos(angle), 2 * std::sin(angle), z};
    };
    for (int k = 0; k < corners; ++k) d.points.insert(d.points.end(), {corner(k, 0), corner(k, 2.5)});
    d.materials = {{"wall", Spectrum(0.75), Spectrum()}, {"ceiling", Spectrum(0.75), Spectrum(1.0)}};
    d.groups = {"room"};
    std::vector<std::uint32_t> floor, ceiling;
    for (int k = 0; k < corners; ++k) {
        const auto here = static_cast<std::uint32_t>(2 * k), next = static_cast<std::uint32_t>(2 * ((k + 1) % corners));
        floor.push_back(here), ceiling.insert(ceiling.begin(), here + 1);
        d.faces.push_back({{here, here + 1, next + 1, next}, 0u, 0, k + 1});
    }
    d.faces.push_back({floor, 0u, 0, corners + 1}), d.faces.push_back({ceiling, 1u, 0, corners + 2});
    return checked_scene(std::move(d));
}

Plan plan_at(const Scene& scene, double error) {
    return make_plan(Stage(scene), {.error = error});
}

// The expected choices were measured by solving with each way (`solve --threads 1`, user time). The constants of the
// forecast were derived from other scenes.

TEST(DeliveryForecast, SumsInAnEmptyRoomOfManySides) {
    const Scene room = round_room(40);  // 116 pieces
    EXPECT_TRUE(plan_at(room, 0.02).sums);
    EXPECT_TRUE(plan_at(room, 0.005).sums);
}

TEST(DeliveryForecast, UsesLinksIfConstantElementsNeedSeveralAttempts) {
    const Scene shaft = box_scene(1, 1, 10, 0.8, 10);
    EXPECT_EQ(plan_at(shaft, 0.02).options.method, Method::matrix);
    const Plan fine = plan_at(shaft, 0.002);
    EXPECT_EQ(fine.options.method, Method::wavelet);
    EXPECT_TRUE(fine.knobs.links_deliver);
}

TEST(DeliveryForecast, SumsInALowRoomWithUniformLight) {
    const Scene low = box_scene(12, 9, 1.5, 0.8, 10);
    EXPECT_EQ(plan_at(low, 0.002).options.method, Method::matrix);
    EXPECT_TRUE(plan_at(low, 0.002).sums);
}

TEST(DeliveryForecast, PrefersSumsToLinksForManyPolygons) {
    const Scene room = round_room(100);
    const Stage stage(room);
    const DeliveryForecast forecast = forecast_delivery(stage, {.error = 0.005}, true);
    ASSERT_TRUE(std::isfinite(forecast.links));
    EXPECT_LT(2 * forecast.sums, forecast.links);
}

TEST(DeliveryForecast, EvaluatesNothingWithOcclusion) {
    const Scene room = built_scene("cornell");
    const DeliveryForecast forecast = forecast_delivery(Stage(room), {.error = 0.001}, true);
    EXPECT_FALSE(forecast.takes_sums() || forecast.takes_links());
}

TEST(DeliveryForecast, DeliversRequestedLinksIfTheyAreCheaperThanSums) {
    const Scene shaft = box_scene(1, 1, 10, 0.8, 10);
    const Stage stage(shaft);
    const auto delivers = [&](double error) {
        return make_plan(stage, {.method = Method::wavelet, .error = error}).knobs.links_deliver;
    };
    EXPECT_FALSE(delivers(0.02));
    EXPECT_TRUE(delivers(0.002));
}

TEST(DeliveryForecast, IsTheSameOnAnyNumberOfThreads) {
    const Scene shaft = box_scene(1, 1, 10, 0.8, 10);
    const Stage stage(shaft);
    const auto on = [&](int count) {
        set_threads(count);
        return forecast_delivery(stage, {.error = 0.002}, true);
    };
    const DeliveryForecast one = on(1), three = on(3);
    set_threads(0);
    EXPECT_EQ(one.sums, three.sums);
    EXPECT_EQ(one.rays, three.rays);
    EXPECT_EQ(one.links, three.links);
}

}  // namespace
}  // namespace exitance
