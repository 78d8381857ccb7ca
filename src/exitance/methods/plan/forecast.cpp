#include "exitance/methods/plan/forecast.hpp"

#include "exitance/accuracy/accuracy.hpp"
#include "exitance/core/memory.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/core/progress.hpp"
#include "exitance/reconstruct/error/area_samples.hpp"
#include "exitance/reconstruct/gather.hpp"

namespace exitance {
namespace {

// Measured on rooms of 17 to 650 polygons at 1% to 5%: how much the light adds to what the first mesh suggests.
constexpr double gathers_an_element = 75;  ///< Places, the noise's second round, cuts, and the certificate.
constexpr double lights_an_element = 20;   ///< Nodes of the projection and of the exported mesh, and cuts.
constexpr double bytes_an_element = 1500;

/// Leaves of a mesh; counted where that is quick.
std::size_t count_elements(const Stage& stage, MeshSize size) {
    const std::size_t predicted = predict_elements(stage.pieces, size.edge);
    constexpr std::size_t quick = 100'000;
    constexpr std::size_t strips = 2;  // about what grading towards edges adds
    return predicted > quick ? strips * predicted : stage.make_elements(size).leaves().size();
}

/// Wall seconds of one call, all threads at work.
template <class Work>
double seconds_each(std::size_t count, const Work& work) {
    const Stopwatch watch;
    parallel_ranges(count, 8, work);
    return watch.seconds() / static_cast<double>(count);
}

}  // namespace

Forecast forecast_solve(const Scene& scene, const SolveOptions& options) {
    constexpr std::size_t samples = 512;
    constexpr unsigned rays = 64;
    const Stage stage(scene);
    const Knobs knobs = knobs_for_error(options.error_target(), stage.pieces, options);

    Forecast out{.surfaces = scene.surfaces().size(),
                 .regions = scene.regions().size(),
                 .emitters = scene.emitters().size() + scene.lights().size()};
    out.solve_elements = count_elements(stage, knobs.solve_mesh);
    out.gather_elements = count_elements(stage, knobs.gather_mesh);

    const std::vector<ProbePoint> points = points_uniform_in_area(scene, samples, options.seed);
    const Locator locator(scene);
    const auto region_of = [&](const ProbePoint& p) {
        const SurfaceId s = locator.find(p.x, p.n);
        return s.is_none() ? RegionId() : scene.surfaces()[s].region;
    };
    const double gather = seconds_each(samples, [&](std::size_t first, std::size_t last) {
        GatherWorkspace workspace;
        for (std::size_t i = first; i < last; ++i)
            gather_reflected(
                stage, points[i].x, points[i].n, region_of(points[i]), rays, i,
                [](RegionId, const Point&) { return Spectrum(1); }, workspace);
    });
    const double light = seconds_each(samples, [&](std::size_t first, std::size_t last) {
        ClusteredLight::Workspace workspace;
        for (std::size_t i = first; i < last; ++i)
            stage.clustered.at(points[i].x, points[i].n, region_of(points[i]), {.relative = options.error_target()},
                               workspace);
    });

    const bool indirect = options.bounces != 0 && stage.has_indirect_light();
    const double solve_rays = static_cast<double>(out.solve_elements) * knobs.solve_rays.average;
    const double gather_rays =
        static_cast<double>(out.gather_elements) * gathers_an_element * knobs.gather_rays.average;
    out.rays = indirect ? solve_rays + gather_rays : 0;
    out.seconds = out.rays * gather / rays + static_cast<double>(out.solve_elements) * lights_an_element * light;
    out.memory_bytes = static_cast<double>(peak_memory_bytes()) + 4 * solve_rays +
                       bytes_an_element * static_cast<double>(out.solve_elements + out.gather_elements);
    return out;
}

}  // namespace exitance
