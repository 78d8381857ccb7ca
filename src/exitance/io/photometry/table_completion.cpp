#include "exitance/io/photometry/table_completion.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr double rounding = 1e-6;  ///< Degrees: angles closer than this are equal.

bool same(double a, double b) {
    return std::abs(a - b) < rounding;
}

/// Adds the mirror images of planes: the plane at angle `mirror` - a is equal to that at a.
Planes mirrored(const Planes& in, double mirror) {
    Planes out = in;
    for (std::size_t i = in.angle.size(); i-- > 0;) {
        double a = mirror - in.angle[i];
        while (a < -rounding) a += 360;
        while (a > 360 + rounding) a -= 360;
        out.angle.push_back(a), out.rows.push_back(in.rows[i]);
    }
    return out;
}

/// Sorts planes by angle and removes duplicates, so that both 0 and 360 are included.
Planes sorted_circle(const Planes& in) {
    std::vector<std::size_t> order(in.angle.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return in.angle[a] < in.angle[b]; });
    Planes out;
    for (const std::size_t i : order) {
        if (!out.angle.empty() && same(out.angle.back(), in.angle[i])) continue;
        out.angle.push_back(in.angle[i]), out.rows.push_back(in.rows[i]);
    }
    if (!same(out.angle.front(), 0)) {
        out.angle.insert(out.angle.begin(), 0);
        out.rows.insert(out.rows.begin(), out.rows.back());
    }
    if (!same(out.angle.back(), 360)) out.angle.push_back(360), out.rows.push_back(out.rows.front());
    out.angle.front() = 0, out.angle.back() = 360;
    return out;
}

}  // namespace

bool has_known_range(const std::vector<double>& angles) {
    const double first = angles.front(), last = angles.back();
    if (angles.size() == 1) return true;
    if (same(first, 90)) return same(last, 270);
    return same(first, 0) && (same(last, 90) || same(last, 180) || (last > 180 && last < 360 + rounding));
}

Planes completed(const Planes& planes) {
    if (planes.angle.size() == 1) return {{0}, planes.rows};
    const double first = planes.angle.front(), last = planes.angle.back();
    if (same(first, 90)) return sorted_circle(mirrored(planes, 180));
    if (same(last, 90)) return sorted_circle(mirrored(mirrored(planes, 180), 360));
    if (same(last, 180)) return sorted_circle(mirrored(planes, 360));
    return sorted_circle(planes);
}

void mirror(std::vector<double>& at, std::vector<std::vector<double>>& rows) {
    const std::size_t n = at.size();
    std::vector<double> angles;
    std::vector<std::vector<double>> all;
    for (std::size_t i = n; i-- > 1;) angles.push_back(-at[i]), all.push_back(rows[i]);
    for (std::size_t i = 0; i < n; ++i) angles.push_back(at[i]), all.push_back(rows[i]);
    at = std::move(angles), rows = std::move(all);
}

std::vector<std::vector<double>> transposed(const std::vector<std::vector<double>>& rows) {
    std::vector<std::vector<double>> out(rows[0].size(), std::vector<double>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t k = 0; k < rows[i].size(); ++k) out[k][i] = rows[i][k];
    return out;
}

Planes around_axis(const std::vector<double>& around, const std::vector<std::vector<double>>& rows) {
    Planes circle;
    const auto add = [&](double angle, std::vector<double> row) {
        circle.angle.push_back(angle), circle.rows.push_back(std::move(row));
    };
    const std::vector<double> nothing(rows[0].size(), 0.0);
    const auto at_zero = [&] {
        for (std::size_t i = 0; i + 1 < around.size(); ++i)
            if (around[i] <= 0 && around[i + 1] >= 0) {
                const double t = -around[i] / (around[i + 1] - around[i]);
                std::vector<double> row = rows[i];
                for (std::size_t k = 0; k < row.size(); ++k) row[k] += t * (rows[i + 1][k] - rows[i][k]);
                return row;
            }
        return nothing;
    }();
    add(0, at_zero);
    if (around.front() > 0) add(around.front() - table_jump, nothing);
    for (std::size_t i = 0; i < around.size(); ++i)
        if (around[i] > 0) add(around[i], rows[i]);
    add(std::max(0.0, around.back()) + table_jump, nothing);
    add(360 + std::min(0.0, around.front()) - table_jump, nothing);
    for (std::size_t i = 0; i < around.size(); ++i)
        if (around[i] < 0) add(360 + around[i], rows[i]);
    if (around.back() < 0) add(360 + around.back() + table_jump, nothing);
    add(360, at_zero);
    return circle;
}

void set_table(Photometry& p, std::vector<double> theta, const Planes& planes) {
    const auto edge = [&](bool front) {
        return std::any_of(planes.rows.begin(), planes.rows.end(),
                           [&](const std::vector<double>& row) { return (front ? row.front() : row.back()) > 0; });
    };
    // Outside its angles the table is 0. If it does not end at 0, entries are added for the jump.
    const bool below = theta.front() > rounding, above = theta.back() < 180 - rounding;
    const bool step_below = below && edge(true), step_above = above && edge(false);
    p.theta.clear(), p.candela.clear();
    if (below) p.theta.push_back(0);
    if (step_below) p.theta.push_back(theta.front() - table_jump);
    p.theta.insert(p.theta.end(), theta.begin(), theta.end());
    if (step_above) p.theta.push_back(theta.back() + table_jump);
    if (above) p.theta.push_back(180);
    const auto before = static_cast<std::size_t>(below) + static_cast<std::size_t>(step_below);
    const auto after = static_cast<std::size_t>(above) + static_cast<std::size_t>(step_above);
    p.phi = planes.angle;
    for (const std::vector<double>& row : planes.rows) {
        p.candela.insert(p.candela.end(), before, 0.0);
        p.candela.insert(p.candela.end(), row.begin(), row.end());
        p.candela.insert(p.candela.end(), after, 0.0);
    }
}

}  // namespace exitance
