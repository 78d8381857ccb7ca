#include "exitance/what_if/daylight/misplaced_sensors.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/visibility/glass/pane_groups.hpp"

namespace exitance {
namespace {

constexpr std::size_t rings = 4, steps = 8;

/// Directions of a hemisphere about z, distributed as the cosine of their angle to it.
std::array<Vec3, rings * steps> make_directions() {
    std::array<Vec3, rings * steps> out;
    for (std::size_t i = 0; i < rings; ++i)
        for (std::size_t k = 0; k < steps; ++k) {
            const double share = (static_cast<double>(i) + 0.5) / rings;
            const double shift = static_cast<double>(i) / rings;  // avoids rays parallel to walls
            const double angle = 2 * pi * (static_cast<double>(k) + 0.5 * shift + 1.0 / (2 * rings)) / steps;
            const double radius = std::sqrt(share);
            out[i * steps + k] = {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - share)};
        }
    return out;
}

/// Classifies sensors one by one.
class SensorSurroundings {
  public:
    explicit SensorSurroundings(const Stage& stage)
        : stage_(stage), panes_(stage.scene, std::vector<std::int32_t>(stage.scene.panes().size(), 0), 1) {}

    bool sees_backs(const SurfacePoint& sensor) const {
        const Frame frame(sensor.n);
        std::array<Vec3, rings * steps> ways;
        for (std::size_t k = 0; k < ways.size(); ++k)
            ways[k] = frame.to_world(directions_[k].x, directions_[k].y, directions_[k].z);
        std::size_t backs = 0;
        for (const RayHit& hit : hits(sensor, ways)) backs += !hit.surface.is_none() && !hit.front;
        return 2 * backs > ways.size();
    }

    bool is_outdoors(const SurfacePoint& sensor) const {
        if (!is_open(sensor, Vec3{0, 0, 1})) return false;
        constexpr double min_open = 0.3;  // share of directions; derived from the foot of a high wall, which sees 0.5
        std::size_t open = 0;
        for (const Vec3& way : directions_) open += is_open(sensor, way);
        return static_cast<double>(open) >= min_open * static_cast<double>(directions_.size());
    }

  private:
    template <std::size_t n>
    std::array<RayHit, n> hits(const SurfacePoint& from, const std::array<Vec3, n>& ways) const {
        std::array<RayHit, n> out;
        stage_.tracer.nearest(ways, from.x, from.region, out);
        return out;
    }

    /// True if a ray meets neither a face nor a pane.
    bool is_open(const SurfacePoint& from, const Vec3& way) const {
        return hits(from, std::array<Vec3, 1>{way})[0].surface.is_none() && panes_.crossed_outwards(from.x, way) == 0;
    }

    const Stage& stage_;
    PaneGroups panes_;  ///< All panes, as one group.
    std::array<Vec3, rings* steps> directions_ = make_directions();
};

}  // namespace

MisplacedSensors find_misplaced(const Stage& stage, std::span<const SurfacePoint> sensors) {
    const SensorSurroundings surroundings(stage);
    std::vector<std::uint8_t> is_behind(sensors.size()), is_outdoors(sensors.size());
    constexpr std::size_t grain = 64;
    parallel_for(sensors.size(), grain, [&](std::size_t i) {
        is_behind[i] = surroundings.sees_backs(sensors[i]);
        is_outdoors[i] = surroundings.is_outdoors(sensors[i]);
    });
    MisplacedSensors out;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        if (is_outdoors[i])
            out.outdoors.push_back(i);
        else if (is_behind[i])
            out.behind.push_back(i);
    }
    if (out.outdoors.size() == sensors.size()) out.outdoors.clear();
    return out;
}

std::vector<std::string> warnings_of(const MisplacedSensors& misplaced, std::span<const SurfacePoint> sensors) {
    std::vector<std::string> out;
    const auto tell = [&](const std::vector<std::size_t>& which, const char* one, const char* several) {
        if (which.empty()) return;
        const Point& x = sensors[which.front()].x;
        out.push_back(
            fmt::format("{} of {} sensors {}; the first is sensor {} (counted from 0) at {:.4g}, {:.4g}, {:.4g}",
                        which.size(), sensors.size(), which.size() == 1 ? one : several, which.front(), x.x, x.y, x.z));
    };
    tell(misplaced.outdoors, "lies outdoors, below the open sky, but counts as the others",
         "lie outdoors, below the open sky, but count like the others");
    tell(misplaced.behind, "sees mostly backs of faces, as below a floor or inside of a body",
         "see mostly backs of faces, as below a floor or inside of a body");
    return out;
}

}  // namespace exitance
