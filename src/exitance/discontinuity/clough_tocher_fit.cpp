#include "exitance/discontinuity/clough_tocher_fit.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/base/limits.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/basis/small_system.hpp"

namespace exitance {
namespace {

/// Values of a triangle: 3 corners, 3 middles, 6 quarters (edge by edge), 1 inner node.
constexpr std::size_t value_count = 13;
constexpr std::size_t slope_count = 9;  ///< Slopes: from each corner to the two others, then one across each edge.

using Triangle = BisectionMesh::Triangle;
using SlopeRules = std::array<std::array<double, value_count>, slope_count>;

/// Positions of a triangle's values, as barycentric coordinates of its corners 1 and 2. `longest`: its longest edge.
std::array<Vec2, value_count> places_of_values(std::size_t longest) {
    constexpr std::array<Vec2, 3> corner{{{0, 0}, {1, 0}, {0, 1}}};
    std::array<Vec2, value_count> out;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 a = corner[i], b = corner[(i + 1) % 3];
        out[i] = a, out[3 + i] = 0.5 * (a + b);
        // Quarter points, derived from edges that are halved twice.
        out[6 + 2 * i] = 0.75 * a + 0.25 * b, out[7 + 2 * i] = 0.25 * a + 0.75 * b;
    }
    // Inner node, derived from the line that bisects the longest edge: its middle.
    out[12] = 0.25 * (corner[longest] + corner[(longest + 1) % 3]) + 0.5 * corner[(longest + 2) % 3];
    return out;
}

constexpr std::size_t power_count = 10;  // monomials up to degree three
/// Adds the monomials x^i y^j up to degree three at p, and their derivatives along d.
void add_powers(Vec2 p, Vec2 d, std::array<double, power_count>& value, std::array<double, power_count>& slope) {
    std::size_t k = 0;
    for (int degree = 0; degree <= 3; ++degree)
        for (int i = 0; i <= degree; ++i, ++k) {
            const int j = degree - i;
            value[k] = std::pow(p.x, i) * std::pow(p.y, j);
            slope[k] = (i > 0 ? d.x * i * std::pow(p.x, i - 1) * std::pow(p.y, j) : 0) +
                       (j > 0 ? d.y * j * std::pow(p.x, i) * std::pow(p.y, j - 1) : 0);
        }
}

/// Slopes of the least-squares cubic polynomial, as weights of the values.
SlopeRules slope_rules(std::size_t longest) {
    const std::array<Vec2, value_count> places = places_of_values(longest);
    std::array<double, power_count> value{}, slope{};
    std::vector<double> normal(power_count * power_count), right(power_count * value_count);
    for (std::size_t p = 0; p < value_count; ++p) {
        add_powers(places[p], {}, value, slope);
        for (std::size_t i = 0; i < power_count; ++i) {
            right[i * value_count + p] = value[i];
            for (std::size_t j = 0; j < power_count; ++j) normal[i * power_count + j] += value[i] * value[j];
        }
    }
    solve_in_place(normal, right, power_count, value_count);
    SlopeRules out{};
    for (std::size_t r = 0; r < slope_count; ++r) {
        const std::size_t i = r < 6 ? r / 2 : r - 6;
        const Vec2 from = places[r < 6 ? i : 3 + i], to = places[r < 6 ? (i + 1 + r % 2) % 3 : (i + 2) % 3];
        add_powers(from, to - from, value, slope);
        for (std::size_t p = 0; p < value_count; ++p)
            for (std::size_t i2 = 0; i2 < power_count; ++i2) out[r][p] += slope[i2] * right[i2 * value_count + p];
    }
    return out;
}

/// Returns the index in `other` of the edge that it shares with `triangle`.
std::size_t same_edge(const Triangle& other, std::uint32_t triangle) {
    return static_cast<std::size_t>(std::find(other.neighbor.begin(), other.neighbor.end(), triangle) -
                                    other.neighbor.begin());
}

/// Least-squares problem for the gradient g at a corner of one sector: minimize sum (d . g - slope)^2 over the ways d
/// to the other corners of its triangles. Stored as normal equations M g = r with M = L L^T.
struct SectorSlopes {
    std::uint32_t sector = 0;
    double xx = 0, xy = 0, yy = 0;
    std::array<Vec2, bands> right{};
    double l_xx = 0, l_xy = 0, l_yy = 0;

