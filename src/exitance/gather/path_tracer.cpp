#include "exitance/gather/path_tracer.hpp"

#include "exitance/base/limits.hpp"
#include "exitance/direct/source_point.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/form_factors/met_directions.hpp"

namespace exitance {

PathTracer::PathTracer(const Stage& stage) : stage_(stage), lights_(stage.direct) {}

std::optional<PathTracer::Vertex> PathTracer::first(const SurfacePoint& from, double a, double b) const {
    const Vec3 direction = met_direction(stage_.scene, from.region, from.n, a, b);
    const RayHit hit = trace(from, direction, Mirrored::followed);
    const std::optional<SurfacePoint> end = vertex_of(hit, from, direction);
    return end ? std::optional(Vertex{*end, stage_.glass.of(hit, from.x, direction)}) : std::nullopt;
}

Spectrum PathTracer::path(const SurfacePoint& probe, double a, double b, RandomStream& random) const {
    Spectrum sum, throughput(1.0);
    std::optional<Vertex> y = first(probe, a, b);
    while (y) {
        const Spectrum& rho = stage_.scene.material(y->at.region).reflectance;
        const double survival = max(rho);
        if (survival <= 0 || random.uniform() >= survival) return sum;
        throughput *= rho / survival * y->colour;
        const Step found = step(y->at, random);
        sum += throughput * found.direct;
        y = found.next;
    }
    return sum;
}

PathTracer::Step PathTracer::step(const SurfacePoint& vertex, RandomStream& random) const {
    SurfacePoint y = vertex;
    // Light that leaves a diffusing pane arrived on either side.
    if (const RegionId behind = stage_.scene.behind(y.region); !behind.is_none())
        if (random.uniform() < stage_.scene.material(y.region).through) y = SurfacePoint{y.x, -y.n, behind};
    Step out{shadow_ray(y, random), {}};
    const Beams& beams = stage_.direct.beams();
    if (!beams.empty()) out.direct += beams.irradiance({y.x, y.n, y.region});
    const DistantLight& outside = stage_.scene.distant();
    if (!outside.discs.empty()) out.direct += light_of_discs(y, random);
    const double u = random.uniform(), v = random.uniform();
    const Vec3 on = cosine_direction(Frame(y.n), u, v);
    if (stage_.place_light.is_mirrored())
        out.direct += stage_.place_light.mirrored_images({y.x, y.n, y.region}, 1, random.bits());
    const RayHit hit = trace(y, on, Mirrored::followed);
    const Spectrum colour = stage_.glass.of(hit, y.x, on);
    if (const std::optional<SurfacePoint> end = vertex_of(hit, y, on)) out.next = Vertex{*end, colour};
    out.direct += colour * met_light(hit, y, on);
    return out;
}

/// Light of sky and emitters that the path's next ray meets, straight or mirrored, times the weight of that ray.
Spectrum PathTracer::met_light(const RayHit& hit, const SurfacePoint& from, const Vec3& direction) const {
    const Vec3 w = normalized(arriving(stage_.scene, hit, direction));
    if (hit.surface.is_none())
        return stage_.scene.distant().domes.empty() ? Spectrum() : stage_.scene.distant().radiosity(w, false);
    const std::optional<SurfacePoint> met = vertex_of(hit, from, direction);
    if (!met) return {};
    const Spectrum& exitance = stage_.scene.material(met->region).exitance;
    if (!(max(exitance) > 0)) return {};
    // Shadow rays cannot hit mirror images, so their hits have full weight.
    const double weight = hit.mirror >= 0 ? 1 : 1 - weight_of_shadow_ray(from, *met);
    return (stage_.scene.relative_radiance(met->region)(-w) * weight) * exitance;
}

double PathTracer::rays_per_step() const {
    return 1.0 + (lights_.empty() ? 0 : 1) + static_cast<double>(stage_.scene.distant().discs.size());
}

RayHit PathTracer::trace(const SurfacePoint& from, const Vec3& direction, Mirrored mirrored) const {
    RayHit hit;
    stage_.tracer.nearest(std::span(&from.x, 1), std::span(&direction, 1), from.region, std::span(&hit, 1), mirrored);
    return hit;
}

std::optional<SurfacePoint> PathTracer::vertex_of(const RayHit& hit, const SurfacePoint& from,
                                                  const Vec3& direction) const {
    if (hit.surface.is_none() || !hit.front) return std::nullopt;
    const RegionId region = hit.region;
    return SurfacePoint{place_of(stage_.scene, hit, from.x, direction), stage_.scene.regions()[region].plane.n, region};
}

/// Returns a sample of the light of all distant discs: one ray per disc, uniform in its solid angle.
Spectrum PathTracer::light_of_discs(const SurfacePoint& y, RandomStream& random) const {
    Spectrum sum;
    for (const DistantLight::Disc& disc : stage_.scene.distant().discs) {
        const double u = random.uniform(), v = random.uniform(), least = std::cos(disc.half_angle);
        const double z = 1 - u * (1 - least), r = std::sqrt(std::max(0.0, 1 - z * z));
        const Vec3 w = Frame(disc.towards).to_world(r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), z);
        const double cosine = dot(y.n, w);
        if (cosine <= 0) continue;
        const RayHit hit = trace(y, w, Mirrored::lost);
        // Uniform radiance L: irradiance across it is pi L sin^2, its solid angle 2 pi (1 - cos).
        if (hit.surface.is_none()) sum += (2 * cosine / (1 + least)) * (stage_.glass.of(hit, y.x, w) * disc.irradiance);
    }
    return sum;
}

