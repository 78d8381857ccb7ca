#include "exitance/visibility/glass/glass_colours.hpp"

#include <cmath>

#include "exitance/visibility/glazed_part.hpp"

namespace exitance {
namespace {

Spectrum over_mean(const Spectrum& share) {
    const double passing = mean(share);
    return passing > 0 ? share / passing : Spectrum(1.0);
}

}  // namespace

GlassColours::GlassColours(const Scene& scene) : scene_(&scene) {
    for (std::size_t i = 0; i < scene.panes().size(); ++i)
        if (!is_grey(scene.panes()[i].transmissivity)) panes_.push_back(static_cast<std::int32_t>(i));
}

Spectrum GlassColours::between(const Point& x, const Point& y, std::int32_t ignored) const {
    Spectrum out(1.0);
    const Vec3 d = y - x;
    for (const std::int32_t i : panes_) {
        const Pane& pane = scene_->panes()[static_cast<std::size_t>(i)];
        if (i != ignored && crosses(pane, x, y))
            out *= over_mean(pane.transmission(std::abs(dot(pane.n, d)) / norm(d)));
    }
    return out;
}

Spectrum GlassColours::of(const RayHit& hit, const Point& origin, const Vec3& direction) const {
    if (empty()) return Spectrum(1.0);
    if (hit.mirror >= 0) {  // another pane would have stopped the ray after the reflection
        const Pane& pane = scene_->panes()[static_cast<std::size_t>(hit.mirror)];
        const double slope = dot(pane.n, direction);
        const Point mirror = origin + (dot(pane.n, pane.corners[0] - origin) / slope) * direction;
        return between(origin, mirror, hit.mirror) * over_mean(pane.reflection(std::abs(slope) / norm(direction)));
    }
    constexpr double beyond_all = 4;  // in sizes of the scene
    const double length = hit.surface.is_none() ? beyond_all * scene_->size() / norm(direction) : hit.distance;
    return between(origin, origin + length * direction);
}

}  // namespace exitance
