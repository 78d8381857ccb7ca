#include "exitance/io/report/isolux_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/io/report/grid_contours.hpp"

namespace exitance {
namespace {

constexpr double sheet = 180;              ///< Limit of the plan's longer side, mm.
constexpr double around = 8, header = 16;  ///< Margins around the plan, and space for its title, mm.
constexpr Rgb wall{40, 40, 44}, lamp{200, 120, 0}, pale{120, 120, 126};

/// Maps points of the scene to the sheet.
struct Plan {
    Point origin;
    Normal u, v, n;
    double to_mm = 1;
    Vec2 corner;  ///< Position of the origin on the sheet.
    int scale = 1;

    Vec2 at(const Point& p) const {
        return {corner.x + to_mm * dot(p - origin, u), corner.y - to_mm * dot(p - origin, v)};
    }
};

int round_scale(double length) {
    for (int power = 1; power <= 1000; power *= 10)
        for (const int step : {5, 10, 20, 25})
            if (1000 * length / (step * power) <= sheet) return step * power;
    return 50000;
}

void draw_scene(const Scene& scene, const Plan& plan, Drawing& out) {
    Drawing::Line cut{{}, wall, 0.5};
    cut.pieces = true;
    for (const SurfaceId s : scene.surfaces().ids())
        for (const auto& [a, b] : section_of(scene.outline(s), plan.origin, plan.n))
            cut.points.push_back(plan.at(a)), cut.points.push_back(plan.at(b));
    if (!cut.points.empty()) out.lines.push_back(std::move(cut));
    for (const SurfaceId s : scene.emitters()) {
        Drawing::Line line{{}, lamp, 0.25};
        line.dashed = line.closed = true;
        for (const Point& p : scene.outline(s)) line.points.push_back(plan.at(p));
        out.lines.push_back(std::move(line));
    }
}

void draw_points(const ReportFigures::Grid& grid, const Plan& plan, Drawing& out) {
    const GridLight& light = *grid.light;
    constexpr double min_cell = 4.5;  // mm; fits a number of three digits
    if (plan.to_mm * std::min(light.step_u, light.step_v) < min_cell) return;
    for (std::size_t i = 0; i < light.points.size(); ++i)
        if (light.is_open[i])
            out.texts.push_back({plan.at(light.points[i]), short_figure(grid.values[i]), 1.6, pale, true, false});
}

void draw_lines(const ReportFigures::Grid& grid, const LightUnit& unit, const Plan& plan, Drawing& out) {
    constexpr int fine = 160;
    const GridLight& light = *grid.light;
    const Picture points = picture_of_points(light, grid.values);
    const ColourScale scale = make_colour_scale(points, unit.is_lux() ? Quantity::illuminance : Quantity::irradiance);
    const Picture smooth = smooth_picture(points, fine);
    const Vec2 size{plan.to_mm * light.columns * light.step_u, plan.to_mm * light.rows * light.step_v};
    const Vec2 low = plan.at(light.plane.origin + light.plane.margin * (plan.u + plan.v));
    const std::vector<std::string> names = scale.names();
    for (std::size_t i = 0; i < scale.steps.size(); ++i) {
        const std::vector<ContourSegment> segments = contour(smooth, size, scale.steps[i]);
        if (segments.empty()) continue;
        constexpr double max_brightness = 0.85;  // the palette's brightest colours would not be visible on white
        const double place =
            scale.steps.size() > 1 ? static_cast<double>(i) / static_cast<double>(scale.steps.size() - 1) : 0;
        const double value = scale.steps.front() + max_brightness * place * (scale.steps.back() - scale.steps.front());
        Drawing::Line line{{}, scale.colour(value), 0.3};
        line.pieces = true;
        for (const ContourSegment& s : segments)
            for (const Vec2& p : {s.a, s.b}) line.points.push_back({low.x + p.x, low.y - size.y + p.y});
        out.texts.push_back({line.points[line.points.size() / 2], names[i], 2.4, {0, 0, 0}, true, true});
        out.lines.push_back(std::move(line));
    }
}

/// Draws a bar with a round length in metres.
void draw_scale_bar(const Plan& plan, Drawing& out) {
    double length = 1;
    while (length * plan.to_mm > 50) length /= 2;
    while (length * plan.to_mm < 10) length *= 2;
    const double y = out.size.y - around / 2, x = around;
    out.clip_hi.y = out.size.y;
    out.lines.push_back({{{x, y}, {x + length * plan.to_mm, y}}, wall, 0.6, false, false, false});
    out.texts.push_back(
        {{x + length * plan.to_mm + 2, y}, fmt::format("{:g} m    1:{}", length, plan.scale), 2.5, wall, false, false});
}

}  // namespace

std::vector<std::pair<Point, Point>> section_of(std::span<const Point> outline, const Point& origin, const Normal& n) {
    std::vector<Point> crossings;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point &p = outline[i], &q = outline[(i + 1) % outline.size()];
        const double a = dot(p - origin, n), b = dot(q - origin, n);
        if ((a > 0) != (b > 0)) crossings.push_back(p + a / (a - b) * (q - p));
    }
    if (crossings.empty()) return {};
    // In order along the line of the section, towards the crossing that is farthest from the first one.
    const Point first = crossings.front();
    const Point last = *std::max_element(crossings.begin(), crossings.end(), [&](const Point& a, const Point& b) {
        return norm(a - first) < norm(b - first);
    });
    std::sort(crossings.begin(), crossings.end(), [&](const Point& a, const Point& b) {
        return dot(a - first, last - first) < dot(b - first, last - first);
    });
    std::vector<std::pair<Point, Point>> out;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) out.emplace_back(crossings[i], crossings[i + 1]);
    return out;
}

Drawing isolux_plan(const ReportFigures::Grid& grid, const LightUnit& unit, const Scene& scene) {
    const GridLight& light = *grid.light;
    const double length = norm(light.plane.u), width = norm(light.plane.v);
    Plan plan;
    plan.origin = light.plane.origin, plan.u = normalized(light.plane.u), plan.n = light.n;
    plan.v = cross(plan.n, plan.u), plan.scale = round_scale(std::max(length, width)), plan.to_mm = 1000.0 / plan.scale;
    Drawing out;
    out.size = {plan.to_mm * length + 2 * around, plan.to_mm * width + 2 * around + header};
    out.size.x = std::max(out.size.x, 90.0);  // wide enough for the title, mm
    plan.corner = {around, header + around + plan.to_mm * width};
    out.clip_lo = {around / 2, header + around / 2}, out.clip_hi = {out.size.x - around / 2, out.size.y};
    draw_scene(scene, plan, out);
    draw_points(grid, plan, out);
    draw_lines(grid, unit, plan, out);
    draw_scale_bar(plan, out);
    const std::string symbol_text = symbol(unit);
    out.texts.push_back({{around, 7}, light.name.empty() ? "Measuring plane" : light.name, 4, {0, 0, 0}, false, false});
    out.texts.push_back(
        {{around, 13},
         fmt::format("{}m {} {}, U0 {}, Ud {}", light.is_cylindrical ? "Ez, " : "E", figure(grid.levels.mean),
                     symbol_text, figure(grid.levels.uniformity()), figure(grid.levels.diversity())),
         3,
         wall,
         false,
         false});
    return out;
}

}  // namespace exitance