namespace {

/// Density per solid angle of a point of a light that is uniform in area. `cosine`: at the light.
double density_of(double chance, double area, double squared_distance, double cosine) {
    return chance * squared_distance / (area * cosine);
}

/// Weight of a sample by the first of two densities, by the balance heuristic.
double balance(double first, double second) {
    return first / (first + std::max(second, min_divisor));
}

}  // namespace

/// Weight of a shadow ray from y to `target` on a light, against the path's next ray.
double PathTracer::weight_of_shadow_ray(const SurfacePoint& y, const SurfacePoint& target) const {
    const Vec3 w = target.x - y.x;
    const double r2 = squared_norm(w), r = std::sqrt(r2), at_light = -dot(target.n, w);
    // The points may coincide, at a corner of the light.
    if (r2 <= 0 || at_light <= 0 || lights_.empty()) return 0;
    const std::optional<std::uint32_t> source = lights_.source_at(target.region, target.x);
    const double chance = source ? lights_.chance_of(*source, y.x, y.n) : 0;
    if (chance <= 0) return 0;
    return balance(density_of(chance, lights_.source(*source).area, r2, at_light / r), dot(y.n, w) / (pi * r));
}

/// Direct light at y by one shadow ray, weighted against the next ray of the path, which may hit the same light.
Spectrum PathTracer::shadow_ray(const SurfacePoint& y, RandomStream& random) const {
    if (lights_.empty()) return {};
    const double pick = random.uniform(), u = random.uniform(), v = random.uniform();
    const auto [number, chance] = lights_.choose(y.x, y.n, pick);
    if (chance <= 0) return {};
    const EmitterTree::Source& source = lights_.source(number);
    const DirectLight::Emitter& light = stage_.direct.emitters()[source.name.emitter];
    const Point target = uniform_on(stage_.direct.occluders().corners(source.name.piece), source.area, u, v);
    const Vec3 w = target - y.x;
    const double r2 = squared_norm(w), r = std::sqrt(r2);
    const double at_y = dot(y.n, w) / r, at_light = -dot(light.plane.n, w) / r;
    if (at_y <= 0 || at_light <= 0 || source.region == y.region) return {};
    // The first hit of a ray would not do: rays are traced in single precision and may pass the rim of a small light.
    bool blocked = false;
    stage_.tracer.occluded(std::span(&y.x, 1), std::span(&target, 1), y.region, source.region, std::span(&blocked, 1));
    if (blocked) return {};
    const double density = density_of(chance, source.area, r2, at_light);
    const double share = light.radiance.towards(y.x, target) * at_y / pi / density * balance(density, at_y / pi);
    return share * (stage_.glass.between(y.x, target) * light.exitance);
}

}  // namespace exitance
