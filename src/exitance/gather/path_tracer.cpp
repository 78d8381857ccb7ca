#include "exitance/gather/path_tracer.hpp"

#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/form_factors/met_directions.hpp"

namespace exitance {

PathTracer::PathTracer(const Stage& stage) : stage_(stage) {
    for (const auto& [region, patch] : stage_.pieces) {
        const Material& material = stage.scene.material(region);
        if (!material.emits()) continue;
        lights_.push_back({region, patch, stage.scene.regions()[region].plane.n, patch.area(), material.exitance,
                           stage.scene.relative_radiance(region)});
    }
}

std::optional<PathTracer::Vertex> PathTracer::first(const Vertex& from, double a, double b) const {
    const Vec3 direction = met_direction(stage_.scene, from.region, from.n, a, b);
    return vertex_of(trace(from, direction, Mirrored::followed), from, direction);
}

Spectrum PathTracer::path(const Vertex& probe, double a, double b, RandomStream& random) const {
    Spectrum sum, throughput(1.0);
    std::optional<Vertex> y = first(probe, a, b);
    while (y) {
        const Spectrum& rho = stage_.scene.material(y->region).reflectance;
        const double survival = max(rho);
        if (survival <= 0 || random.uniform() >= survival) return sum;
        throughput *= rho / survival;
        const Step found = step(*y, random);
        sum += throughput * found.direct;
        y = found.next;
    }
    return sum;
}

PathTracer::Step PathTracer::step(const Vertex& vertex, RandomStream& random) const {
    Vertex y = vertex;
    // Light that leaves a diffusing pane arrived on either side.
    if (const RegionId behind = stage_.scene.behind(y.region); !behind.is_none())
        if (random.uniform() < stage_.scene.material(y.region).through) y = Vertex{y.x, -y.n, behind};
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
    out.next = vertex_of(hit, y, on);
    out.direct += met_light(hit, y, on);
    return out;
}

/// Light of sky and emitters that the path's next ray meets, straight or mirrored, times the weight of that ray.
Spectrum PathTracer::met_light(const RayHit& hit, const Vertex& from, const Vec3& direction) const {
    const Vec3 w = normalized(arriving(stage_.scene, hit, direction));
    if (hit.surface.is_none())
        return stage_.scene.distant().domes.empty() ? Spectrum() : stage_.scene.distant().radiosity(w, false);
    const std::optional<Vertex> met = vertex_of(hit, from, direction);
    if (!met) return {};
    const Spectrum& exitance = stage_.scene.material(met->region).exitance;
    if (!(max(exitance) > 0)) return {};
    // Shadow rays meet no mirror images.
    const double weight = hit.mirror >= 0 ? 1 : 1 - weight_of_shadow_ray(from, *met);
    return (stage_.scene.relative_radiance(met->region)(-w) * weight) * exitance;
}

double PathTracer::rays_per_step() const {
    return 1.0 + (lights_.empty() ? 0 : 1) + static_cast<double>(stage_.scene.distant().discs.size());
}

RayHit PathTracer::trace(const Vertex& from, const Vec3& direction, Mirrored mirrored) const {
    RayHit hit;
    stage_.tracer.nearest(std::span(&from.x, 1), std::span(&direction, 1), from.region, std::span(&hit, 1), mirrored);
    return hit;
}

std::optional<PathTracer::Vertex> PathTracer::vertex_of(const RayHit& hit, const Vertex& from,
                                                        const Vec3& direction) const {
    if (hit.surface.is_none() || !hit.front) return std::nullopt;
    const RegionId region = hit.region;
    return Vertex{place_of(stage_.scene, hit, from.x, direction), stage_.scene.regions()[region].plane.n, region};
}

/// Returns a sample of the light of all distant discs: one ray per disc, uniform in its solid angle.
Spectrum PathTracer::light_of_discs(const Vertex& y, RandomStream& random) const {
    Spectrum sum;
    for (const DistantLight::Disc& disc : stage_.scene.distant().discs) {
        const double u = random.uniform(), v = random.uniform(), least = std::cos(disc.half_angle);
        const double z = 1 - u * (1 - least), r = std::sqrt(std::max(0.0, 1 - z * z));
        const Vec3 w = Frame(disc.towards).to_world(r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), z);
        const double cosine = dot(y.n, w);
        const bool lost = cosine > 0 && trace(y, w, Mirrored::lost).surface.is_none();
        // Uniform radiance L: irradiance across it is pi L sin^2, its solid angle 2 pi (1 - cos).
        if (lost) sum += (2 * cosine / (1 + least)) * disc.irradiance;
    }
    return sum;
}

