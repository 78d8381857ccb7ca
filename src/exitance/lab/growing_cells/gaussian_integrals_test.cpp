#include "exitance/lab/growing_cells/gaussian_integrals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>

#include "exitance/base/quadrature.hpp"

namespace exitance {
namespace {

using Triangle = std::array<Point, 3>;

/// Quadrature by a product rule on parts x parts cells of the triangle, seen as a collapsed square.
double by_quadrature(const Triangle& t, const std::function<double(const Point&)>& f, int parts = 24) {
    const LineRule rule = gauss_legendre(6);
    const double area = 0.5 * norm(cross(t[1] - t[0], t[2] - t[0]));
    double sum = 0;
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j)
            for (std::size_t p = 0; p < rule.size(); ++p)
                for (std::size_t q = 0; q < rule.size(); ++q) {
                    const double u = (i + rule.nodes[p]) / parts, v = (j + rule.nodes[q]) / parts;
                    const Point x = t[0] + u * (t[1] - t[0]) + (u * v) * (t[2] - t[1]);
                    sum += rule.weights[p] * rule.weights[q] / (parts * parts) * 2 * area * u * f(x);
                }
    return sum;
}

double gaussian(const Point& x, const Point& c, double d) {
    return std::exp(-squared_norm(x - c) / (d * d));
}

const Triangle floor_triangle{Point{-9, -9, 0}, Point{9, -9, 0}, Point{0, 12, 0}};
const Triangle wall_triangle{Point{-9, 3, -8}, Point{0, 3, 12}, Point{9, 3, -8}};

/// The transfer as published, whose linear coefficient is half of the correct one, for two equal parameters.
double as_printed(const SurfaceGaussian& p, const Point& o, double d_o) {
    const Vec3 f = p.at - o;
    const double f_n = dot(f, p.n), f_t = std::sqrt(squared_norm(f) - f_n * f_n);
    const double A = 1 / (p.width * p.width) + 1 / (d_o * d_o), B = f_t / (d_o * d_o);
    return pi / A * std::exp(-squared_norm(f) / (d_o * d_o)) * std::exp(B * B / (2 * A));
}

TEST(GaussianIntegrals, CorrectedTransferAgreesWithQuadratureAndThePrintedOneDoesNot) {
    const SurfaceGaussian p{{0.3, -0.2, 0}, {0, 0, 1}, 0.8}, q{{-0.4, 3, 0.5}, {0, -1, 0}, 0.6};
    const Point o_x{0.9, 0.3, 0.2}, o_y{0.1, 2.8, 0.1};
    const double d_o = 0.7;
    const double at_x = by_quadrature(
        floor_triangle, [&](const Point& x) { return gaussian(x, p.at, p.width) * gaussian(x, o_x, d_o); });
    const double at_y = by_quadrature(
        wall_triangle, [&](const Point& y) { return gaussian(y, q.at, q.width) * gaussian(y, o_y, d_o); });
    const double right = at_x * at_y;
    // The triangles extend ten widths beyond the units; the remaining difference is the quadrature error.
    EXPECT_NEAR(transfer(p, q, o_x, o_y, d_o) / right, 1, 1e-8);
    const double printed = as_printed(p, o_x, d_o) * as_printed(q, o_y, d_o);
    EXPECT_LT(printed / right, 0.9);
}

TEST(GaussianIntegrals, OverTrianglesAndParallelogramsBordersAreExact) {
    const Triangle t{Point{0, 0, 1}, Point{1, 0.2, 1}, Point{0.3, 1.4, 1}};
    const Normal n{0, 0, 1};
    for (const Point& c : {Point{0.4, 0.5, 1}, Point{0, 0, 1.2}, Point{1.1, 1, 0.9}, Point{-0.5, 0.2, 1}})
        for (const double d : {0.1, 0.4, 3.0}) {
            const double right = by_quadrature(
                t, [&](const Point& x) { return gaussian(x, c, d); }, 40);
            EXPECT_NEAR(integral_over_polygon({c, d}, t, n), right, 1e-7 * pi * d * d);
            const std::vector<Point> slanted{t[0], t[1], t[1] + t[2] - t[0], t[2]};
            const Triangle other{slanted[1], slanted[2], slanted[3]};
            const double both = right + by_quadrature(
                                            other, [&](const Point& x) { return gaussian(x, c, d); }, 40);
            EXPECT_NEAR(integral_over_polygon({c, d}, slanted, n), both, 1e-7 * pi * d * d);
        }
}

TEST(GaussianIntegrals, RectanglesByErrorFunctionsEqualTheirTwoTriangles) {
    const std::vector<Point> r{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    const Normal n{0, 0, 1};
    for (const Point& c : {Point{0.7, 0.2, 0.1}, Point{2, 1, 0}, Point{3, 0.5, 0}}) {
        const Gaussian g{c, 0.5};
        const std::vector<Point> first{r[0], r[1], r[2]}, second{r[0], r[2], r[3]};
        EXPECT_NEAR(integral_over_polygon(g, r, n),
                    integral_over_polygon(g, first, n) + integral_over_polygon(g, second, n), 1e-9);
    }
}

}  // namespace
}  // namespace exitance
