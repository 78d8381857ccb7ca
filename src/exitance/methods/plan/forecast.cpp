#include "exitance/methods/plan/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/error/certificate.hpp"
#include "exitance/error/residual_samples.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/patch_steps.hpp"
#include "exitance/methods/plan/memory_plan.hpp"
#include "exitance/methods/plan/method_memory.hpp"
#include "exitance/methods/plan/plan.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

// Ratios measured by `solve --dry-run` and `solve` on tube, cornell, complex, office, clutter and chair at
// 3%.
constexpr double gathered_by_solved = 1.2;  ///< Gather elements per leaf of the method's mesh.
constexpr double straight_by_curved = 1.7;  ///< Delivered leaves per element of second degree.
constexpr double element_rays = 2.6;     ///< Rays of an element over those of a place; sums of the rule are less noisy.
constexpr double shooting_share = 0.48;  ///< Share of the pairs of elements whose form factors shooting needs.
constexpr double gathered_by_patches = 3;  ///< Gather elements per patch of substructuring.
constexpr double random_sweeps = 1.9;      ///< Light sent in random directions over the light of the first reflection.
/// Time of a ray between elements, or of a hemicube's ray, relative to a ray of the gather, which also evaluates the
/// light at its hit.
constexpr double published_ray_time = 0.25;
constexpr unsigned shooting_samples = 16;
/// Evaluations of direct light per element: nodes of the projection and of the exported mesh, and splits.
constexpr double lights_an_element = 20;
constexpr unsigned pilot_rays = 64;
constexpr std::size_t pilot_points = 512;

/// Results of a few gathers of the light of the first reflection.
struct Pilot {
    double rays = 0;            ///< Rays per place that reduce the noise to the allowed value.
    double gather_seconds = 0;  ///< Wall time per ray, with all threads busy.
    double light_seconds = 0;   ///< Wall time of direct light per point.
    /// Mean reflected light, W/m^2, extrapolated from the first reflection as a geometric series.
    double mean_light = 0;
    double facing = 0;     ///< Share of the pairs of points that face each other.
    bool blocked = false;  ///< True if something occludes any of these pairs.
};

/// Finds the share of pairs of points that face each other, and whether any of these is occluded.
void look_across(const Stage& stage, std::span<const ProbePoint> points, std::span<const RegionId> region, Pilot& out) {
    constexpr std::size_t partners = 8;
    std::vector<RayEnd> from, to;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 1; k <= partners; ++k) {
            const std::size_t j = (i + k * points.size() / (partners + 1)) % points.size();
            if (region[i].is_none() || region[j].is_none()) continue;
            const Vec3 w = points[j].x - points[i].x;
            if (!(dot(w, points[i].n) > 0 && dot(w, points[j].n) < 0)) continue;
            from.push_back({points[i].x, region[i]}), to.push_back({points[j].x, region[j]});
        }
    const std::unique_ptr<bool[]> blocked(new bool[from.size()]);
    if (!from.empty()) stage.tracer.occluded(from, to, {blocked.get(), from.size()});
    out.facing = static_cast<double>(from.size()) / static_cast<double>(partners * points.size());
    out.blocked = std::any_of(blocked.get(), blocked.get() + from.size(), [](bool b) { return b; });
}

/// Returns the wall time per item, in seconds, with all threads busy.
template <class Work>
double seconds_each(std::size_t count, const Work& work) {
    const Stopwatch watch;
    parallel_ranges(count, 8, work);
    return watch.seconds() / static_cast<double>(count);
}

