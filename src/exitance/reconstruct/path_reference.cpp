#include "exitance/reconstruct/path_reference.hpp"

#include <optional>

#include "exitance/core/parallel.hpp"
#include "exitance/mesh/pieces.hpp"
#include "exitance/transport/hemisphere.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// A piece of an emitter that shadow rays are aimed at.
struct LightPiece {
    RegionId region;
    Patch patch;
    Normal n;
    double area;
    Spectrum exitance;
};

/// A point that a path has reached.
struct Vertex {
    Point x;
    Normal n;
    RegionId region;
};

class PathTracer {
  public:
    explicit PathTracer(const Scene& scene) : stage_(scene) {
        for (const auto& [region, patch] : stage_.pieces) {
            const Material& material = scene.material(region);
            if (!material.emits()) continue;
            lights_.push_back({region, patch, scene.regions()[region].plane.n, patch.area(), material.exitance});
        }
    }

    const Stage& stage() const { return stage_; }

    /// What one path brings to x from light that was reflected at least once.
    Spectrum path(const Vertex& probe, double a, double b, RandomStream& random) const {
        Spectrum sum, throughput(1.0);
        std::optional<Vertex> y = follow(probe, cosine_direction(Frame(probe.n), a, b));
        while (y) {
            const Spectrum& rho = stage_.scene.material(y->region).reflectance;
            const double survival = max(rho);
            if (survival <= 0 || random.uniform() >= survival) return sum;
            throughput *= rho / survival;
            sum += throughput * shadow_ray(*y, random);
            const Beams& beams = stage_.direct.beams();
            if (!beams.empty()) sum += throughput * beams.irradiance({y->x, y->n, y->region});
            const double u = random.uniform(), v = random.uniform();
            const std::optional<Vertex> next = follow(*y, cosine_direction(Frame(y->n), u, v));
            if (next) {
                const Spectrum& exitance = stage_.scene.material(next->region).exitance;
                if (max(exitance) > 0) sum += throughput * exitance * (1 - weight_of_shadow_ray(*y, *next));
            }
            y = next;
        }
        return sum;
    }

  private:
    /// Where a ray arrives; nothing when it is lost or meets a back.
    std::optional<Vertex> follow(const Vertex& from, const Vec3& direction) const {
        RayHit hit;
        stage_.tracer.nearest(std::span(&from.x, 1), std::span(&direction, 1), from.region, std::span(&hit, 1));
        if (hit.surface.is_none() || !hit.front) return std::nullopt;
        const RegionId region = stage_.scene.surfaces()[hit.surface].region;
        return Vertex{from.x + hit.distance * direction, stage_.scene.regions()[region].plane.n, region};
    }

    /// How likely each light is to be chosen at y, in proportion to what it would bring if nothing stood between.
    double chances(const Vertex& y, std::vector<double>& chance) const {
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
    double shadow_density(const Vertex& y, const Vertex& target) const {
        thread_local std::vector<double> chance;
        const double total = chances(y, chance);
        if (total <= 0) return 0;
        const Vec3 w = target.x - y.x;
        const double r2 = squared_norm(w), cosine = -dot(target.n, w) / std::sqrt(r2);
        if (cosine <= 0) return 0;
        double density = 0;
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            if (lights_[i].region != target.region) continue;
            const Vec2 uv = lights_[i].patch.coordinates(target.x);
            constexpr double slack = 1e-6;
            const bool inside =
                uv.x >= -slack && uv.y >= -slack &&
                (lights_[i].patch.is_triangle() ? uv.x + uv.y <= 1 + slack : uv.x <= 1 + slack && uv.y <= 1 + slack);
            if (inside) density = std::max(density, chance[i] / total * r2 / (lights_[i].area * cosine));
        }
        return density;
    }

    double weight_of_shadow_ray(const Vertex& y, const Vertex& target) const {
        const double shadow = shadow_density(y, target);
        const Vec3 w = target.x - y.x;
        const double cosine = dot(y.n, w) / (pi * norm(w));
        return shadow / (shadow + std::max(cosine, 1e-300));
    }

    /// Direct light at y by one shadow ray, weighted against the ray that the path takes anyway.
    Spectrum shadow_ray(const Vertex& y, RandomStream& random) const {
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
        const std::optional<Vertex> seen = follow(y, w);
        if (!seen || seen->region != light.region) return {};
        const double density = shadow_density(y, target);
        if (density <= 0) return {};
        return light.exitance * (at_y / pi / density * weight_of_shadow_ray(y, target));
    }

    Stage stage_;
    std::vector<LightPiece> lights_;
};

}  // namespace

std::vector<ReferenceLight> reference_light(const Scene& scene, std::span<const ProbePoint> points, std::size_t paths,
                                            std::uint64_t seed, Progress& progress, const StopRequest& stop) {
    constexpr std::size_t randomisations = 16, chunk = 64;
    const PathTracer tracer(scene);
    const Locator locator(scene);
    const std::uint32_t each = static_cast<std::uint32_t>((paths + randomisations - 1) / randomisations);
    std::vector<ReferenceLight> out(points.size());
    progress.phase("paths");
    progress.advance(0);
    for (std::size_t first = 0; first < points.size() && !stop.requested(); first += chunk) {
        const std::size_t count = std::min(chunk, points.size() - first);
        parallel_for(count, 1, [&](std::size_t local) {
            const std::size_t i = first + local;
            const auto& [x, n] = points[i];
            const SurfaceId surface = locator.find(x, n);
            const RegionId region = surface.is_none() ? RegionId() : scene.surfaces()[surface].region;
            if (!surface.is_none() && tracer.stage().occluders.is_covered(x, n, region)) return;
            DirectLight::Workspace workspace;
            std::array<Spectrum, randomisations> batch{};
            for (std::size_t k = 0; k < randomisations; ++k) {
                const ScrambledSobol first_directions(hash(seed, static_cast<std::uint64_t>(Stream::reference), i, k));
                RandomStream random(seed, Stream::reference, i, k);
                for (std::uint32_t p = 0; p < each; ++p) {
                    if (p % 1024 == 0 && stop.requested()) return;
                    batch[k] += tracer.path({x, n, region}, first_directions(p, 0), first_directions(p, 1), random);
                }
                batch[k] *= 1.0 / each;
                out[i].irradiance += batch[k] / randomisations;
            }
            Spectrum square;
            for (const Spectrum& value : batch) square += (value - out[i].irradiance) * (value - out[i].irradiance);
            for (std::size_t b = 0; b < bands; ++b)
                out[i].standard_error[b] = std::sqrt(square[b] / (randomisations * (randomisations - 1.0)));
            out[i].irradiance += tracer.stage().direct.irradiance(x, n, region, workspace);
        });
        progress.advance(static_cast<double>(first + count) / static_cast<double>(points.size()));
    }
    return out;
}

}  // namespace exitance
