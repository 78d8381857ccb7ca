#include "exitance/scene/locator.hpp"

#include <cmath>

#include "exitance/scene/outline_distance.hpp"

namespace exitance {

struct Locator::Candidate {
    SurfaceId surface;
    double distance = HUGE_VAL;
    bool holds = false;
};

Locator::Locator(const Scene& scene) : scene_(&scene), tolerance_(1e-5 * scene.size()) {
    std::vector<Box> boxes(scene.surfaces().size());
    const Vec3 margin = {tolerance_, tolerance_, tolerance_};
    for (SurfaceId s : scene.surfaces().ids()) {
        for (const Point& p : scene.outline(s)) boxes[s.value].add(p);
        boxes[s.value].lo -= margin, boxes[s.value].hi += margin;
    }
    tree_ = Bvh(boxes);
}

void Locator::look_at(SurfaceId s, const Point& p, const Normal& n, Candidate& best) const {
    const Surface& surface = scene_->surfaces()[s];
    if (!(dot(surface.normal, n) > parallel_cosine)) return;
    const std::span<const Point> outline = scene_->outline(s);
    const double height = dot(surface.normal, p - outline[0]);
    if (!(std::abs(height) <= tolerance_)) return;

    Candidate found = {s, std::abs(height), contains(outline, surface.normal, p)};
    if (!found.holds) found.distance = norm(p - nearest_on_border(outline, p));
    if (!(found.distance <= tolerance_)) return;
    // Distances are equal if they differ only by the rounding of a text file's digits.
    const double gain = best.distance - found.distance, rounding = 1e-4 * tolerance_;
    if (std::abs(gain) <= rounding) {
        const auto level = [&](SurfaceId f) { return scene_->regions()[scene_->surfaces()[f].region].level; };
        const bool is_on_top = best.surface.is_none() || level(s) > level(best.surface) ||
                               (level(s) == level(best.surface) && s < best.surface);
        if (found.holds != best.holds ? found.holds : is_on_top) best = found;
    } else if (gain > 0) {
        best = found;
    }
}

SurfaceId Locator::find(const Point& p, const Normal& n) const {
    Candidate best;
    tree_.visit_box({p, p}, [&](std::uint32_t i) { look_at(SurfaceId(i), p, n, best); });
    return best.surface;
}

}  // namespace exitance