Pilot run_pilot(const Stage& stage, const Plan& plan, const DirectProjection& direct) {
    const std::vector<ProbePoint> points = points_uniform_in_area(stage.scene, pilot_points, plan.options.seed);
    const Locator locator(stage.scene);
    const ElementLocator elements(direct.tree, stage.scene.regions().size());
    std::vector<RegionId> region(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (const SurfaceId s = locator.find(points[i].x, points[i].n); !s.is_none())
            region[i] = stage.scene.surfaces()[s].region;
    const auto reflectance = [&](RegionId r) { return stage.scene.material(r).reflectance; };
    const auto reflected = [&](RegionId r, const Point& p) { return reflectance(r) * direct.at(elements.find(r, p)); };
    Pilot out;
    std::vector<double> noise(points.size()), light(points.size()), first_light(points.size());
    out.gather_seconds = seconds_each(points.size(),
                                      [&](std::size_t first, std::size_t last) {
                                          GatherWorkspace workspace;
                                          for (std::size_t i = first; i < last; ++i) {
                                              const Gathered g =
                                                  gather_reflected(stage, points[i].x, points[i].n, region[i],
                                                                   pilot_rays, i, reflected, workspace);
                                              if (region[i].is_none()) continue;
                                              const Spectrum rho = reflectance(region[i]);
                                              noise[i] = std::sqrt(mean(rho * rho * g.quarters));
                                              first_light[i] = mean(reflected(region[i], points[i].x));
                                              light[i] = first_light[i] + mean(rho * g.irradiance);
                                          }
                                      }) /
                         pilot_rays;
    out.light_seconds = seconds_each(points.size(), [&](std::size_t first, std::size_t last) {
        PlaceLight::Workspace workspace;
        for (std::size_t i = first; i < last; ++i)
            stage.place_light.at(points[i].x, points[i].n, region[i], {.relative = plan.options.error_target()},
                                 workspace);
    });
    look_across(stage, points, region, out);
    double mean_light = 0;
    for (const double l : light) mean_light += l / static_cast<double>(points.size());
    double mean_first = 0;
    for (const double l : first_light) mean_first += l / static_cast<double>(points.size());
    // Geometric series; its sum is at most twenty times the first term.
    if (mean_first > 0) out.mean_light = mean_first / std::max(0.05, 1 - (mean_light - mean_first) / mean_first);
    const Knobs& k = plan.knobs;
    for (const double n : noise) {
        // The error of scrambled points falls like n^-3/4. Four degrees of freedom are fitted to nine places.
        const double wanted =
            mean_light > 0 ? pilot_rays * std::pow(2.0 / 3 * n / (k.gather_noise * mean_light), 4.0 / 3) : 0;
        out.rays += std::clamp(wanted, static_cast<double>(k.gather_rays.min), static_cast<double>(k.gather_rays.max)) /
                    static_cast<double>(points.size());
    }
    return out;
}

/// Direct light on a mesh that is as fine as a forecast can afford, and the number of leaves of the mesh of the solve.
struct ForecastMesh {
    DirectProjection light;
    double own_leaves = 0;  ///< Leaves of `light`.
    double leaves = 0;      ///< Leaves of the mesh of the solve.
    /// True if the first projection reached its limit on elements, so that `leaves` is too small.
    bool is_limited = false;
    double finer() const { return leaves / own_leaves; }
};

/// Returns the number of leaves that a projection of direct light computes in about a second on one processor. The
/// number is estimated from the numbers of emitters and faces instead of measured, so that all runs agree.
double leaves_a_second(const Stage& stage) {
    // Leaves per second with one emitter and few faces; the number of faces that doubles the time of a leaf; the time
    // of a leaf with many emitters, relative to one with a single emitter. Measured by `exitance solve --error 0.002
    // --dry-run --threads 1`: 62,000 leaves of `cornell` with 17 faces took a second, 26,000 of `complex` with 545,
    // 5,000 of `clutter` with 3,012, and 6,000 to 12,000 of `office` with 647 faces and 14 emitters.
    constexpr double leaves_of_one = 1e5, faces_that_double = 200, time_of_many = 2;
    // The projection evaluates up to this number of emitters exactly, and more emitters by a few rays.
    constexpr std::size_t max_exact_emitters = 8;
    const std::size_t count = stage.direct.emitters().size();
    const double emitters =
        count <= max_exact_emitters ? static_cast<double>(std::max<std::size_t>(1, count)) : time_of_many;
    const auto faces = static_cast<double>(stage.scene.surfaces().size());
    return leaves_of_one / (emitters * (1 + faces / faces_that_double));
}

/// Projects direct light for decreasing errors down to that of the solve. If the next projection would take too long or
/// too much memory, the number of leaves is extrapolated. A projection splits the pieces into at most `max_more` more
/// elements. If the first one needs more, its number of leaves is a lower limit.
ForecastMesh forecast_mesh(const Stage& stage, const Plan& plan, bool patches, std::size_t max_more) {
    constexpr double step = 4;  // factor between the errors of two projections
    const std::size_t max_elements = stage.pieces.size() + max_more;
    // Factor on the number of leaves of divided pieces, from one projection to the next. Measured by `solve --dry-run`
    // without extrapolation: 2.4 to 3 in an office from 2% to 0.2%, 3.4 to 3.8 in `cornell` from 2% to 0.01%.
    constexpr double min_growth = 2.5, max_growth = step;
    const double error = plan.options.error_target();
    const StopRequest never;
    double coarser = 1;
    while (step * coarser * error <= recognizable_error) coarser *= step;
    const auto project = [&](double coarser) {
        const Knobs knobs = coarser > 1 ? first_knobs(plan, stage, coarser * error) : plan.knobs;
        MeshSize mesh = knobs.solve_mesh;
        mesh.edge = std::max(mesh.edge, plan.knobs.solve_mesh.edge);
        mesh.grading_levels = std::min(mesh.grading_levels, plan.knobs.solve_mesh.grading_levels);
        if (patches && !plan.options.mesh_size)
            mesh = {calibrated::patch_edge * mesh.edge, std::max(0, mesh.grading_levels - 1)};
        return project_direct_light(stage,
                                    {.mesh = mesh,
                                     .tolerance = (patches ? 2 : 1) * knobs.direct_tolerance,
                                     .min_area = plan.options.min_area,
                                     .max_elements = max_elements},
                                    never);
    };
    ForecastMesh out;
    const double affordable = std::min(static_cast<double>(max_more), leaves_a_second(stage));
    double growth = min_growth, whole = 0;  // `whole`: undivided pieces of the last projection
    for (; coarser >= 1; coarser /= step) {
        const bool is_first = out.leaves == 0;
        std::optional<DirectProjection> light;
        if (is_first || whole + growth * (out.leaves - whole) <= affordable) light = project(coarser);
        const bool is_cut_short = light && light->tree.size() >= max_elements;
        if (!light || (is_cut_short && !is_first)) {
            for (; coarser >= 1; coarser /= step) out.leaves = whole + growth * (out.leaves - whole);
            break;
        }
        out.is_limited |= is_cut_short;
        out.light = std::move(*light);
        out.own_leaves = static_cast<double>(out.light.tree.leaves().size());
        const double parts = out.leaves - whole;
        whole = 0;
        for (const ElementId root : out.light.tree.roots()) whole += out.light.tree.is_leaf(root) ? 1 : 0;
        if (parts > 0) growth = std::clamp((out.own_leaves - whole) / parts, min_growth, max_growth);
        out.leaves = out.own_leaves;
    }
    return out;
}

/// Returns the number of elements into which substructuring splits patches. Light of the first reflection has steps
/// between patches; the steps of smooth light halve with every split.
double cut_patches(const Stage& stage, const Plan& plan, const DirectProjection& direct, double mean_light) {
    const ElementLocator locator(direct.tree, stage.scene.regions().size());
    const auto light = [&](ElementId leaf) {
        const Spectrum E = direct.at({leaf, direct.tree.centre(leaf)});
        return mean(stage.scene.material(direct.tree.region(leaf)).reflectance * E);
    };
    const double threshold = steep_step(plan.options.error_target(), mean_light);
    const double min_area = plan.options.min_area.value_or(calibrated::min_patch_element * stage.area);
    double elements = 0;
    for (const ElementId leaf : direct.tree.leaves()) {
        double step = steepest_step(direct.tree, locator, leaf, light), pieces = 1;
        for (int sweep = 0; sweep < patch_sweeps && step > threshold; ++sweep, step /= 2)
            if (direct.tree.area(leaf) > 2 * min_area * pieces) pieces *= 4;
        elements += pieces;
    }
    return elements;
}

/// Returns the rays of the method itself on this many elements.
double method_rays(const Plan& plan, const Pilot& pilot, double patches, double elements) {
    const SolveOptions& o = plan.options;
    if (entry_of(o.method).forecast) return 0;  // added by the method's own formula
    const double rows = elements * plan.knobs.solve_rays.average;
    const double samples = static_cast<double>(o.visibility_samples.value_or(shooting_samples));
    switch (o.method) {
        case Method::progressive:
            return shooting_share * elements * elements * samples;
        // counts rows of all patches and of all split elements, including those split again
        case Method::substructuring:
            return pilot.facing * patches * (patches + 4.0 / 3 * elements) * samples;
        case Method::monte_carlo:
            return 8 * random_sweeps * rows;
        case Method::hierarchical:
        case Method::discontinuity:
            return 0.5 * rows;
        default:
            return rows;
    }
}

/// Returns the rays of the certificate: two gathers at every point, and matrix rows of few rays.
double certificate_rays(const Plan& plan, double elements, double gathered, double rays_an_element) {
    const double rows = 12 * elements;
    const double points = static_cast<double>(CertificateOptions::points_for(static_cast<std::size_t>(gathered)));
    // Sums are checked at half as many points, where rays check the direct light in them.
    if (plan.sums) return rows + points * ResidualSampler::rays_beside_sums;
    return rows + 2 * points * std::max(16.0, 0.2 * rays_an_element);
}

/// Completes the forecast of a published form: its own counts, and those of a gather if it has one.
Forecast of_published(const Stage& stage, const Plan& plan, const Pilot& pilot, double projected, Forecast out) {
    const SolveOptions& o = plan.options;
    const MethodForecast own =
        entry_of(o.method, form_of(o)).forecast(stage, o, plan.knobs, pilot.facing, pilot.blocked);
    const bool gathers = o.classical.gather.value_or(true) && stage.has_indirect_light();
    const double gathered = gathers ? gathered_by_solved * projected : 0;
    out.solve_elements = static_cast<std::size_t>(own.elements);
    out.gather_elements = static_cast<std::size_t>((plan.knobs.gather_curved ? straight_by_curved : 1) * gathered);
    const double gather_rays = gathered * element_rays * pilot.rays;
    out.rays = own.rays + gather_rays;
    out.seconds = (published_ray_time * own.rays + gather_rays) * pilot.gather_seconds +
                  own.elements * lights_an_element * pilot.light_seconds;
    out.memory_bytes = static_cast<double>(peak_memory_bytes()) + own.bytes +
                       bytes_a_leaf * (own.elements + static_cast<double>(out.gather_elements));
    return out;
}

}  // namespace

