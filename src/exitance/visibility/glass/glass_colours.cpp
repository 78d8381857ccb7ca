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
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < scene.panes().size(); ++i) {
        if (is_grey(scene.panes()[i].transmissivity)) continue;
        panes_.push_back(static_cast<std::int32_t>(i));
        Box& box = boxes.emplace_back();
        for (const Point& p : scene.panes()[i].corners) box.add(p);
    }
    tree_ = Bvh(boxes);
}

Spectrum GlassColours::between(const Point& x, const Point& y, std::int32_t ignored) const {
    Spectrum out(1.0);
    if (empty()) return out;
    const Vec3 d = y - x;
    tree_.visit_segment(x, d, 1, [&](std::uint32_t i) {
        const Pane& pane = scene_->panes()[static_cast<std::size_t>(panes_[i])];
        if (panes_[i] != ignored && crosses(pane, x, y))
            out *= over_mean(pane.transmission(std::abs(dot(pane.n, d)) / norm(d)));
        return 1.0;
    });
    return out;
}

Spectrum GlassColours::of(const RayHit& hit, const Point& origin, const Vec3& direction) const {
    if (empty()) return Spectrum(1.0);
    constexpr double beyond_all = 4;  // in sizes of the scene
    const Vec3 to_outside = beyond_all * scene_->size() / norm(direction) * direction;
    if (hit.mirror < 0)
        return between(origin, origin + (hit.surface.is_none() ? to_outside : hit.distance * direction));
    const Pane& pane = scene_->panes()[static_cast<std::size_t>(hit.mirror)];
    const double slope = dot(pane.n, direction);
    const Point mirror = origin + (dot(pane.n, pane.corners[0] - origin) / slope) * direction;
    const Point end =
        hit.surface.is_none() ? mirror + arriving(*scene_, hit, to_outside) : place_of(*scene_, hit, origin, direction);
    return between(origin, mirror, hit.mirror) * between(mirror, end, hit.mirror) *
           over_mean(pane.reflection(std::abs(slope) / norm(direction)));
}

}  // namespace exitance
