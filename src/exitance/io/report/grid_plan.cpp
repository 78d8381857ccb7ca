#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "exitance/io/report/grid_contours.hpp"
#include "exitance/io/report/isolux_plan.hpp"
#include "exitance/io/report/report_figures.hpp"

namespace exitance {
namespace {

constexpr double plan_width = 640;  ///< Length of the longer side, in SVG units.

Quantity quantity(const LightUnit& unit) {
    return unit.is_lux() ? Quantity::illuminance : Quantity::irradiance;
}

/// Place of a line's label: the one that is farthest from the numbers in the middles of the cells.
Vec2 place_of_label(std::span<const ContourSegment> segments, Vec2 cell) {
    const auto from_middle = [](double x, double width) { return width * (x / width - std::floor(x / width) - 0.5); };
    const auto distance = [&](const ContourSegment& s) {
        return std::hypot(from_middle(s.a.x, cell.x), from_middle(s.a.y, cell.y));
    };
    return std::max_element(segments.begin(), segments.end(),
                            [&](const auto& a, const auto& b) { return distance(a) < distance(b); })
        ->a;
}

std::string lines(const Picture& picture, Vec2 plan, Vec2 cell, const ColourScale& scale) {
    std::string svg;
    for (std::size_t i = 0; i < scale.steps.size(); ++i) {
        const std::vector<ContourSegment> segments = contour(picture, plan, scale.steps[i]);
        if (segments.empty()) continue;
        std::string path;
        for (const ContourSegment& s : segments)
            fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}L{:.1f} {:.1f}", s.a.x, s.a.y, s.b.x, s.b.y);
        const Vec2 label = place_of_label(segments, cell);
        svg += fmt::format("<path class=\"line\" d=\"{}\"/><text class=\"level\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                           path, label.x, label.y + 4, scale.names()[i]);
    }
    return svg;
}

/// Size of the letters of the numbers in cells, in SVG units.
double size_of_numbers(Vec2 cell) {
    constexpr double smallest = 11, largest = 18;            // letter sizes, derived from print on A4
    constexpr double per_width = 1.0 / 3, per_height = 0.5;  // derived from the width of four digits
    return std::clamp(std::min(per_width * cell.x, per_height * cell.y), smallest, largest);
}

/// Prints the value of every point if cells are wide enough.
std::string values(const ReportFigures::Grid& grid, Vec2 cell) {
    constexpr double min_cell_width = 34;
    const GridLight& light = *grid.light;
    if (cell.x < min_cell_width) return "";
    const double size = size_of_numbers(cell);
    std::string svg;
    for (int y = 0; y < light.rows; ++y)
        for (int x = 0; x < light.columns; ++x) {
            const auto i = static_cast<std::size_t>(y * light.columns + x);
            if (!light.is_open[i]) continue;
            svg += fmt::format("<text class=\"point\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", (x + 0.5) * cell.x,
                               (light.rows - y - 0.5) * cell.y + 0.35 * size, short_figure(grid.values[i]));
        }
    return svg;
}

/// Draws the surroundings of a plane: walls and objects where the plane cuts them, and the outlines of furniture below
/// it.
std::string surroundings(const GridLight& light, const Scene& scene, double to_plan, Vec2 plan) {
    const Point low = light.points.empty() ? light.plane.origin
                                           : light.points[0] - 0.5 * light.step_u * normalized(light.plane.u) -
                                                 0.5 * light.step_v * normalized(light.plane.v);
    const Vec3 u = normalized(light.plane.u), v = normalized(light.plane.v);
    const auto line = [&](const Point& a, const Point& b) {
        return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", to_plan * dot(a - low, u),
                           plan.y - to_plan * dot(a - low, v), to_plan * dot(b - low, u),
                           plan.y - to_plan * dot(b - low, v));
    };
    std::string cut, below;
    for (const SurfaceId s : scene.surfaces().ids())
        for (const auto& [a, b] : section_of(scene.outline(s), light.plane.origin, light.n)) cut += line(a, b);
    constexpr double highest = 1.2,
                     parallel = 0.999;  // metres below the plane, derived from furniture; cosine of a slope of 4%
    for (const Region& region : scene.regions()) {
        const double depth = -dot(region.loops[0][0] - light.plane.origin, light.n);
        // The floor itself is the face that is larger than the plane.
        if (dot(region.plane.n, light.n) < parallel || depth < 0 || depth > highest ||
            region.area > norm(light.plane.u) * norm(light.plane.v) / 2)
            continue;
        for (const std::vector<Point>& loop : region.loops)
            for (std::size_t i = 0; i < loop.size(); ++i) below += line(loop[i], loop[(i + 1) % loop.size()]);
    }
    return fmt::format("<path class=\"below\" d=\"{}\"/><path class=\"cut\" d=\"{}\"/>", below, cut);
}

std::string legend(const ColourScale& scale, const LightUnit& unit) {
    std::string html;
    const std::vector<std::string> names = scale.names();
    for (std::size_t band = 0; band < scale.band_count(); ++band) {
        // A picture of one pixel gives the colour.
        const double value = 0.5 * (scale.steps[band] + scale.steps[band + 1]);
        const Picture pixel{{1, 1}, {lit_pixel(value)}};
        const Image colour = false_colour_image(pixel, quantity(unit), scale);
        html += fmt::format("<span><i style=\"background:rgb({},{},{})\"></i>{} to {}</span> ", colour.rgb[0],
                            colour.rgb[1], colour.rgb[2], names[band], names[band + 1]);
    }
    return fmt::format("<p class=\"legend\">{} {}</p>", symbol(unit), html);
}

}  // namespace

std::string grid_plan(const ReportFigures::Grid& grid, const LightUnit& unit, const Scene& scene) {
    const GridLight& light = *grid.light;
    const Picture points = picture_of_points(light, grid.values);
    const ColourScale scale = make_colour_scale(points, quantity(unit));
    constexpr int picture_width = 480, contour_width = 160;
    const Result<std::string> picture =
        data_address(false_colour_image(smooth_picture(points, picture_width), quantity(unit), scale));
    const double width = light.columns * light.step_u, height = light.rows * light.step_v;
    const double to_plan = plan_width / std::max(width, height);
    const Vec2 cell{light.step_u * to_plan, light.step_v * to_plan};
    const Vec2 plan{width * to_plan, height * to_plan};
    const double edge = 4 + to_plan * light.plane.margin;  // shows the walls at the border
    const Picture coarse = smooth_picture(points, contour_width);
    return fmt::format(
        "<svg class=\"plan\" viewBox=\"{8:.1f} {8:.1f} {0:.1f} {1:.1f}\" "
        "style=\"max-width:{9:.0f}px;--size:{10:.1f}px\" role=\"img\" "
        "aria-label=\"plan of the light\"><image href=\"{2}\" width=\"{3:.1f}\" height=\"{4:.1f}\" "
        "preserveAspectRatio=\"none\"/>{5}{6}</svg>{7}",
        plan.x + 2 * edge, plan.y + 2 * edge, picture ? *picture : "", plan.x, plan.y,
        surroundings(light, scene, to_plan, plan) + lines(coarse, plan, cell, scale), values(grid, cell),
        legend(scale, unit), -edge, shown_width(plan.x + 2 * edge, plan.y + 2 * edge), size_of_numbers(cell));
}

}  // namespace exitance
