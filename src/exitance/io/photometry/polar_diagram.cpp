#include "exitance/io/photometry/polar_diagram.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iterator>

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

std::string escaped(const std::string& text) {
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

/// Draws both halves of a plane as one closed curve.
std::string curve(const Photometry& p, const Vec3& towards, double scale) {
    std::string path;
    for (int i = -180; i <= 180; ++i) {
        const double a = i * degree,
                     value = p.intensity({std::sin(a) * towards.x, std::sin(a) * towards.y, -std::cos(a)});
        fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", i == -180 ? "M" : "L",
                       middle + scale * value * std::sin(a), middle + scale * value * std::cos(a));
    }
    return path + "Z";
}

}  // namespace

std::string polar_diagram(const Photometry& p) {
    const double to_unit = p.lamp_lumens ? 1000 / *p.lamp_lumens : 1;
    const double step = round_step(p.largest() * to_unit);
    const int circles = std::max(1, static_cast<int>(std::ceil(p.largest() * to_unit / step)));
    const double pixels = radius / (circles * step);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 520 580\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n"
        "<rect width=\"520\" height=\"580\" fill=\"#fff\"/>\n<g fill=\"none\" stroke=\"#ccc\">\n");
    for (int i = 1; i <= circles; ++i)
        svg += fmt::format("<circle cx=\"{0}\" cy=\"{0}\" r=\"{1:.2f}\"/>\n", middle, radius * i / circles);
    for (int a = 0; a < 360; a += 15)
        svg += fmt::format("<path d=\"M{0} {0}L{1:.2f} {2:.2f}\"/>\n", middle, middle + radius * std::sin(a * degree),
                           middle + radius * std::cos(a * degree));
    svg += "</g>\n<g text-anchor=\"middle\" fill=\"#555\">\n";
    for (int a = -165; a <= 180; a += 15)
        if (a % 30 == 0)
            svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}&#176;</text>\n",
                               middle + (radius + 16) * std::sin(a * degree),
                               middle + (radius + 16) * std::cos(a * degree) + 4, std::abs(a));
    for (int i = 1; i <= circles; ++i)
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{:g}</text>\n", middle, middle + radius * i / circles - 3,
                           step * i);
    svg += fmt::format(
        "</g>\n<g fill=\"none\" stroke-width=\"2\"><path stroke=\"#c0392b\" d=\"{}\"/>\n"
        "<path stroke=\"#2563a8\" stroke-dasharray=\"7 4\" d=\"{}\"/></g>\n",
        curve(p, {1, 0, 0}, pixels * to_unit), curve(p, {0, 1, 0}, pixels * to_unit));
    svg += fmt::format(
        "<text x=\"20\" y=\"535\">{}</text>\n<text x=\"20\" y=\"555\" fill=\"#c0392b\">C0 - C180 (right: C0)</text>\n"
        "<text x=\"200\" y=\"555\" fill=\"#2563a8\">C90 - C270 (right: C90)</text>\n"
        "<text x=\"500\" y=\"535\" text-anchor=\"end\">{}</text>\n</svg>\n",
        escaped(std::filesystem::path(p.file).filename().string()),
        p.lamp_lumens ? "cd per 1000 lm of the lamps" : "cd");
    return svg;
}

}  // namespace exitance
