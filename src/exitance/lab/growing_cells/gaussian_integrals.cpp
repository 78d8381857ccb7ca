#include "exitance/lab/growing_cells/gaussian_integrals.hpp"

#include <cmath>

#include "exitance/base/quadrature.hpp"

namespace exitance {
namespace {

constexpr double right_angle = 1e-9;  ///< |cos| below which an angle counts as a right angle.

/// int_0^length exp(-(s - c)^2 / d^2) ds
double on_line(double c, double length, double d) {
    return 0.5 * std::sqrt(pi) * d * (std::erf((length - c) / d) - std::erf(-c / d));
}

/// Integral over the triangle of the foot and an edge from a to b (relative to the foot), with the sign of the edge's
/// orientation.
double beside_edge(const Vec3& a, const Vec3& b, const Normal& n, double d) {
    const Vec3 along = b - a;
    const double length = norm(along);
    if (!(length > 0)) return 0;
    const double s_a = dot(a, along) / length, s_b = dot(b, along) / length;
    const double distance = dot(n, cross(a, along)) / length;  // positive if the foot is inside
    const double h = std::abs(distance);
    if (h < 1e-12 * d) return 0;
    const double first = std::atan2(s_a, h), last = std::atan2(s_b, h);
    // The sum is in units of half the squared width. The integrand varies sharply if the ends of the edge are distant,
    // so the range is divided.
    const LineRule rule = gauss_legendre(16);
    double sum = 0;
    constexpr int parts = 4;
    for (int part = 0; part < parts; ++part) {
        const double lo = first + (last - first) * part / parts, step = (last - first) / parts;
        for (std::size_t i = 0; i < rule.size(); ++i) {
            const double c = std::cos(lo + step * rule.nodes[i]);
            sum += step * rule.weights[i] * -std::expm1(-h * h / (d * d * c * c));
        }
    }
    return std::copysign(0.5 * d * d * sum, distance);
}

}  // namespace

Gaussian product(const Gaussian& a, const Gaussian& b) {
    const double p = a.width * a.width, q = b.width * b.width, sum = p + q;
    return {(q / sum) * a.centre + (p / sum) * b.centre, std::sqrt(p * q / sum),
            a.amplitude * b.amplitude * std::exp(-squared_norm(a.centre - b.centre) / sum)};
}

double integral_over_plane(const Gaussian& g, const Point& at, const Normal& n) {
    const double h = dot(n, g.centre - at), d = g.width;
    return g.amplitude * pi * d * d * std::exp(-h * h / (d * d));
}

double integral_over_polygon(const Gaussian& g, std::span<const Point> corners, const Normal& n) {
    const double d = g.width, h = dot(n, g.centre - corners[0]);
    const double there = g.amplitude * std::exp(-h * h / (d * d));
    if (!(there > 0)) return 0;
    if (corners.size() == 4) {
        const Vec3 a = corners[1] - corners[0], b = corners[3] - corners[0];
        const double length_a = norm(a), length_b = norm(b);
        if (std::abs(dot(a, b)) <= right_angle * length_a * length_b) {
            const Vec3 w = g.centre - corners[0];
            return there * on_line(dot(w, a) / length_a, length_a, d) * on_line(dot(w, b) / length_b, length_b, d);
        }
    }
    const Point foot = g.centre - h * n;
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        sum += beside_edge(corners[i] - foot, corners[(i + 1) % corners.size()] - foot, n, d);
    return there * std::max(0.0, sum);
}

double transfer(const SurfaceGaussian& p, const SurfaceGaussian& q, const Point& o_x, const Point& o_y,
                double o_width) {
    return integral_over_plane(product({p.at, p.width}, {o_x, o_width}), p.at, p.n) *
           integral_over_plane(product({q.at, q.width}, {o_y, o_width}), q.at, q.n);
}

}  // namespace exitance
