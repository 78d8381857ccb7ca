#include "exitance/mesh/rectangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace exitance {
namespace {

/// Grid of the plane along all coordinates of corners, with a flag per cell: inside or outside the polygon.
class CellGrid {
  public:
    CellGrid(std::vector<double> xs, std::vector<double> ys)
        : xs_(std::move(xs)), ys_(std::move(ys)), inside_((xs_.size() - 1) * (ys_.size() - 1), 0) {}

    std::size_t columns() const { return xs_.size() - 1; }
    std::size_t rows() const { return ys_.size() - 1; }
    double x(std::size_t i) const { return xs_[i]; }
    double y(std::size_t j) const { return ys_[j]; }
    bool inside(std::size_t i, std::size_t j) const { return inside_[j * columns() + i] != 0; }

    /// Records a vertical edge. resolve() then inverts all cells to its left; cells inside are set after that.
    void add_edge(std::size_t i, std::size_t j0, std::size_t j1) {
        for (std::size_t j = j0; i > 0 && j < j1; ++j) inside_[j * columns() + i - 1] ^= 1;
    }
    void resolve() {
        for (std::size_t j = 0; j < rows(); ++j)
            for (std::size_t i = columns() - 1; i-- > 0;) inside_[j * columns() + i] ^= inside_[j * columns() + i + 1];
    }

    /// A block of cells as a grid of its own.
    CellGrid block(std::size_t i0, std::size_t i1, std::size_t j0, std::size_t j1) const {
        const auto part = [](const std::vector<double>& v, std::size_t first, std::size_t last) {
            return std::vector<double>(&v[first], &v[last] + 1);
        };
        CellGrid out(part(xs_, i0, i1), part(ys_, j0, j1));
        for (std::size_t j = j0; j < j1; ++j)
            std::copy_n(&inside_[j * columns() + i0], i1 - i0, &out.inside_[(j - j0) * (i1 - i0)]);
        return out;
    }
    /// Length of the part inside the polygon of the line between two columns (or rows).
    double length_between_columns(std::size_t i, std::size_t j0, std::size_t j1) const {
        double length = 0;
        for (std::size_t j = j0; j < j1; ++j)
            if (inside(i - 1, j) && inside(i, j)) length += ys_[j + 1] - ys_[j];
        return length;
    }
    double length_between_rows(std::size_t j, std::size_t i0, std::size_t i1) const {
        double length = 0;
        for (std::size_t i = i0; i < i1; ++i)
            if (inside(i, j - 1) && inside(i, j)) length += xs_[i + 1] - xs_[i];
        return length;
    }

  private:
    std::vector<double> xs_, ys_;
    std::vector<std::uint8_t> inside_;
};

std::vector<double> different(std::vector<double> values, double tolerance) {
    std::sort(values.begin(), values.end());
    std::vector<double> out;
    for (double v : values)
        if (out.empty() || v - out.back() > tolerance) out.push_back(v);
    return out;
}

std::size_t nearest(const std::vector<double>& values, double v) {
    const auto above = static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), v) - values.begin());
    if (above == values.size()) return above - 1;
    return above > 0 && v - values[above - 1] < values[above] - v ? above - 1 : above;
}

/// Finds the shortest cuts through blocks of cells by dynamic programming; the best cut of each block is stored in a
/// table.
class ShortestCuts {
  public:
    explicit ShortestCuts(const CellGrid& grid)
        : g_(grid), best_(blocks_x() * blocks_y()), count_((grid.columns() + 1) * (grid.rows() + 1), 0) {
        for (std::size_t j = 0; j < g_.rows(); ++j)
            for (std::size_t i = 0; i < g_.columns(); ++i)
                at(i + 1, j + 1) = at(i, j + 1) + at(i + 1, j) - at(i, j) + (g_.inside(i, j) ? 1 : 0);
    }

    void rectangles(std::size_t i0, std::size_t i1, std::size_t j0, std::size_t j1, std::vector<AxisRectangle>& out) {
        const Choice& c = solve(i0, i1, j0, j1);
        if (c.kind == Kind::full) out.push_back({{g_.x(i0), g_.y(j0)}, {g_.x(i1), g_.y(j1)}});
        if (c.kind == Kind::column) rectangles(i0, c.where, j0, j1, out), rectangles(c.where, i1, j0, j1, out);
        if (c.kind == Kind::row) rectangles(i0, i1, j0, c.where, out), rectangles(i0, i1, c.where, j1, out);
    }

