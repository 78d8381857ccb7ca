#include "exitance/methods/plan/delivery_forecast.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/methods/plan/attempt_forecast.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

// Measured by `solve --threads 1 --verbose` on tubes, boxes and prisms at 2 to 0.1% (bench/results/empty_rooms.csv).
constexpr double terms_a_ray = 10;           ///< Elements summed in the time of one gather ray, at 25 ns each.
constexpr double terms_beside_pieces = 300;  ///< Number of elements per place into which nearby pieces are split.
constexpr double light_rays = 64;            ///< Cost of direct light per element, in rays.
constexpr double late_light_rays = 12;       ///< Rays per element of the method's mesh, for late light.
constexpr double pair_form_factors = 100;  ///< Form factors per pair of pieces; each pair needs a search for occluders.
/// Form factors of links per element of the method's mesh, times 1 - mean reflectance.
constexpr double element_form_factors = 24;
constexpr std::size_t way_pilot_points = 256;
constexpr unsigned way_pilot_rays = 64;
/// Minimum number of rays of a solve that begins with a pilot. A pilot casts two rays per point and direction, which is
/// then at most 3% of the solve.
constexpr double min_rays_for_pilot = 64 * way_pilot_points * way_pilot_rays;

/// Numbers of elements and rays of a first attempt.
struct Counts {
    double elements = 0, row_rays = 0;
    double gathered = 0;  ///< Elements of the initial gather mesh.
    double light() const { return light_rays * elements; }
};

Counts count_elements(const Stage& stage, const Knobs& knobs) {
    const ElementTree solved = stage.make_elements(knobs.solve_mesh);
    const std::vector<ElementId> leaves = solved.leaves();
    Counts out{.elements = static_cast<double>(leaves.size()),
               .gathered = static_cast<double>(stage.make_elements(knobs.gather_mesh).leaves().size())};
    for (const ElementId e : leaves) out.row_rays += knobs.solve_rays.rays(solved.area(e), stage.area / out.elements);
    return out;
}

double gather_by_rays(const Counts& counts, const Knobs& knobs) {
    constexpr double straight_places = 9, curved_places = 16;
    return counts.gathered * (knobs.gather_curved ? curved_places : straight_places) * knobs.gather_rays.average;
}

/// Returns the work of sums, in rays. Each place visits all pieces twice, for a first estimate of its light and for the
/// sum.
double gather_by_sums(const Stage& stage, const Counts& counts, const Knobs& knobs) {
    constexpr double places = 9;
    const double terms = 2 * static_cast<double>(stage.pieces.size()) + terms_beside_pieces;
    return (knobs.corrects_sums ? 2 : 1) * counts.gathered * places * terms / terms_a_ray;
}

/// Returns the work of links, in rays. Every reflection repeats the error of a link, so that the number of links grows
/// with the number of reflections. Source: link_rounds.
double links_work(const Stage& stage, const Counts& counts) {
    const double reflections = stage.expected_reflections();
    const double pairs = static_cast<double>(stage.pieces.size()) * static_cast<double>(stage.pieces.size());
    return counts.light() + calibrated::link_form_factor_rays *
                                (pair_form_factors * pairs + element_form_factors * reflections * counts.elements);
}

/// Returns the standard deviation of a gather with 64 rays of the first reflection of direct light, relative to its
/// mean. It measures how uneven the light is, as seen from the surfaces.
double pilot_spread(const Stage& stage, const SolveOptions& options) {
    const Knobs coarse = knobs_for_error(calibrated::hurried_error, stage.lit_spaces(), options);
    const StopRequest never;
    const DirectProjection direct =
        project_direct_light(stage, {.mesh = coarse.solve_mesh, .tolerance = coarse.direct_tolerance}, never);
    const std::vector<ProbePoint> points = points_uniform_in_area(stage.scene, way_pilot_points, options.seed);
    const Locator locator(stage.scene);
    const ElementLocator elements(direct.tree, stage.scene.regions().size());
    const auto reflectance = [&](RegionId r) { return stage.scene.material(r).reflectance; };
    const auto reflected = [&](RegionId r, const Point& p) { return reflectance(r) * direct.at(elements.find(r, p)); };
    struct Sum {
        double variance = 0, light = 0;
        Sum& operator+=(const Sum& o) {
            variance += o.variance, light += o.light;
            return *this;
        }
    };
    const Sum sum = parallel_sum<Sum>(points.size(), [&](std::size_t i) {
        const SurfaceId face = locator.find(points[i].x, points[i].n);
        if (face.is_none()) return Sum();
        const RegionId region = stage.scene.surfaces()[face].region;
        GatherWorkspace workspace;
        const Gathered g =
            gather_reflected(stage, points[i].x, points[i].n, region, way_pilot_rays, i, reflected, workspace);
        const Spectrum rho = reflectance(region);
        return Sum{mean(rho * rho * g.quarters), mean(rho * g.irradiance)};
    });
    return sum.light > 0 ? std::sqrt(sum.variance * static_cast<double>(points.size())) / sum.light : 0;
}

/// Returns the number of rays of further attempts; 0 if the method's error is within its share of the target, one half.
/// The error is predicted for constant elements, whose matrix rows of 64 rays have independent errors.
double further_attempts(double spread, double error, const Counts& counts, double gather) {
    namespace c = calibrated;
    const double method = spread / std::sqrt(counts.elements);
    if (method <= ErrorBudget::method_share * error) return 0;
    const double wanted = ErrorBudget::method_share * ErrorBudget(error).next_attempt();
    const double finer = std::clamp(c::part_aim * wanted / method, c::min_attempt_factor, c::max_method_factor);
    return forecast_attempt({.row_rays = counts.row_rays,
                             .gather_rays = gather,
                             .certificate_rays = late_light_rays * counts.elements,
                             .method = method,
                             .wanted = wanted,
                             .left = 1,
                             .finer = finer})
        .finer_rays;
}

}  // namespace

DeliveryForecast forecast_delivery(const Stage& stage, const SolveOptions& options, bool may_deliver) {
    DeliveryForecast out;
    if (!ElementGather::suits(stage)) return out;
    const double error = options.error_target();
    const LitSpaces lit = stage.lit_spaces();
    const Knobs knobs = knobs_for_error(error, lit, options), for_sums = knobs_for_sums(knobs, error, lit, options);
    const Counts by_rays = count_elements(stage, knobs), by_sums = count_elements(stage, for_sums);
    const double gather = gather_by_sums(stage, by_sums, for_sums);
    out.rays = by_rays.light() + by_rays.row_rays + gather_by_rays(by_rays, knobs);
    out.sums = by_sums.light() + by_sums.row_rays + gather;
    if (!may_deliver || std::min(out.rays, out.sums) < min_rays_for_pilot) return out;
    out.links = links_work(stage, by_sums);
    // Added only for sums: with rays, noise hides the error of constant elements, and refinement steps reduce it.
    out.sums += further_attempts(pilot_spread(stage, options), error, by_sums, gather);
    return out;
}

std::string describe(const DeliveryForecast& forecast) {
    const std::string matrix =
        fmt::format("work of about {:.2g} rays by sums over elements, {:.2g} by rays", forecast.sums, forecast.rays);
    return std::isfinite(forecast.links) ? fmt::format("{}, {:.2g} by links", matrix, forecast.links) : matrix;
}

}  // namespace exitance
