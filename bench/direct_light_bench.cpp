#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "exitance/base/random.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/direct/direct_light.hpp"
#include "exitance/samples/generate.hpp"
#include "exitance/visibility/rays.hpp"

// Exact direct light and packets of rays in rooms full of chairs: time per point (or ray) at three sizes. For direct
// light also the largest difference between its two algorithms, subtraction and edge sums.
namespace {

using namespace exitance;

struct Place {
    Point x;
    Normal n;
    RegionId region;
};

struct Setting {
    Scene scene;
    Occluders occluders{scene};
    DirectLight direct{scene, occluders};
    RayTracer tracer{scene};
    std::vector<Place> places;

    explicit Setting(Scene made) : scene(std::move(made)) {
        RandomStream random(1, Stream::mesh);
        const std::size_t each = 4000 / scene.surfaces().size() + 1;
        for (SurfaceId s : scene.surfaces().ids())
            for (const auto& t : triangulate(scene.outline(s), scene.surfaces()[s].normal))
                for (std::size_t i = 0; i < each; ++i) {
                    const auto o = scene.outline(s);
                    const double u = std::sqrt(random.uniform()), v = random.uniform();
                    places.push_back({o[t[0]] + u * (1 - v) * (o[t[1]] - o[t[0]]) + u * v * (o[t[2]] - o[t[0]]),
                                      scene.surfaces()[s].normal, scene.surfaces()[s].region});
                }
    }
};

Setting complex_scene(std::int64_t chairs) {
    Result<SceneDescription> description = generate_scene("complex", {{"m", std::to_string(chairs)}});
    return Setting(std::move(*make_scene(std::move(*description)).scene));
}

void direct_light_at_points(benchmark::State& state) {
    const Setting setting = complex_scene(state.range(0));
    VisibilityWorkspace scratch;
    std::size_t i = 0;
    for (auto _ : state) {
        const Place& place = setting.places[i++ % setting.places.size()];
        benchmark::DoNotOptimize(setting.direct.irradiance(place.x, place.n, place.region, scratch));
    }
    double difference = 0;
    const PieceId source = setting.direct.emitters()[0].pieces.front();
    for (const Place& place : setting.places) {
        const SurfacePoint at{place.x, place.n, place.region};
        const auto by = [&](VisiblePartMethod method) {
            return visible_form_factor(setting.occluders, at, source, scratch, method);
        };
        difference =
            std::max(difference, std::abs(by(VisiblePartMethod::subtraction) - by(VisiblePartMethod::edge_sums)));
    }
    state.counters["difference"] = difference;
    state.counters["surfaces"] = static_cast<double>(setting.scene.surfaces().size());
}
BENCHMARK(direct_light_at_points)->Arg(1)->Arg(6)->Arg(36);

void nearest_of_64_rays_a_point(benchmark::State& state) {
    const Setting setting = complex_scene(state.range(0));
    RandomStream random(2, Stream::rows);
    std::vector<Vec3> directions(64);
    std::vector<RayHit> hits(directions.size());
    std::size_t i = 0, rays = 0;
    for (auto _ : state) {
        const Place& place = setting.places[i++ % setting.places.size()];
        const Frame frame(place.n);
        for (Vec3& d : directions) d = frame.to_world(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform());
        rays += setting.tracer.nearest(directions, place.x, place.region, hits);
        benchmark::DoNotOptimize(hits.data());
    }
    state.counters["rays"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
}
BENCHMARK(nearest_of_64_rays_a_point)->Arg(1)->Arg(6)->Arg(36);

}  // namespace
