#include "exitance/links/error/near_row.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/calibration/numbers.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {

void NearRow::set_source(ElementId q) {
    frame_ = sites_.frame(q);
    normal_ = sites_.normal(q);
    outline_ = sites_.tree().outline(q);
}

/// Adds transport K from around uv to the values that represent the function there.
void NearRow::add_point(Vec2 uv, double K) {
    const NodalBasis& basis = sites_.basis();
    if (basis.is_flat()) {
        sum_[basis.box_at(frame_.shape, uv)] += K;
        return;
    }
    std::array<double, 9> value;
    const std::size_t count = basis.monomial_count(frame_.shape);
    basis.monomials(frame_.shape, uv, value);
    for (std::size_t i = 0; i < count; ++i) sum_[i] += K * value[i];
}

void NearRow::add(const Point& x, const Normal& n, const Box& box, int depth) {
    const bool triangle = frame_.is_triangle();
    const Vec3 a = box.size.x * frame_.a, b = box.size.y * frame_.b;
    const Point origin = frame_.at(box.origin);
    const Point middle = triangle ? origin + (a + b) / 3 : origin + 0.5 * (a + b);
    const double squared_diagonal = std::max(squared_norm(a + b), squared_norm(a - b));
    // Radius of a ball around the box; the factor is derived from geometry.
    const double squared_radius = squared_diagonal / 4 * (triangle ? 16.0 / 9 : 1.0);
    const Vec3 d = middle - x;
    const double squared_distance = squared_norm(d), here = dot(n, d);
    if (here < 0 && here * here > squared_radius) return;
    const auto at = [&](double s, double t) {
        return Vec2{box.origin.x + s * box.size.x, box.origin.y + t * box.size.y};
    };
    const double area = norm(cross(a, b)) * (triangle ? 0.5 : 1.0);
    if (squared_radius < calibrated::near_row_rule_ratio * squared_distance) {
        const auto rule = triangle ? triangle_rule(2) : square_rule(2);
        for (const PlanarNode& node : rule) {
            const Vec3 w = origin + node.at.x * a + node.at.y * b - x;
            const double up = dot(n, w), down = -dot(normal_, w), rr = squared_norm(w);
            if (up > 0 && down > 0)
                add_point(at(node.at.x, node.at.y), node.weight * area * up * down / (pi * rr * rr));
        }
        return;
    }
    constexpr int max_depth = 5;
    if (depth == max_depth) {
        corners_ = {origin, origin + a, triangle ? origin + b : origin + a + b, origin + b};
        const double F = point_to_polygon(x, n, std::span(corners_).first(triangle ? 3 : 4));
        if (F > 0) add_point(triangle ? at(1.0 / 3, 1.0 / 3) : at(0.5, 0.5), F);
        return;
    }
    const Vec2 half = 0.5 * box.size;
    if (triangle) {
        add(x, n, {box.origin, half}, depth + 1);
        add(x, n, {at(0.5, 0), half}, depth + 1);
        add(x, n, {at(0, 0.5), half}, depth + 1);
        add(x, n, {at(0.5, 0.5), -1 * half}, depth + 1);
        return;
    }
    const double long_a = squared_norm(a), long_b = squared_norm(b);
    const bool cut_a = 2 * long_a > long_b, cut_b = 2 * long_b > long_a;
    const Vec2 size{cut_a ? half.x : box.size.x, cut_b ? half.y : box.size.y};
    for (int j = 0; j <= (cut_b ? 1 : 0); ++j)
        for (int i = 0; i <= (cut_a ? 1 : 0); ++i)
            add(x, n, {{box.origin.x + i * size.x, box.origin.y + j * size.y}, size}, depth + 1);
}

double NearRow::operator()(const Point& x, const Normal& n, double* out) {
    const NodalBasis& basis = sites_.basis();
    const std::size_t count = basis.count();
    const double F = point_to_polygon(x, n, outline_);
    std::fill_n(out, count, 0.0);
    if (F <= 0) return 0;
    if (count == 1) return out[0] = F;
    sum_.fill(0);
    add(x, n, {{0, 0}, {1, 1}}, 0);
    if (basis.is_flat())
        std::copy_n(sum_.begin(), count, out);
    else
        basis.from_monomials(frame_.shape, sum_, std::span(out, count));
    double all = 0;
    for (std::size_t l = 0; l < count; ++l) all += out[l];
    if (all > 1e-12 * F) {  // derived from rounding: some of the source is visible
        for (std::size_t l = 0; l < count; ++l) out[l] *= F / all;
    } else {  // only a sliver of the source between the rule's points is visible
        for (std::size_t l = 0; l < count; ++l) out[l] = F * basis.nodes(frame_.shape)[l].weight;
    }
    return F;
}

}  // namespace exitance
