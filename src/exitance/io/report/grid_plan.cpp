#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "exitance/io/report/report_figures.hpp"

namespace exitance {
namespace {

constexpr double plan_width = 640;  ///< Of the longer side, in the picture's own units.

Quantity quantity(const LightUnit& unit) {
    return unit.is_lux() ? Quantity::illuminance : Quantity::irradiance;
}

Pixel lit(const Spectrum& irradiance) {
    Pixel pixel;
    pixel.irradiance = irradiance, pixel.front = 1, pixel.region = RegionId(0);
    return pixel;
}

/// The points of a grid as a picture of one pixel each, the first row at the bottom.
Picture picture_of_points(const GridLight& light, const std::vector<double>& values) {
    Picture picture{{light.columns, light.rows}, {}};
    for (int row = light.rows - 1; row >= 0; --row)
        for (int column = 0; column < light.columns; ++column) {
            const auto i = static_cast<std::size_t>(row * light.columns + column);
            picture.pixels.push_back(light.is_open[i] ? lit(Spectrum(values[i])) : Pixel());
        }
    return picture;
}

/// The same with light between the points, by bilinear interpolation, about `wanted` pixels wide; what hides a point
/// hides its cell.
Picture smooth_picture(const Picture& points, int wanted) {
    const int w = points.size.width, h = points.size.height;
    const int fine = std::max(1, wanted / std::max(w, h));
    Picture out{{w * fine, h * fine}, {}};
    const auto at = [&](int x, int y) -> const Pixel& {
        return points.pixels[static_cast<std::size_t>(std::clamp(y, 0, h - 1) * w + std::clamp(x, 0, w - 1))];
    };
    for (int y = 0; y < out.size.height; ++y)
        for (int x = 0; x < out.size.width; ++x) {
            const double u = (x + 0.5) / fine - 0.5, v = (y + 0.5) / fine - 0.5;
            const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
            Spectrum sum;
            double weight = 0;
            for (int b = 0; b < 2; ++b)
                for (int a = 0; a < 2; ++a) {
                    const double share = (a == 0 ? i + 1 - u : u - i) * (b == 0 ? j + 1 - v : v - j);
                    if (at(i + a, j + b).front == 0) continue;
                    sum += share * at(i + a, j + b).irradiance, weight += share;
                }
            const bool hidden = at(x / fine, y / fine).front == 0;
            out.pixels.push_back(hidden || weight == 0 ? Pixel() : lit(sum / weight));
        }
    return out;
}

/// A piece of a line of equal light, in the plan's units.
struct Segment {
    Vec2 a, b;
};

/// Lines of equal light in a picture that fills a plan: marching squares, [Lorensen87] in the plane.
class Contours {
  public:
    Contours(const Picture& picture, Vec2 plan)
        : picture_(picture), cell_{plan.x / picture.size.width, plan.y / picture.size.height} {}

    std::vector<Segment> at(double level) const {
        std::vector<Segment> out;
        for (int y = 0; y + 1 < picture_.size.height; ++y)
            for (int x = 0; x + 1 < picture_.size.width; ++x) add(x, y, level, out);
        return out;
    }

  private:
    const Pixel& pixel(const int* at) const {
        return picture_.pixels[static_cast<std::size_t>(at[1] * picture_.size.width + at[0])];
    }
    double value(const int* at) const { return mean(pixel(at).irradiance); }

    void add(int x, int y, double level, std::vector<Segment>& out) const {
        const int corner[4][2] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
        for (const auto& c : corner)
            if (pixel(c).front == 0) return;
        Vec2 crossings[4];
        std::size_t count = 0;
        for (int k = 0; k < 4; ++k) {
            const int *p = corner[k], *q = corner[(k + 1) % 4];
            const double a = value(p) - level, b = value(q) - level;
            if ((a >= 0) == (b >= 0)) continue;
            const double s = a / (a - b);
            crossings[count++] = {(p[0] + s * (q[0] - p[0]) + 0.5) * cell_.x,
                                  (p[1] + s * (q[1] - p[1]) + 0.5) * cell_.y};
        }
        for (std::size_t k = 0; k + 1 < count; k += 2) out.push_back({crossings[k], crossings[k + 1]});
    }

    const Picture& picture_;
    Vec2 cell_;
};

std::string lines(const Contours& contours, const ColourScale& scale) {
    std::string svg;
    for (std::size_t i = 0; i < scale.steps.size(); ++i) {
        const std::vector<Segment> segments = contours.at(scale.steps[i]);
        if (segments.empty()) continue;
        std::string path;
        for (const Segment& s : segments)
            fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}L{:.1f} {:.1f}", s.a.x, s.a.y, s.b.x, s.b.y);
        const Segment& middle = segments[segments.size() / 2];
        svg += fmt::format("<path class=\"line\" d=\"{}\"/><text class=\"level\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                           path, middle.a.x, middle.a.y + 4, scale.names()[i]);
    }
    return svg;
}

/// Every point with its value, where there is room for that.
std::string values(const ReportFigures::Grid& grid, Vec2 cell) {
    constexpr double least_width = 34;
    const GridLight& light = *grid.light;
    if (cell.x < least_width) return "";
    std::string svg;
    for (int y = 0; y < light.rows; ++y)
        for (int x = 0; x < light.columns; ++x) {
            const auto i = static_cast<std::size_t>(y * light.columns + x);
            if (!light.is_open[i]) continue;
            svg += fmt::format("<text class=\"point\" x=\"{:.1f}\" y=\"{:.1f}\">{:.3g}</text>", (x + 0.5) * cell.x,
                               (light.rows - y - 0.5) * cell.y + 3, grid.values[i]);
        }
    return svg;
}

std::string legend(const ColourScale& scale, const LightUnit& unit) {
    std::string html;
    const std::vector<std::string> names = scale.names();
    for (std::size_t band = 0; band < scale.band_count(); ++band) {
        // A picture of one pixel tells the colour.
        const double value = 0.5 * (scale.steps[band] + scale.steps[band + 1]);
        const Picture pixel{{1, 1}, {lit(Spectrum(value))}};
        const Image colour = false_colour_image(pixel, quantity(unit), scale);
        html += fmt::format("<span><i style=\"background:rgb({},{},{})\"></i>{} to {}</span> ", colour.rgb[0],
                            colour.rgb[1], colour.rgb[2], names[band], names[band + 1]);
    }
    return fmt::format("<p class=\"legend\">{} {}</p>", symbol(unit), html);
}

}  // namespace

std::string grid_plan(const ReportFigures::Grid& grid, const LightUnit& unit) {
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
    const Picture coarse = smooth_picture(points, contour_width);
    return fmt::format(
        "<svg class=\"plan\" viewBox=\"-1 -1 {0:.1f} {1:.1f}\" style=\"max-width:{0:.0f}px\" role=\"img\" "
        "aria-label=\"plan of the light\"><image href=\"{2}\" width=\"{3:.1f}\" height=\"{4:.1f}\" "
        "preserveAspectRatio=\"none\"/>{5}{6}</svg>{7}",
        plan.x + 2, plan.y + 2, picture ? *picture : "", plan.x, plan.y, values(grid, cell),
        lines(Contours(coarse, plan), scale), legend(scale, unit));
}

}  // namespace exitance
