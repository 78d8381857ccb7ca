#include "exitance/geometry/quadrature.hpp"

#include <array>

#include "exitance/core/check.hpp"

namespace exitance {
namespace {

struct GaussTable {
    std::vector<double> nodes, weights;
};

/// Newton's iteration on P_n(z), with the three-term recurrence; w = 2 / ((1 - z^2) P_n'(z)^2) on [-1, 1].
GaussTable make_gauss(int n) {
    GaussTable table;
    table.nodes.resize(static_cast<std::size_t>(n));
    table.weights.resize(static_cast<std::size_t>(n));
    for (int k = 0; k < (n + 1) / 2; ++k) {
        double z = std::cos(pi * (k + 0.75) / (n + 0.5)), slope = 0;
        for (int step = 0; step < 8; ++step) {  // converges quadratically: 5 steps suffice, 8 settle the last bit
            double p = 1, before = 0;
            for (int j = 1; j <= n; ++j) {
                const double older = before;
                before = p;
                p = ((2 * j - 1) * z * before - (j - 1) * older) / j;
            }
            slope = n * (z * p - before) / (z * z - 1);
            z -= p / slope;
        }
        if (2 * k + 1 == n) z = 0;
        const double weight = 1 / ((1 - z * z) * slope * slope);
        const auto low = static_cast<std::size_t>(k), high = static_cast<std::size_t>(n - 1 - k);
        table.nodes[low] = 0.5 * (1 - z);
        table.nodes[high] = 0.5 * (1 + z);
        table.weights[low] = table.weights[high] = weight;
    }
    return table;
}

std::vector<PlanarNode> make_square(int n) {
    const LineRule line = gauss_legendre(n);
    std::vector<PlanarNode> rule;
    for (std::size_t j = 0; j < line.size(); ++j)
        for (std::size_t i = 0; i < line.size(); ++i)
            rule.push_back({{line.nodes[i], line.nodes[j]}, line.weights[i] * line.weights[j]});
    return rule;
}

/// Adds the three points of the orbit (a, a, 1 - 2a) in barycentric coordinates.
void add_orbit(std::vector<PlanarNode>& rule, double a, double weight) {
    rule.push_back({{a, a}, weight});
    rule.push_back({{1 - 2 * a, a}, weight});
    rule.push_back({{a, 1 - 2 * a}, weight});
}

/// The unit square collapsed onto the triangle, (s, t) -> (s, (1 - s) t): the factor 2 (1 - s) costs one degree in s.
void add_collapsed(std::vector<PlanarNode>& rule, int degree) {
    const LineRule across = gauss_legendre(degree / 2 + 1), along = gauss_legendre((degree + 1) / 2 + 1);
    for (std::size_t i = 0; i < along.size(); ++i)
        for (std::size_t j = 0; j < across.size(); ++j) {
            const double s = along.nodes[i];
            rule.push_back({{s, (1 - s) * across.nodes[j]}, 2 * (1 - s) * along.weights[i] * across.weights[j]});
        }
}

std::vector<PlanarNode> make_triangle(int degree) {
    std::vector<PlanarNode> rule;
    if (degree <= 1) {
        rule.push_back({{1.0 / 3, 1.0 / 3}, 1});
    } else if (degree == 2) {
        add_orbit(rule, 1.0 / 6, 1.0 / 3);
    } else if (degree <= 4) {
        // [Dunavant85] degree 4 in closed form: a, b = (8 - sqrt(10) +- sqrt(38 - 44 sqrt(2/5))) / 18.
        const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), spread = std::sqrt(213125 - 53320 * std::sqrt(10.0));
        add_orbit(rule, (8 - std::sqrt(10.0) + root) / 18, (620 + spread) / 3720);
        add_orbit(rule, (8 - std::sqrt(10.0) - root) / 18, (620 - spread) / 3720);
    } else if (degree == 5) {
        rule.push_back({{1.0 / 3, 1.0 / 3}, 0.225});
        const double root = std::sqrt(15.0);
        add_orbit(rule, (6 - root) / 21, (155 - root) / 1200);
        add_orbit(rule, (6 + root) / 21, (155 + root) / 1200);
    } else {
        add_collapsed(rule, degree);
    }
    return rule;
}

/// make(first), ..., make(last), each at its own index.
template <class Table, class Make>
std::vector<Table> make_tables(int first, int last, const Make& make) {
    std::vector<Table> tables(static_cast<std::size_t>(last) + 1);
    for (int i = first; i <= last; ++i) tables[static_cast<std::size_t>(i)] = make(i);
    return tables;
}

}  // namespace

LineRule gauss_legendre(int n) {
    static const auto tables = make_tables<GaussTable>(1, largest_gauss_rule, make_gauss);
    EXI_CHECK(n >= 1 && n <= largest_gauss_rule);
    const GaussTable& table = tables[static_cast<std::size_t>(n)];
    return {table.nodes, table.weights};
}

std::span<const PlanarNode> square_rule(int n) {
    static const auto tables = make_tables<std::vector<PlanarNode>>(1, largest_gauss_rule, make_square);
    EXI_CHECK(n >= 1 && n <= largest_gauss_rule);
    return tables[static_cast<std::size_t>(n)];
}

std::span<const PlanarNode> triangle_rule(int degree) {
    static const auto tables = make_tables<std::vector<PlanarNode>>(0, largest_triangle_degree, make_triangle);
    EXI_CHECK(degree >= 0 && degree <= largest_triangle_degree);
    return tables[static_cast<std::size_t>(degree)];
}

}  // namespace exitance