/// How likely each light is to be chosen at y, in proportion to what it would bring if nothing stood between.
double PathTracer::chances(const Vertex& y, std::vector<double>& chance) const {
    chance.resize(lights_.size());
    double total = 0;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const LightPiece& light = lights_[i];
        const Vec3 w = light.patch.centre() - y.x;
        const double radius2 = light.area, r2 = squared_norm(w) + radius2, r = std::sqrt(r2);
        // Cosines are raised by the light's angular size, so that none that is seen in part has no chance.
        const double spread = std::sqrt(radius2 / r2);
        const double at_y = std::min(1.0, std::max(0.0, dot(y.n, w) / r) + spread);
        const double at_light = dot(light.n, y.x - light.patch.origin) > 0
                                    ? std::min(1.0, std::max(0.0, -dot(light.n, w) / r) + spread)
                                    : 0;
        total += chance[i] = mean(light.exitance) * light.area * at_y * at_light / r2;
    }
    return total;
}

/// The density, per solid angle, with which a shadow ray from y is aimed at `target` on a light.
double PathTracer::shadow_density(const Vertex& y, const Vertex& target) const {
    thread_local std::vector<double> chance;
    const double total = chances(y, chance);
    if (total <= 0) return 0;
    const Vec3 w = target.x - y.x;
    const double r2 = squared_norm(w);
    if (r2 <= 0) return 0;
    const double cosine = -dot(target.n, w) / std::sqrt(r2);
    if (cosine <= 0) return 0;
    double density = 0;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        if (lights_[i].region != target.region) continue;
        const Vec2 uv = lights_[i].patch.coordinates(target.x);
        constexpr double slack = 1e-6;  // given by rounding of hits, in single precision
        const bool inside =
            uv.x >= -slack && uv.y >= -slack &&
            (lights_[i].patch.is_triangle() ? uv.x + uv.y <= 1 + slack : uv.x <= 1 + slack && uv.y <= 1 + slack);
        if (inside) density = std::max(density, chance[i] / total * r2 / (lights_[i].area * cosine));
    }
    return density;
}

double PathTracer::weight_of_shadow_ray(const Vertex& y, const Vertex& target) const {
    const double shadow = shadow_density(y, target);
    if (shadow <= 0) return 0;  // also where a ray from a corner meets a light at no distance at all
    const Vec3 w = target.x - y.x;
    const double cosine = dot(y.n, w) / (pi * norm(w));
    return shadow / (shadow + std::max(cosine, 1e-300));  // given by rounding: not 0
}

/// Direct light at y by one shadow ray, weighted against the ray that the path takes anyway.
Spectrum PathTracer::shadow_ray(const Vertex& y, RandomStream& random) const {
    thread_local std::vector<double> chance;
    if (lights_.empty()) return {};
    const double total = chances(y, chance);
    const double pick = random.uniform() * total, u = random.uniform(), v = random.uniform();
    if (total <= 0) return {};
    std::size_t i = 0;
    for (double sum = chance[0]; i + 1 < lights_.size() && sum <= pick;) sum += chance[++i];
    const LightPiece& light = lights_[i];
    const Vertex target{light.patch.at(uniform_in_shape(light.patch.shape, u, v)), light.n, light.region};
    const Vec3 w = target.x - y.x;
    const double r2 = squared_norm(w), r = std::sqrt(r2);
    const double at_y = dot(y.n, w) / r, at_light = -dot(light.n, w) / r;
    if (at_y <= 0 || at_light <= 0 || light.region == y.region) return {};
    const std::optional<Vertex> seen = vertex_of(trace(y, w, Mirrored::lost), y, w);
    if (!seen || seen->region != light.region) return {};
    const double density = shadow_density(y, target);
    if (density <= 0) return {};
    return light.exitance *
           (light.radiance.towards(y.x, target.x) * at_y / pi / density * weight_of_shadow_ray(y, target));
}

}  // namespace exitance