    void add(Vec2 d, const Spectrum& slope) {
        xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
        for (std::size_t b = 0; b < bands; ++b) right[b] = right[b] + slope[b] * d;
    }
    void factor() {
        // Regularization on the order of rounding errors: slivers do not determine the slope across themselves.
        constexpr double rounding = 1e-14;  // derived from double precision
        const double least = rounding * (xx + yy) + min_divisor;
        l_xx = std::sqrt(xx + least), l_xy = xy / l_xx;
        l_yy = std::sqrt(std::max(yy + least - l_xy * l_xy, least));
    }
    /// L^-1 p
    Vec2 whitened(Vec2 p) const { return {p.x / l_xx, (p.y - l_xy * p.x / l_xx) / l_yy}; }
    /// L^-T y
    Vec2 gradient(Vec2 y) const { return {(y.x - l_xy * y.y / l_yy) / l_xx, y.y / l_yy}; }
};

/// Orthonormal constraints on the whitened gradients of all sectors.
using Rows = std::vector<std::vector<double>>;

/// Adds the constraint that the gradients of two sectors have the same component along a direction. Constraints that
/// depend on those in `rows` are omitted.
void add_agreement(Rows& rows, std::span<const SectorSlopes> sectors, std::size_t a, std::size_t b, Vec2 direction) {
    std::vector<double> row(2 * sectors.size());
    const Vec2 in_a = sectors[a].whitened(direction), in_b = sectors[b].whitened(direction);
    row[2 * a] = in_a.x, row[2 * a + 1] = in_a.y, row[2 * b] = -in_b.x, row[2 * b + 1] = -in_b.y;
    const auto norm_of = [&] {
        double sum = 0;
        for (const double x : row) sum += x * x;
        return std::sqrt(sum);
    };
    const double before = norm_of();
    for (int twice = 0; twice < 2; ++twice)
        for (const auto& other : rows) {
            double product = 0;
            for (std::size_t i = 0; i < row.size(); ++i) product += row[i] * other[i];
            for (std::size_t i = 0; i < row.size(); ++i) row[i] -= product * other[i];
        }
    constexpr double dependent = 1e-7;  // derived from the rounding error of slopes: its square root
    const double after = norm_of();
    if (!(after > dependent * before)) return;
    for (double& x : row) x /= after;
    rows.push_back(std::move(row));
}

}  // namespace

