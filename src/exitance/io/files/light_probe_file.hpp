#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/measure/probes/light_probe.hpp"

namespace exitance {

/// A grid of points along the axes of the scene. The point (i, j, k) is number i + nx (j + ny k).
struct ProbeGrid {
    Point origin;  ///< Point (0, 0, 0), metres.
    Vec3 step;     ///< Distances along x, y and z, metres.
    std::array<int, 3> count{1, 1, 1};

    std::size_t size() const;
    std::vector<Point> points() const;
};

/// Reads the columns x, y, z of a CSV file, or the first three numbers of each line of a .pts file; metres.
Result<std::vector<Point>> load_points(const std::string& path);

/// Light probes, and how they were made.
struct LightProbeTable {
    std::span<const Point> points;
    std::span<const LightProbe> probes;
    std::optional<ProbeGrid> grid;
    unsigned rays = 0;
    bool is_photometric = false;  ///< Light is in lumens: radiance is in cd/m^2.
};

/// Writes light probes as JSON or, if the path ends in .h5, as HDF5. The file appears whole or not at all.
Result<void> write_light_probes(const std::string& path, const LightProbeTable& table);

}  // namespace exitance
