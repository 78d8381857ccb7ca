#include "exitance/io/photometry/polar_diagram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "exitance/io/photometry/luminaire_type.hpp"

namespace exitance {
namespace {

constexpr double radius = 220, middle = 260;

/// A step of 1, 2 or 5 times a power of ten, about a quarter of `most`.
double round_step(double most) {
    const double power = std::pow(10, std::floor(std::log10(most / 4)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (most / (factor * power) <= 5) return factor * power;
    return 10 * power;
}

std::string escaped_ascii(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '&')
            out += "&amp;";
        else
            out += static_cast<unsigned char>(c) < 0x80 ? c : '?';
    }
    return out;
}

/// Circles of a diagram: their number, and the intensity between two of them.
struct Circles {
    int count = 1;
    double step = 1;
};

Circles circles_for(const IntensityCurves& curves) {
    double most = 0;
    for (const std::vector<double>* curve : {&curves.c0, &curves.c90})
        for (const double value : *curve) most = std::max(most, value);
    if (!(most > 0)) return {};
    const double step = round_step(most);
    return {std::max(1, static_cast<int>(std::ceil(most / step))), step};
}

/// Draws both halves of a plane as one closed curve.
std::string curve(const std::vector<double>& values, double scale) {
    std::string path;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double a = (static_cast<int>(i) - IntensityCurves::last) * degree;
        fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", i == 0 ? "M" : "L",
                       middle + scale * values[i] * std::sin(a), middle + scale * values[i] * std::cos(a));
    }
    return path + "Z";
}

/// Draws circles, lines at steps of `step` degrees, and both curves with lines of a width.
std::string web_and_curves(const IntensityCurves& curves, const Circles& circles, int step, double width) {
    std::string svg = fmt::format("<g fill=\"none\" stroke=\"#ccc\" stroke-width=\"{}\">\n", 0.5 * width);
    for (int i = 1; i <= circles.count; ++i)
        svg += fmt::format("<circle cx=\"{0}\" cy=\"{0}\" r=\"{1:.2f}\"/>\n", middle, radius * i / circles.count);
    for (int a = 0; a < 360; a += step)
        svg += fmt::format("<path d=\"M{0} {0}L{1:.2f} {2:.2f}\"/>\n", middle, middle + radius * std::sin(a * degree),
                           middle + radius * std::cos(a * degree));
    const double pixels = radius / (circles.count * circles.step);
    return svg + fmt::format(
                     "</g>\n<g fill=\"none\" stroke-width=\"{0}\"><path stroke=\"#c0392b\" d=\"{1}\"/>\n"
                     "<path stroke=\"#2563a8\" stroke-dasharray=\"{2} {0}\" d=\"{3}\"/></g>\n",
                     width, curve(curves.c0, pixels), 3 * width, curve(curves.c90, pixels));
}

}  // namespace

std::string polar_diagram(const Photometry& p) {
    constexpr int step_of_lines = 15, step_of_names = 30;  // degrees
    const IntensityCurves curves = intensity_curves(p);
    const Circles circles = circles_for(curves);
    std::string svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 520 580\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n"
        "<rect width=\"520\" height=\"580\" fill=\"#fff\"/>\n" +
        web_and_curves(curves, circles, step_of_lines, 2) + "<g text-anchor=\"middle\" fill=\"#555\">\n";
    for (int a = -150; a <= 180; a += step_of_names)
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}&#176;</text>\n",
                           middle + (radius + 16) * std::sin(a * degree),
                           middle + (radius + 16) * std::cos(a * degree) + 4, std::abs(a));
    for (int i = 1; i <= circles.count; ++i)
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{:g}</text>\n", middle,
                           middle + radius * i / circles.count - 3, circles.step * i);
    svg += fmt::format(
        "</g>\n<text x=\"20\" y=\"535\">{}</text>\n<text x=\"20\" y=\"555\" fill=\"#c0392b\">C0 - C180 (right: "
        "C0)</text>\n"
        "<text x=\"200\" y=\"555\" fill=\"#2563a8\">C90 - C270 (right: C90)</text>\n"
        "<text x=\"500\" y=\"535\" text-anchor=\"end\">{}</text>\n</svg>\n",
        escaped_ascii(std::filesystem::path(p.file).filename().string()),
        curves.is_per_kilolumen ? "cd per 1000 lm of the lamps" : "cd");
    return svg;
}

std::string small_polar_diagram(const IntensityCurves& curves) {
    constexpr int step_of_lines = 30;     // degrees
    constexpr double width_of_lines = 7;  // line width; derived from pictures a seventh of the diagram's size
    const Circles circles = circles_for(curves);
    return fmt::format(
        "<svg class=\"polar\" viewBox=\"30 30 460 520\" role=\"img\" aria-label=\"distribution of intensity\">{}"
        "<text x=\"260\" y=\"540\" font-size=\"52\" text-anchor=\"middle\">{:g} {}</text></svg>",
        web_and_curves(curves, circles, step_of_lines, width_of_lines), circles.count * circles.step,
        curves.is_per_kilolumen ? "cd/klm" : "cd");
}

}  // namespace exitance
