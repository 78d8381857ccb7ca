#include "exitance/form_factors/pair_form_factor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "exitance/base/quadrature.hpp"

namespace exitance {
namespace {

struct Edge {
    Point from;
    Vec3 along;  ///< Length 1.
    double length = 0;
};

std::vector<Edge> edges_of(const std::vector<Point>& outline) {
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec3 e = outline[(i + 1) % outline.size()] - outline[i];
        const double length = norm(e);
        if (length > 0) edges.push_back({outline[i], e / length, length});
    }
    return edges;
}

/// Primitive of ln sqrt(t^2 + h^2) in t.
double log_primitive(double t, double h) {
    const double squared = t * t + h * h;
    if (squared == 0) return 0;
    return t * (0.5 * std::log(squared) - 1) + (h > 0 ? h * std::atan(t / h) : 0);
}

/// Integral of ln |p - y| over the points y of an edge.
double log_integral(const Point& p, const Edge& edge) {
    const Vec3 d = p - edge.from;
    const double s = dot(d, edge.along), h = norm(cross(d, edge.along));
    return log_primitive(edge.length - s, h) - log_primitive(-s, h);
}

/// Outer integral over a part [first, last] of an edge; adaptive bisection by the difference of two Gauss rules.
class OuterIntegral {
  public:
    OuterIntegral(const Edge& outer, const Edge& inner, double first, double last, bool mapped, double tolerance)
        : outer_(outer), inner_(inner), first_(first), width_(last - first), mapped_(mapped) {
        const bool fine = tolerance < 1e-7;
        coarse_ = gauss_legendre(fine ? 8 : 4);
        better_ = gauss_legendre(fine ? 14 : 7);
    }

    double operator()(double allowed) const { return part(0, 1, allowed, 0); }
    double estimate() const { return sum(better_, 0, 1); }

  private:
    double part(double a, double b, double allowed, int depth) const {
        const double better = sum(better_, a, b);
        const double error = std::abs(better - sum(coarse_, a, b));
        if (depth == max_depth || error <= std::max(allowed, rounding() * (b - a) * width_)) return better;
        const double middle = 0.5 * (a + b);
        return part(a, middle, 0.5 * allowed, depth + 1) + part(middle, b, 0.5 * allowed, depth + 1);
    }

    double sum(const LineRule& rule, double a, double b) const {
        double total = 0;
        for (std::size_t k = 0; k < rule.size(); ++k) {
            double y = a + (b - a) * rule.nodes[k], stretch = width_;
            // Substitute t = y^3 (10 - 15 y + 6 y^2), computed from 1 - y above 1/2, so that small distances to both
            // ends keep their digits.
            if (mapped_) {
                const double z = 1 - y;
                stretch *= 30 * y * y * z * z;
                y = y <= 0.5 ? y * y * y * (10 - 15 * y + 6 * y * y) : 1 - z * z * z * (10 - 15 * z + 6 * z * z);
            }
            total +=
                rule.weights[k] * stretch * log_integral(outer_.from + (first_ + width_ * y) * outer_.along, inner_);
        }
        return (b - a) * total;
    }

    /// Rounding error of the inner integral: a difference of primitives of order one, however short the edge is. At
    /// tolerances below it the two rules always differ.
    double rounding() const { return 1e-15 * inner_.length + 5e-16; }

