#include "exitance/evaluate/open_points.hpp"

namespace exitance {
namespace {

bool is_inside_body(const Stage& stage, const Point& x, const Normal& n, RegionId region) {
    const Frame frame(n);
    RayHit hit;
    const auto trace = [&](double u, double v) {
        const Vec3 direction = frame.to_world(u, v, 1);
        stage.tracer.nearest(std::span(&direction, 1), x, region, std::span(&hit, 1));
        return !hit.surface.is_none();
    };
    // In the open the first ray rarely hits a back. The four directions are perpendicular to each other as seen from
    // above, and not parallel to usual walls: ways derived from slopes of 0.3.
    for (const Vec2& way : {Vec2{1, 0.3}, Vec2{-0.3, 1}, Vec2{-1, -0.3}, Vec2{0.3, -1}})
        if (!trace(way.x, way.y) || hit.front) return false;
    return trace(0, 0);
}

}  // namespace

bool is_in_open(const Stage& stage, const Point& x, const Normal& n, RegionId region) {
    if (is_inside_body(stage, x, n, region)) return false;
    return region.is_none() || !stage.occluders.is_covered(x, n, region);
}

}  // namespace exitance