Result<Forecast> forecast_solve(const Scene& scene, const SolveOptions& asked, std::size_t max_elements) {
    const Result<SolveOptions> settled = with_published_method(asked);
    if (!settled) return settled.error();
    const SolveOptions& options = *settled;
    const bool is_published = form_of(options) != Form::standard;
    const StopRequest never;
    Stage stage(scene);
    survey(stage, options, never);
    Plan plan = make_plan(stage, options);
    if (options.memory_limit_bytes && !is_published)
        if (const Result<bool> fits = fit_into_memory(plan.knobs, stage, plan.options); !fits) return fits.error();
    const bool patches = plan.options.method == Method::substructuring && !is_published;
    const ForecastMesh mesh = forecast_mesh(stage, plan, patches, max_elements);
    const DirectProjection& direct = mesh.light;

    Forecast out{.method = name_in(method_names, plan.options.method),
                 .surfaces = scene.surfaces().size(),
                 .regions = scene.regions().size(),
                 .emitters = scene.emitters().size() + scene.lights().size(),
                 .is_at_least = mesh.is_limited};
    const Pilot pilot = run_pilot(stage, plan, direct);
    if (is_published) return of_published(stage, plan, pilot, mesh.leaves, std::move(out));
    const double projected = mesh.leaves;
    const double solved = patches ? mesh.finer() * cut_patches(stage, plan, direct, pilot.mean_light) : projected;
    const bool indirect = plan.options.bounces != 0 && stage.has_indirect_light();
    const double gathered = indirect ? (patches ? gathered_by_patches : gathered_by_solved) * projected : 0;
    const double leaves = plan.knobs.gather_curved ? straight_by_curved * gathered : gathered;
    const double rays_an_element = plan.sums ? 0 : element_rays * pilot.rays;
    out.solve_elements = static_cast<std::size_t>(solved), out.gather_elements = static_cast<std::size_t>(leaves);
    if (indirect)
        out.rays = method_rays(plan, pilot, projected, solved) + gathered * rays_an_element +
                   certificate_rays(plan, solved, gathered, rays_an_element);
    if (const auto own = entry_of(plan.options.method).forecast)
        out.rays += own(stage, plan.options, plan.knobs, pilot.facing, pilot.blocked).rays;
    out.seconds = out.rays * pilot.gather_seconds + solved * lights_an_element * pilot.light_seconds;
    out.memory_bytes = static_cast<double>(peak_memory_bytes()) +
                       method_bytes(stage, plan.options, plan.knobs, solved) + bytes_a_leaf * (solved + leaves);
    return out;
}

}  // namespace exitance