    static constexpr int max_depth = 24;
    const Edge& outer_;
    const Edge& inner_;
    double first_, width_;
    bool mapped_;
    LineRule coarse_, better_;
};

/// A part of the outer edge on which the inner integral is smooth, except possibly at its ends.
struct Part {
    double first, last;
    bool touches;  ///< One of the part's ends coincides with an end point of the inner edge.
};

/// Splits the outer edge where it passes end points of the inner edge, near which the inner integral has strong
/// curvature.
void cut_at_passing_points(const Edge& outer, const Edge& inner, std::vector<Part>& parts) {
    const double scale = outer.length + inner.length, nil = 1e-11 * scale;
    const Point ends[2] = {inner.from, inner.from + inner.length * inner.along};
    std::array<double, 4> at = {0, outer.length, outer.length, outer.length};
    std::array<double, 2> touching = {-1, -1};
    std::size_t count = 2;
    for (std::size_t i = 0; i < 2; ++i) {
        const double s = dot(ends[i] - outer.from, outer.along);
        const double distance = norm(cross(ends[i] - outer.from, outer.along));
        if (s > nil && s < outer.length - nil && distance < 0.5 * outer.length) at[count++ - 1] = s;
        if (s > -nil && s < outer.length + nil && distance < nil) touching[i] = s;
    }
    at[count - 1] = outer.length;
    if (at[1] > at[2]) std::swap(at[1], at[2]);
    parts.clear();
    const auto touches = [&](double s) { return std::abs(s - touching[0]) <= nil || std::abs(s - touching[1]) <= nil; };
    for (std::size_t i = 0; i + 1 < count; ++i)
        if (at[i + 1] - at[i] > nil || count == 2)
            parts.push_back({at[i], at[i + 1], touches(at[i]) || touches(at[i + 1])});
}

/// Double contour integral. Lengths are in units of the pair's distance or size, so that ln r is of order one.
double contour_integral(const std::vector<Point>& receiver, const std::vector<Point>& source, double tolerance) {
    const std::vector<Edge> outer = edges_of(receiver), inner = edges_of(source);
    std::vector<Part> parts;
    const auto sum_pairs = [&](const auto& integrate) {
        double total = 0;
        for (const Edge& e : outer)
            for (const Edge& f : inner) {
                const double cosine = dot(e.along, f.along);
                if (std::abs(cosine) < 1e-16) continue;
                cut_at_passing_points(e, f, parts);
                for (const Part& p : parts)
                    total += cosine * integrate(OuterIntegral(e, f, p.first, p.last, p.touches, tolerance));
            }
        return total / (2 * pi);
    };
    const double estimate = sum_pairs([](const OuterIntegral& part) { return part.estimate(); });
    // The errors of the parts have random signs, and the difference of the rules overestimates them. Each part
    // therefore gets the total tolerance divided by the square root of their number.
    const double count = static_cast<double>(outer.size() * inner.size());
    const double allowed = 2 * pi * tolerance * std::max(std::abs(estimate), 1e-12) / std::sqrt(count);
    return sum_pairs([&](const OuterIntegral& part) { return part(allowed); });
}

/// A Gauss point on one of the triangles fanned from the first corner. Triangles at concave corners have negative
/// weights, which is correct for an integrand that is smooth on the whole plane.
struct AreaNode {
    Point at;
    double weight;  ///< m^2
};
std::vector<AreaNode> area_nodes(const std::vector<Point>& outline, const Normal& n, int degree) {
    std::vector<AreaNode> nodes;
    for (std::size_t i = 2; i < outline.size(); ++i) {
        const Vec3 a = outline[i - 1] - outline[0], b = outline[i] - outline[0];
        const double area = 0.5 * dot(n, cross(a, b));
        for (const PlanarNode& k : triangle_rule(degree))
            nodes.push_back({outline[0] + k.at.x * a + k.at.y * b, area * k.weight});
    }
    return nodes;
}

double area_integral(const std::vector<Point>& receiver, const Normal& n_receiver, const std::vector<Point>& source,
                     const Normal& n_source, int degree) {
    const std::vector<AreaNode> xs = area_nodes(receiver, n_receiver, degree),
                                ys = area_nodes(source, n_source, degree);
    double total = 0;
    for (const AreaNode& x : xs) {
        double sum = 0;
        for (const AreaNode& y : ys) {
            const Vec3 d = y.at - x.at;
            const double squared = dot(d, d);
            sum -= y.weight * dot(n_receiver, d) * dot(n_source, d) / (squared * squared);
        }
        total += x.weight * sum;
    }
    return total / pi;
}

Box box_of(std::span<const Point> outline) {
    Box box;
    for (const Point& p : outline) box.add(p);
    return box;
}

std::vector<Point> moved(std::span<const Point> outline, const Point& centre, double scale) {
    std::vector<Point> out;
    for (const Point& p : outline) out.push_back((p - centre) * scale);
    return out;
}

/// True if some corner is in front of the plane by more than the rounding error. Lengths are of order one.
bool rises_above(const std::vector<Point>& outline, const Normal& n, const Point& on_plane) {
    return std::any_of(outline.begin(), outline.end(), [&](const Point& p) { return dot(n, p - on_plane) > 1e-13; });
}

}  // namespace

double exchange_area(std::span<const Point> receiver, std::span<const Point> source, double tolerance) {
    Box box_r = box_of(receiver), box_s = box_of(source), both = box_r;
    both.add(box_s);
    const double size = box_r.diagonal() + box_s.diagonal();
    const double distance = std::max(norm(box_r.centre() - box_s.centre()), 0.5 * size), unit = 1 / distance;
    const std::vector<Point> r = moved(receiver, both.centre(), unit), s = moved(source, both.centre(), unit);
    const Normal n_r = normalized(area_vector(r)), n_s = normalized(area_vector(s));

    std::vector<Point> front_r, front_s;
    clip(r, {n_s, dot(n_s, s[0])}, front_r);
    clip(s, {n_r, dot(n_r, r[0])}, front_s);
    if (!rises_above(front_r, n_s, s[0]) || !rises_above(front_s, n_r, r[0])) return 0;

    const double squared = distance * distance;
    if (distance > 10 * size) return squared * std::max(0.0, area_integral(front_r, n_r, front_s, n_s, 7));
    return squared * std::max(0.0, contour_integral(front_r, front_s, tolerance));
}

double pair_form_factor(std::span<const Point> receiver, std::span<const Point> source, double tolerance) {
    return exchange_area(receiver, source, tolerance) / norm(area_vector(receiver));
}

}  // namespace exitance
