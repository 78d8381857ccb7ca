#include "exitance/error/texture_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/scene/bodies.hpp"

namespace exitance {
namespace {

/// Returns the squared error of a face's radiosity, mean over bands.
double squared_error(const Material& material, std::size_t number, const SurfaceLight& light,
                     std::span<const Spectrum> deviation) {
    if (number >= deviation.size() || max(material.reflectance) <= 0) return 0;
    const Spectrum error = deviation[number] * light.irradiance;
    return mean(error * error);
}

double mean_reflected(const Scene& scene, const Field<SurfaceId, SurfaceLight>& light) {
    double sum = 0, area = 0;
    for (const SurfaceId s : scene.surfaces().ids()) {
        sum += scene.surfaces()[s].area * mean(scene.material(s).reflectance * light[s].irradiance);
        area += scene.surfaces()[s].area;
    }
    return area > 0 ? sum / area : 0;
}

void add(std::optional<double>& estimate, double more) {
    if (estimate) *estimate = std::hypot(*estimate, more);
}

/// Adds the error of each body, relative to its mean light or a tenth of the scene's. The bodies of the statistics are
/// found again by their first faces.
void add_to_bodies(const Scene& scene, const Field<SurfaceId, SurfaceLight>& light, std::span<const Spectrum> deviation,
                   SolveStatistics& statistics) {
    if (statistics.bodies.empty()) return;
    constexpr double min_share = 0.1;  // derived from the definition of a body's error, as in the certificate
    const SceneBodies found = find_bodies(scene);
    std::vector<double> squared(found.all.size());
    for (const SurfaceId s : scene.surfaces().ids())
        squared[found.body[s]] +=
            scene.surfaces()[s].area *
            squared_error(scene.material(s), scene.surfaces()[s].material.value, light[s], deviation);
    const double min_light = min_share * mean_reflected(scene, light);
    for (BodyError& body : statistics.bodies) {
        const auto same = [&](const SceneBody& b) { return b.first == body.first; };
        const auto at = std::find_if(found.all.begin(), found.all.end(), same);
        const double reference = std::max(body.mean, min_light);
        if (!body.error || at == found.all.end() || !(reference > 0)) continue;
        const double error = std::sqrt(squared[static_cast<std::size_t>(at - found.all.begin())] / at->area);
        add(body.error, error / reference);
        statistics.relative_error_estimate_worst_body =
            std::max(statistics.relative_error_estimate_worst_body.value_or(0), *body.error);
    }
}

}  // namespace

double texture_error(const Scene& scene, const Field<SurfaceId, SurfaceLight>& light,
                     std::span<const Spectrum> deviation) {
    double sum = 0, area = 0;
    for (const SurfaceId s : scene.surfaces().ids()) {
        const Surface& surface = scene.surfaces()[s];
        sum += surface.area * squared_error(scene.material(s), surface.material.value, light[s], deviation);
        area += surface.area;
    }
    const double reflected = mean_reflected(scene, light);
    return reflected > 0 ? std::sqrt(sum / area) / reflected : 0;
}

void add_texture_error(Solution& solution, std::span<const Spectrum> deviation, std::optional<double> demand) {
    const auto varies = [](const Spectrum& d) { return max(d) > 0; };
    SolveStatistics& s = solution.statistics;
    if (!s.relative_error_estimate || std::none_of(deviation.begin(), deviation.end(), varies)) return;
    const Field<SurfaceId, SurfaceLight> light = mean_light(solution);
    const double error = texture_error(solution.scene, light, deviation);
    if (!(error > 0)) return;
    const double before = *s.relative_error_estimate;
    add(s.relative_error_estimate, error), add(s.relative_error_bound, error);
    add(s.relative_error_estimate_interpolant, error), add(s.relative_error_estimate_worst_room, error);
    s.error_p99.reset();  // unknown if reflectance varies within faces
    for (RoomError& room : s.rooms) room.error = std::hypot(room.error, error);
    const double reflected = mean_reflected(solution.scene, light);
    for (std::size_t f = 0; f < s.surface_errors.size(); ++f) {
        const SurfaceId id(f);
        const double own = std::sqrt(squared_error(solution.scene.material(id),
                                                   solution.scene.surfaces()[id].material.value, light[id], deviation));
        s.surface_errors[f].error = std::hypot(s.surface_errors[f].error, own / reflected);
    }
    add_to_bodies(solution.scene, light, deviation, s);
    s.figures["relative_error_textures"] = error;
    const bool missed = demand && *s.relative_error_estimate > *demand;
    // Share of the estimate above which a warning is shown. Given by judgement, not measured: a smaller part of an
    // error hardly changes what a reader concludes.
    constexpr double reported_share = 0.1;
    if (missed || error > reported_share * before)
        s.warnings.push_back(
            fmt::format("textures vary within faces, but a face or a part of it reflects its mean: this causes an "
                        "error of {:.3g}%, "
                        "which the estimate includes; without it the estimate is {:.3g}%",
                        100 * error, 100 * before));
    if (missed) s.converged = false;
}

}  // namespace exitance
