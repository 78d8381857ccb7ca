#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/pair_form_factor.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/form_factors/point_to_polygon_batch.hpp"

// Form factors without blockers: time per entry, and the largest relative error against the scalar contour sum.
namespace {

using namespace exitance;

struct Sources {
    QuadBatch batch;
    std::vector<std::array<Point, 4>> quads;
};

/// Unit squares that face the origin, `distance` away, all above its horizon.
Sources make_sources(std::size_t count, double distance) {
    RandomStream random(1, Stream::mesh);
    Sources sources;
    while (sources.quads.size() < count) {
        const Normal towards = normalized({random.uniform() - 0.5, random.uniform() - 0.5, 0.3 + random.uniform()});
        const Frame frame(
            normalized(-1.0 * towards + 0.3 * Vec3{random.uniform(), random.uniform(), random.uniform()}));
        const Point o = distance * towards;
        if (o.z < 1) continue;
        sources.quads.push_back({o - 0.5 * frame.u - 0.5 * frame.v, o + 0.5 * frame.u - 0.5 * frame.v,
                                 o + 0.5 * frame.u + 0.5 * frame.v, o - 0.5 * frame.u + 0.5 * frame.v});
        sources.batch.add(sources.quads.back());
    }
    return sources;
}

void points_to_quads(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const Sources sources = make_sources(count, static_cast<double>(state.range(1)));
    std::vector<double> F(count);
    for (auto _ : state) {
        point_to_quads({0, 0, 0}, {0, 0, 1}, sources.batch, F);
        benchmark::DoNotOptimize(F.data());
    }
    double error = 0;
    for (std::size_t k = 0; k < count; ++k)
        error = std::max(error, std::abs(F[k] / point_to_polygon({0, 0, 0}, {0, 0, 1}, sources.quads[k]) - 1));
    state.counters["error"] = error;
    state.counters["per_quad"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(count),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(points_to_quads)->ArgsProduct({{16, 256, 4096}, {2, 20, 100, 1000}})->ArgNames({"quads", "distance"});

void point_to_quad_scalar(benchmark::State& state) {
    const Sources sources = make_sources(256, static_cast<double>(state.range(0)));
    std::size_t k = 0;
    for (auto _ : state) benchmark::DoNotOptimize(point_to_polygon({0, 0, 0}, {0, 0, 1}, sources.quads[k++ % 256]));
}
BENCHMARK(point_to_quad_scalar)->Arg(2)->Arg(20)->Arg(100)->ArgName("distance");

/// Perpendicular unit squares that share an edge, the most difficult simple pair.
void pair_with_a_shared_edge(benchmark::State& state) {
    const std::vector<Point> floor = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<Point> wall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
    const double tolerance = std::pow(10.0, -static_cast<double>(state.range(0)));
    double F = 0;
    for (auto _ : state) benchmark::DoNotOptimize(F = pair_form_factor(floor, wall, tolerance));
    state.counters["error"] = std::abs(F / 0.2000437760754032 - 1);
}
BENCHMARK(pair_with_a_shared_edge)->Arg(4)->Arg(8)->Arg(12)->ArgName("digits");

}  // namespace