CloughTocherFit::CloughTocherFit(const BisectionMesh& mesh, std::span<const Spectrum> values,
                                 const std::function<Normal(std::uint32_t)>& normal)
    : mesh_(mesh), values_(values) {
    fit_triangles();
    find_sectors();
    const auto& triangles = mesh_.triangles();
    std::vector<std::uint32_t> first(mesh_.nodes().size() + 1);
    for (const Triangle& t : triangles)
        for (const std::uint32_t node : t.corner) ++first[node + 1];
    for (std::size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
    std::vector<Corner> corners(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) corners[next[triangles[t].corner[k]]++] = {t, k};
    parallel_for(mesh_.nodes().size(), 256, [&](std::size_t n) {
        const auto around = std::span(corners).subspan(first[n], first[n + 1] - first[n]);
        if (!around.empty()) fit_corners(around, normal(around[0].triangle));
    });
    fit_edges();
}

bool CloughTocherFit::is_smooth(std::uint32_t triangle, std::size_t edge) const {
    const Triangle& t = mesh_.triangles()[triangle];
    if (t.neighbor[edge] == BisectionMesh::none || t.order[edge] <= CurveOrder::d1) return false;
    const Triangle& n = mesh_.triangles()[t.neighbor[edge]];
    const std::size_t m = same_edge(n, triangle);
    return t.corner[edge] == n.corner[(m + 1) % 3] && t.corner[(edge + 1) % 3] == n.corner[m];
}

void CloughTocherFit::fit_triangles() {
    static const std::array<SlopeRules, 3> rules{slope_rules(0), slope_rules(1), slope_rules(2)};
    const auto& triangles = mesh_.triangles();
    slopes_.resize(triangles.size());
    parallel_for(triangles.size(), 256, [&](std::size_t number) {
        const Triangle& t = triangles[number];
        std::array<const Spectrum*, value_count> values{};
        for (std::size_t i = 0; i < 3; ++i) {
            values[i] = &values_[t.corner[i]], values[3 + i] = &values_[t.middle[i]];
            for (std::size_t k = 0; k < 2; ++k) values[6 + 2 * i + k] = &values_[t.quarter[i][k]];
        }
        values[12] = &values_[t.inner];
        for (std::size_t r = 0; r < slope_count; ++r) {
            Spectrum& slope = r < 6 ? slopes_[number].to_next[r / 2][r % 2] : slopes_[number].across[r - 6];
            for (std::size_t p = 0; p < value_count; ++p) slope += rules[t.longest][r][p] * *values[p];
        }
    });
}

void CloughTocherFit::find_sectors() {
    const auto& triangles = mesh_.triangles();
    const auto place = [](std::uint32_t t, std::size_t k) { return 3 * t + static_cast<std::uint32_t>(k % 3); };
    DisjointSets sets(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t n = triangles[t].neighbor[k];
            if (n == BisectionMesh::none || n < t || triangles[t].order[k] <= CurveOrder::d1) continue;
            const std::size_t m = same_edge(triangles[n], t);
            if (triangles[t].corner[k] == triangles[n].corner[(m + 1) % 3]) sets.unite(place(t, k), place(n, m + 1));
            if (triangles[t].corner[(k + 1) % 3] == triangles[n].corner[m]) sets.unite(place(t, k + 1), place(n, m));
        }
    std::vector<std::uint32_t> number(3 * triangles.size(), BisectionMesh::none);
    std::uint32_t count = 0;
    sector_.resize(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& of_root = number[sets.root(place(t, k))];
            if (of_root == BisectionMesh::none) of_root = count++;
            sector_[t][k] = of_root;
        }
    gradient_.resize(count);
}

/// Computes the gradients of all sectors around one node. They fit the slopes of their triangles best, subject to the
/// constraint that both sides of a kink agree along it.
void CloughTocherFit::fit_corners(std::span<const Corner> around, const Normal& n) {
    const Frame plane(n);
    std::vector<SectorSlopes> sectors;
    const auto of_sector = [&](std::uint32_t number) {
        std::size_t i = 0;
        while (i < sectors.size() && sectors[i].sector != number) ++i;
        if (i == sectors.size()) sectors.emplace_back().sector = number;
        return i;
    };
    const auto way = [&](const Triangle& t, std::size_t from, std::size_t to) {
        const Vec3 d = mesh_.nodes()[t.corner[to % 3]].at - mesh_.nodes()[t.corner[from]].at;
        return Vec2{dot(d, plane.u), dot(d, plane.v)};
    };
    // The squared length of a way is its weight, so that tiny triangles next to a jump or singularity do not affect
    // large ones.
    for (const auto& [triangle, k] : around) {
        SectorSlopes& sector = sectors[of_sector(sector_[triangle][k])];
        for (std::size_t e = 0; e < 2; ++e)
            sector.add(way(mesh_.triangles()[triangle], k, k + 1 + e), slopes_[triangle].to_next[k][e]);
    }
    for (SectorSlopes& sector : sectors) sector.factor();
    Rows rows;
    for (const auto& [triangle, k] : around) {
        const Triangle& t = mesh_.triangles()[triangle];
        if (t.neighbor[k] == BisectionMesh::none || t.order[k] != CurveOrder::d1) continue;
        const Triangle& other = mesh_.triangles()[t.neighbor[k]];
        const std::size_t m = (same_edge(other, triangle) + 1) % 3;
        const std::uint32_t a = sector_[triangle][k], b = sector_[t.neighbor[k]][m];
        if (a == b || other.corner[m] != t.corner[k]) continue;
        const Vec2 d = way(t, k, k + 1);
        const double length = std::sqrt(dot(d, d));
        if (length > 0) add_agreement(rows, sectors, of_sector(a), of_sector(b), (1 / length) * d);
    }
    for (std::size_t b = 0; b < bands; ++b) {
        std::vector<double> y;
        for (const SectorSlopes& sector : sectors) {
            const Vec2 white = sector.whitened(sector.right[b]);
            y.push_back(white.x), y.push_back(white.y);
        }
        for (const auto& row : rows) {
            double product = 0;
            for (std::size_t i = 0; i < y.size(); ++i) product += row[i] * y[i];
            for (std::size_t i = 0; i < y.size(); ++i) y[i] -= product * row[i];
        }
        for (std::size_t s = 0; s < sectors.size(); ++s) {
            const Vec2 g = sectors[s].gradient({y[2 * s], y[2 * s + 1]});
            gradient_[sectors[s].sector][b] = g.x * plane.u + g.y * plane.v;
        }
    }
}

EdgeFrame CloughTocherFit::frame(std::uint32_t triangle, std::size_t i) const {
    const auto& c = mesh_.triangles()[triangle].corner;
    const auto& nodes = mesh_.nodes();
    return EdgeFrame(nodes[c[i]].at, nodes[c[(i + 1) % 3]].at, nodes[c[(i + 2) % 3]].at);
}

CloughTocher::Data CloughTocherFit::corner_data(std::uint32_t triangle, std::size_t band) const {
    const auto& c = mesh_.triangles()[triangle].corner;
    CloughTocher::Data data{};
    for (std::size_t i = 0; i < 3; ++i) {
        data.value[i] = values_[c[i]][band];
        for (std::size_t k = 0; k < 2; ++k)
            data.to_next[i][k] = dot(gradient_[sector_[triangle][i]][band],
                                     mesh_.nodes()[c[(i + 1 + k) % 3]].at - mesh_.nodes()[c[i]].at);
    }
    return data;
}

/// Computes the slope inwards at each edge's middle. It fits both triangles' slopes towards the opposite corner best,
/// after their component along the edge is removed and the rest is divided by the height.
void CloughTocherFit::fit_edges() {
    inwards_.resize(mesh_.triangles().size());
    parallel_for(mesh_.triangles().size(), 256, [&](std::size_t number) {
        const auto t = static_cast<std::uint32_t>(number);
        std::array<CloughTocher::Data, bands> data;
        for (std::size_t b = 0; b < bands; ++b) data[b] = corner_data(t, b);
        for (std::size_t i = 0; i < 3; ++i) {
            const bool smooth = is_smooth(t, i);
            const std::uint32_t n = mesh_.triangles()[t].neighbor[i];
            if (smooth && n < t) continue;
            const EdgeFrame own = frame(t, i);
            const std::size_t m = smooth ? same_edge(mesh_.triangles()[n], t) : 0;
            const EdgeFrame other = smooth ? frame(n, m) : EdgeFrame({}, {}, {});
            const double squares = own.height * own.height + other.height * other.height;
            for (std::size_t b = 0; b < bands; ++b) {
                const double along = slope_along(data[b], i);
                double sum = own.height * (slopes_[t].across[i][b] - own.along * along);
                if (smooth) sum -= other.height * (slopes_[n].across[m][b] + other.along * along);
                const double slope = squares > 0 ? sum / squares : 0;
                inwards_[t][i][b] = slope;
                if (smooth) inwards_[n][m][b] = -slope;
            }
        }
    });
}

CloughTocher CloughTocherFit::element(std::uint32_t triangle, std::size_t band) const {
    CloughTocher::Data data = corner_data(triangle, band);
    for (std::size_t i = 0; i < 3; ++i) {
        const EdgeFrame edge = frame(triangle, i);
        data.across[i] = edge.along * slope_along(data, i) + edge.height * inwards_[triangle][i][band];
    }
    return CloughTocher(data);
}

Misfit CloughTocherFit::misfit(std::uint32_t triangle, const Spectrum& weight) const {
    const Triangle& t = mesh_.triangles()[triangle];
    std::array<Spectrum, value_count> errors;
    const std::array<Vec2, value_count> places = places_of_values(t.longest);
    for (std::size_t b = 0; b < bands; ++b) {
        const CloughTocher f = element(triangle, b);
        for (std::size_t p = 3; p < value_count; ++p)
            errors[p][b] = -f.at({1 - places[p].x - places[p].y, places[p].x, places[p].y});
    }
    for (std::size_t i = 0; i < 3; ++i) {
        errors[3 + i] += values_[t.middle[i]];
        for (std::size_t k = 0; k < 2; ++k) errors[6 + 2 * i + k] += values_[t.quarter[i][k]];
    }
    errors[12] += values_[t.inner];
    Misfit out;
    double square = 0;
    for (std::size_t p = 3; p < value_count; ++p) {
        // Weights that give the mean square of the element's error for a quartic, half of it from middles, half from
        // quarters. Derived from the integrals of the squared basis functions.
        constexpr double of_middle = 0.0613, of_quarter = 0.0968, of_inner = 0.1909;
        const double part = p < 6 ? of_middle : p < 12 ? of_quarter : of_inner;
        square += part * squared(weight * errors[p]) / static_cast<double>(bands);
        out.largest = std::max(out.largest, std::abs(mean(weight * errors[p])));
    }
    out.squared = mesh_.area(triangle) * square;
    return out;
}

void CloughTocherFit::write(SixNodeMesh& out) const {
    out.gradients.resize(gradient_.size());
    for (std::size_t g = 0; g < gradient_.size(); ++g)
        for (std::size_t b = 0; b < bands; ++b)
            for (std::size_t axis = 0; axis < 3; ++axis)
                out.gradients[g][axis][b] = static_cast<float>(gradient_[g][b][axis]);
    out.gradient_of = sector_;
    out.slopes.resize(inwards_.size());
    for (std::size_t t = 0; t < inwards_.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t b = 0; b < bands; ++b) out.slopes[t][i][b] = static_cast<float>(inwards_[t][i][b]);
    for (std::uint32_t t = 0; t < out.size(); ++t)
        for (std::size_t b = 0; b < bands; ++b) {
            const CloughTocher f = out.element(t, b);
            for (std::size_t i = 0; i < 3; ++i) {
                std::array<double, 3> middle{};
                middle[i] = middle[(i + 1) % 3] = 0.5;
                out.values[out.nodes[t][3 + i]][b] = static_cast<float>(f.at(middle));
            }
        }
}

}  // namespace exitance
