#include "exitance/what_if/daylight/view_out.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {
namespace {

constexpr int azimuths = 1440, heights = 37;
constexpr double step_of_height = 2.5, degree = pi / 180;
constexpr double min_upward_cosine = 0.7;  ///< Minimum cosine to the vertical of faces that count as ground.

double elevation(int k) {
    return step_of_height * (k - heights / 2);
}

/// True if a ray along d meets a pane before `distance`.
bool meets_pane(const Scene& scene, const Point& eye, const Vec3& d, double distance) {
    return std::any_of(scene.panes().begin(), scene.panes().end(), [&](const Pane& pane) {
        const double towards = dot(pane.n, d);
        if (towards == 0) return false;
        const double t = dot(pane.n, pane.corners[0] - eye) / towards;
        return t > 0 && t < distance && contains(pane.corners, pane.n, eye + t * d);
    });
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void note_layer(const Scene& scene, const RayHit& hit, int height, ViewOut& out) {
    if (hit.surface.is_none()) {
        bool& layer = height > heights / 2 ? out.sky : height < heights / 2 ? out.ground : out.landscape;
        layer = true;
    } else if (scene.surfaces()[hit.surface].normal.z * (hit.front ? 1 : -1) > min_upward_cosine)
        out.ground = true;
    else
        out.landscape = true;
}

ViewOut view_from(const Scene& scene, const RayTracer& tracer, const Point& eye) {
    ViewOut out;
    std::vector<double> level, all;  // distances
    std::array<Vec3, heights> directions;
    std::array<RayHit, heights> hits;
    for (int a = 0; a < azimuths; ++a) {
        const double azimuth = 2 * pi * (a + 0.5) / azimuths;
        for (int k = 0; k < heights; ++k) {
            const double e = elevation(k) * degree;
            directions[static_cast<std::size_t>(k)] = {std::cos(e) * std::cos(azimuth), std::cos(e) * std::sin(azimuth),
                                                       std::sin(e)};
        }
        hits.fill({});
        tracer.nearest(directions, eye, RegionId(), hits);
        bool seen = false;
        for (int k = 0; k < heights; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const bool escapes = hits[i].surface.is_none();
            const double distance = escapes ? HUGE_VAL : hits[i].distance;
            if (!escapes && !meets_pane(scene, eye, directions[i], distance)) continue;
            seen = true;
            note_layer(scene, hits[i], k, out);
            const double along_ground = distance * std::cos(elevation(k) * degree);
            all.push_back(along_ground);
            if (k == heights / 2) level.push_back(along_ground);
        }
        out.sight_angle += seen ? 360.0 / azimuths : 0;
    }
    out.distance = median(level.empty() ? std::move(all) : std::move(level));
    return out;
}

}  // namespace

int ViewOut::level() const {
    constexpr std::array<double, 3> angles{14, 28, 54}, distances{6, 20, 50};
    const int layers = sky + landscape + ground;
    int out = 0;
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        if (sight_angle >= angles[i] && distance >= distances[i] && landscape && layers > k) out = k + 1;
    }
    return out;
}

std::vector<ViewOut> views_out(const Scene& scene, std::span<const Point> eyes) {
    const RayTracer tracer(scene);
    std::vector<ViewOut> out(eyes.size());
    parallel_for(eyes.size(), 1, [&](std::size_t i) { out[i] = view_from(scene, tracer, eyes[i]); });
    return out;
}

}  // namespace exitance
