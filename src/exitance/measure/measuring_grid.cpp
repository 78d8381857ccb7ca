#include "exitance/measure/measuring_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "exitance/base/parallel.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

/// Evenly spaced horizontal directions.
std::vector<Normal> around() {
    std::vector<Normal> out;
    for (int i = 0; i < cylinder_planes; ++i) {
        const double a = 2 * pi * i / cylinder_planes;
        out.push_back({std::cos(a), std::sin(a), 0});
    }
    return out;
}

}  // namespace

const char* name_of(PlaneZone zone) {
    switch (zone) {
        case PlaneZone::task:
            return "task";
        case PlaneZone::surroundings:
            return "surroundings";
        case PlaneZone::background:
            return "background";
    }
    return "";
}

double en_12464_spacing(double length, double width) {
    const double longer = std::max(length, width), shorter = std::min(length, width);
    const double d = longer >= 2 * shorter ? shorter : longer;
    return std::min(10.0, 0.2 * std::pow(5, std::log10(d)));
}

Result<GridLight> make_grid(const MeasuringPlane& plane) {
    constexpr double max_points = 100000;
    const auto refuse = [](const std::string& message, const std::string& hint) {
        return Error{ErrorCode::usage, message, "--grid", hint};
    };
    const double length = norm(plane.u), width = norm(plane.v);
    const Vec3 normal = cross(plane.u, plane.v);
    if (!(norm(normal) > 1e-9 * length * width) || !is_finite(plane.origin))
        return refuse("the plane has no area", "give two edges that are not parallel, metres");
    if (!(plane.margin >= 0 && 2 * plane.margin < std::min(length, width)))
        return refuse("a margin of " + std::to_string(plane.margin) + " m leaves nothing of the plane",
                      "choose less than half of its width");
    GridLight grid;
    grid.plane = plane, grid.n = normalized(normal);
    const double inner_u = length - 2 * plane.margin, inner_v = width - 2 * plane.margin;
    const double spacing = plane.spacing > 0 ? plane.spacing : en_12464_spacing(inner_u, inner_v);
    constexpr double rounding = 1e-9;
    const double columns = std::max(1.0, std::ceil(inner_u / spacing - rounding));
    const double rows = std::max(1.0, std::ceil(inner_v / spacing - rounding));
    if (!(columns * rows <= max_points))
        return refuse("the grid has more than 100000 points", "choose a larger spacing");
    grid.columns = static_cast<int>(columns), grid.rows = static_cast<int>(rows);
    grid.step_u = inner_u / columns, grid.step_v = inner_v / rows;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            grid.points.push_back(plane.origin + (plane.margin + (column + 0.5) * grid.step_u) / length * plane.u +
                                  (plane.margin + (row + 0.5) * grid.step_v) / width * plane.v);
    grid.irradiance.resize(grid.points.size());
    grid.is_open.resize(grid.points.size());
    return grid;
}

void measure(const RadiosityFunction& light, GridLight& grid, Progress& progress, const StopRequest& stop) {
    progress.phase("measure");
    const std::size_t count = grid.points.size();
    std::vector<std::uint8_t> open(count);
    // Points on walls are measured on the side of the plane's middle, for all directions.
    const Point middle = grid.plane.origin + 0.5 * (grid.plane.u + grid.plane.v);
    std::vector<Point> places = grid.points;
    parallel_for(count, 32, [&](std::size_t i) {
        if (!grid.counts.empty() && !grid.counts[i]) return;
        const MeasuredPlace place = light.places().find(grid.points[i], grid.n, &middle);
        places[i] = place.x;
        open[i] = is_in_open(light.stage(), place.x, grid.n, place.region);
    });
    std::copy(open.begin(), open.end(), grid.is_open.begin());
    const std::vector<Normal> normals = grid.is_cylindrical ? around() : std::vector<Normal>{grid.n};
    const std::size_t slice = 2048 / normals.size();
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < count; ++i)
        if (grid.counts.empty() || grid.counts[i]) chosen.push_back(i);
    for (std::size_t first = 0; first < chosen.size() && !stop.requested(); first += slice) {
        progress.advance(static_cast<double>(first) / static_cast<double>(chosen.size()));
        const std::span<const std::size_t> part =
            std::span(chosen).subspan(first, std::min(slice, chosen.size() - first));
        std::vector<ProbePoint> points;
        for (const std::size_t i : part)
            for (const Normal& n : normals) points.push_back({places[i], n});
        const std::vector<Light> found = light.at_until(stop, points);
        for (std::size_t k = 0; k < found.size(); ++k)
            grid.irradiance[part[k / normals.size()]] +=
                normals.size() > 1 ? found[k].irradiance / static_cast<double>(normals.size()) : found[k].irradiance;
    }
}

Levels levels_of(std::span<const double> values) {
    Levels out;
    out.count = values.size();
    if (values.empty()) return out;
    out.least = *std::min_element(values.begin(), values.end());
    out.most = *std::max_element(values.begin(), values.end());
    for (const double value : values) out.mean += value / static_cast<double>(values.size());
    return out;
}

}  // namespace exitance