  private:
    enum class Kind : std::uint8_t { unknown, empty, full, column, row };
    struct Choice {
        Kind kind = Kind::unknown;
        std::size_t where = 0;
        double length = 0;
    };

    std::size_t blocks_x() const { return (g_.columns() + 1) * (g_.columns() + 1); }
    std::size_t blocks_y() const { return (g_.rows() + 1) * (g_.rows() + 1); }
    int& at(std::size_t i, std::size_t j) { return count_[j * (g_.columns() + 1) + i]; }

    const Choice& solve(std::size_t i0, std::size_t i1, std::size_t j0, std::size_t j1) {
        Choice& choice = best_[(i0 * (g_.columns() + 1) + i1) * blocks_y() + j0 * (g_.rows() + 1) + j1];
        if (choice.kind != Kind::unknown) return choice;
        const int filled = at(i1, j1) - at(i0, j1) - at(i1, j0) + at(i0, j0);
        if (filled == 0) return choice.kind = Kind::empty, choice;
        if (filled == static_cast<int>((i1 - i0) * (j1 - j0))) return choice.kind = Kind::full, choice;
        Choice best{Kind::unknown, 0, std::numeric_limits<double>::infinity()};
        for (std::size_t i = i0 + 1; i < i1; ++i) {
            const double length =
                g_.length_between_columns(i, j0, j1) + solve(i0, i, j0, j1).length + solve(i, i1, j0, j1).length;
            if (length < best.length) best = {Kind::column, i, length};
        }
        for (std::size_t j = j0 + 1; j < j1; ++j) {
            const double length =
                g_.length_between_rows(j, i0, i1) + solve(i0, i1, j0, j).length + solve(i0, i1, j, j1).length;
            if (length < best.length) best = {Kind::row, j, length};
        }
        return choice = best;
    }

    const CellGrid& g_;
    std::vector<Choice> best_;
    std::vector<int> count_;  ///< Number of inside cells left of and below a grid point.
};

/// Tiles a grid of any size. A grid too large for the table is first divided along the shortest line in its middle
/// half.
void tile(const CellGrid& g, std::vector<AxisRectangle>& out) {
    // maximum numbers of columns and rows; the table takes O(max_table_cells^5) time
    constexpr std::size_t max_table_cells = 12;
    const std::size_t m = g.columns(), n = g.rows();
    if (m <= max_table_cells && n <= max_table_cells) return ShortestCuts(g).rectangles(0, m, 0, n, out);
    const bool across = m >= n;
    const std::size_t count = across ? m : n;
    std::size_t where = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t k = count / 4 + 1; k <= count - count / 4 - 1; ++k) {
        const double length = across ? g.length_between_columns(k, 0, n) : g.length_between_rows(k, 0, m);
        if (length < shortest) shortest = length, where = k;
    }
    tile(across ? g.block(0, where, 0, n) : g.block(0, m, 0, where), out);
    tile(across ? g.block(where, m, 0, n) : g.block(0, m, where, n), out);
}

}  // namespace

std::vector<AxisRectangle> tile_by_rectangles(std::span<const std::vector<Vec2>> loops, double tolerance) {
    constexpr std::size_t max_cells = 4'000'000;
    std::vector<double> xs, ys;
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 d = loop[(i + 1) % loop.size()] - loop[i];
            if (std::min(std::abs(d.x), std::abs(d.y)) > tolerance) return {};
            xs.push_back(loop[i].x), ys.push_back(loop[i].y);
        }
    xs = different(std::move(xs), tolerance), ys = different(std::move(ys), tolerance);
    if (xs.size() < 2 || ys.size() < 2 || xs.size() * ys.size() > max_cells) return {};
    CellGrid grid(xs, ys);
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 &p = loop[i], &q = loop[(i + 1) % loop.size()];
            if (std::abs(p.x - q.x) > std::abs(p.y - q.y)) continue;
            const auto [lo, hi] = std::minmax({nearest(ys, p.y), nearest(ys, q.y)});
            grid.add_edge(nearest(xs, p.x), lo, hi);
        }
    grid.resolve();
    std::vector<AxisRectangle> out;
    tile(grid, out);
    return out;
}

}  // namespace exitance
