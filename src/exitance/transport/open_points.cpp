#include "exitance/transport/open_points.hpp"

#include <array>

namespace exitance {
namespace {

bool is_inside_body(const Stage& stage, const Point& x, const Normal& n, RegionId region) {
    const Frame frame(n);
    RayHit hit;
    const auto trace = [&](double u, double v, double up) {
        const Vec3 direction = frame.to_world(u, v, up);
        stage.tracer.nearest(std::span(&direction, 1), x, region, std::span(&hit, 1));
        return !hit.surface.is_none();
    };
    // In the open the first ray rarely hits a back. The four directions are perpendicular to each other as seen from
    // above, and not parallel to usual walls: ways derived from slopes of 0.3.
    constexpr std::array<Vec2, 4> ways{{{1, 0.3}, {-0.3, 1}, {-1, -0.3}, {0.3, -1}}};
    // Before a sheet of one side, such as a lamp below a ceiling, rays hit its back, too, unless they pass below its
    // border: slope derived from sheets a hundred times as wide as their distance.
    constexpr double slanted = 1, grazing = 0.01;
    for (const double up : {slanted, grazing})
        for (const Vec2& way : ways)
            if (!trace(way.x, way.y, up) || hit.front) return false;
    return trace(0, 0, 1);
}

}  // namespace

bool is_in_open(const Stage& stage, const Point& x, const Normal& n, RegionId region) {
    if (is_inside_body(stage, x, n, region)) return false;
    return region.is_none() || !stage.occluders.is_covered(x, n, region);
}

}  // namespace exitance
