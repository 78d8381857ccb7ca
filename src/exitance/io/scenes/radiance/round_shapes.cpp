#include "exitance/io/scenes/radiance/round_shapes.hpp"

#include <cmath>

#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

constexpr int n = sides_of_round;

/// Points on a circle in the plane of u and v.
std::vector<Point> circle(const Point& centre, const Frame& frame, double radius) {
    std::vector<Point> out;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * pi * i / n;
        out.push_back(centre + frame.to_world(radius * std::cos(a), radius * std::sin(a), 0));
    }
    return out;
}

/// Adds the facets between two circles with the same number of points. Either may be a single point, its first.
void add_band(const std::vector<Point>& lower, const std::vector<Point>& upper, bool lower_is_point,
              bool upper_is_point, Facets& out) {
    for (std::size_t i = 0; i < lower.size(); ++i) {
        const std::size_t j = (i + 1) % lower.size();
        std::vector<Point> facet = {lower[i]};
        if (!lower_is_point) facet.push_back(lower[j]);
        facet.push_back(upper[j]);
        if (!upper_is_point) facet.push_back(upper[i]);
        out.push_back(std::move(facet));
    }
}

}  // namespace

Facets ring_facets(const Point& centre, const Normal& normal, double inner, double outer) {
    // Makes the polygon's area that of the circle.
    const double wider = std::sqrt(pi / (0.5 * n * std::sin(2 * pi / n)));
    const Frame frame(normal);
    if (inner <= 0) return {circle(centre, frame, wider * outer)};
    Facets out;
    add_band(circle(centre, frame, wider * outer), circle(centre, frame, wider * inner), false, false, out);
    return out;
}

Facets cone_facets(const Point& from, const Point& to, double radius_from, double radius_to) {
    const double wider = pi / (n * std::sin(pi / n));  // makes the polygon's perimeter that of the circle
    const Frame frame(normalized(to - from));
    Facets out;
    add_band(circle(from, frame, wider * radius_from), circle(to, frame, wider * radius_to), radius_from <= 0,
             radius_to <= 0, out);
    return out;
}

Facets sphere_facets(const Point& centre, double radius) {
    Facets out;
    const Frame frame({0, 0, 1});
    constexpr int rows = n / 2;
    std::vector<Point> below = circle({0, 0, -1}, frame, 0);
    for (int i = 1; i <= rows; ++i) {
        const double a = pi * i / rows;
        std::vector<Point> above = circle({0, 0, -std::cos(a)}, frame, i == rows ? 0 : std::sin(a));
        add_band(below, above, i == 1, i == rows, out);
        below = std::move(above);
    }
    double area = 0;
    for (const auto& facet : out) area += norm(area_vector(facet));
    const double wider = radius * std::sqrt(4 * pi / area);
    for (auto& facet : out)
        for (Point& p : facet) p = centre + wider * p;
    return out;
}

}  // namespace exitance
