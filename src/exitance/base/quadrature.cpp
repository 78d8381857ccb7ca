#include "exitance/base/quadrature.hpp"

#include <array>

#include "exitance/base/check.hpp"

namespace exitance {
namespace {

struct GaussTable {
    std::vector<double> nodes, weights;
};

/// Newton's iteration on P_n(z), by the three-term recurrence; w = 2 / ((1 - z^2) P_n'(z)^2) on [-1, 1].
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

/// Adds the six points of the orbit (a, b, 1 - a - b).
void add_orbit(std::vector<PlanarNode>& rule, double a, double b, double weight) {
    const double c = 1 - a - b;
    for (const Vec2& at : {Vec2{a, b}, {b, a}, {a, c}, {c, a}, {b, c}, {c, b}}) rule.push_back({at, weight});
}

/// Adds Gauss points of the unit square mapped to the triangle by (s, t) -> (s, (1 - s) t). The Jacobian 2 (1 - s)
/// costs one degree in s.
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
    } else if (degree <= 8) {
        // [Dunavant85] degree 8, with points and weights solved again to the last digits.
        rule.push_back({{1.0 / 3, 1.0 / 3}, 0.14431560767778717});
        add_orbit(rule, 0.45929258829272318, 0.09509163426728462);
        add_orbit(rule, 0.17056930775176021, 0.10321737053471826);
        add_orbit(rule, 0.05054722831703098, 0.03245849762319808);
        add_orbit(rule, 0.00839477740995761, 0.26311282963463811, 0.02723031417443499);
    } else {
        add_collapsed(rule, degree);
    }
    return rule;
}

/// Returns tables with make(i) at index i, for i from `first` to `last`.
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

/// One solution of the 45 moment equations to degree 8 in 48 unknowns, by the Levenberg-Marquardt method. Among some
/// dozen solutions with all points inside and positive weights, this one integrates steps, kinks and slits on the
/// square most accurately.
std::span<const PlanarNode> scattered_square_rule() {
    static constexpr PlanarNode rule[] = {
        {{0.94185584245143994, 0.02289524841317730}, 0.01542361653603885},
        {{0.38141169573415867, 0.03208537295859170}, 0.04494342442083953},
        {{0.03700348647058856, 0.05384784716110449}, 0.01873239823717280},
        {{0.72778423569679396, 0.11687420712988911}, 0.08175005690820396},
        {{0.17556355685977687, 0.21154725484121123}, 0.08862570441838508},
        {{0.94781796133458340, 0.29794080262928596}, 0.05552051146046401},
        {{0.51507976015212031, 0.33848692328968216}, 0.11860454097301544},
        {{0.03568738589075465, 0.47536594612804761}, 0.04886737585595063},
        {{0.36482378351422035, 0.54605479617312047}, 0.07473897315613481},
        {{0.79907468279927329, 0.57966322272633930}, 0.11822598533419955},
        {{0.21292427778539774, 0.71355041686225085}, 0.08993059369489548},
        {{0.97707869218743637, 0.78293462606244213}, 0.03259817791603693},
        {{0.57740413706498628, 0.84776949432928927}, 0.10770888006461948},
        {{0.05493859599718458, 0.89534896390702723}, 0.03682122947100521},
        {{0.85674709032411978, 0.96181346274631696}, 0.03537029880163623},
        {{0.30707768997636326, 0.98451223936965993}, 0.03213823275140203},
    };
    return rule;
}

std::span<const PlanarNode> triangle_rule(int degree) {
    static const auto tables = make_tables<std::vector<PlanarNode>>(0, largest_triangle_degree, make_triangle);
    EXI_CHECK(degree >= 0 && degree <= largest_triangle_degree);
    return tables[static_cast<std::size_t>(degree)];
}

}  // namespace exitance
