#include "exitance/mesh/rectangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace exitance {
namespace {

/// The plane cut along all coordinates of the corners: which cells are inside.
class CellGrid {
  public:
    CellGrid(std::vector<double> xs, std::vector<double> ys)
        : xs_(std::move(xs)), ys_(std::move(ys)), inside_((xs_.size() - 1) * (ys_.size() - 1), 0) {}

    std::size_t columns() const { return xs_.size() - 1; }
    std::size_t rows() const { return ys_.size() - 1; }
    double x(std::size_t i) const { return xs_[i]; }
    double y(std::size_t j) const { return ys_[j]; }
    bool inside(std::size_t i, std::size_t j) const { return inside_[j * columns() + i] != 0; }

    /// Turns over every cell to the left of a vertical edge, which in the end leaves the insides.
    void flip_left_of(std::size_t i, std::size_t j0, std::size_t j1) {
        for (std::size_t j = j0; j < j1; ++j)
            for (std::size_t k = 0; k < i; ++k) inside_[j * columns() + k] ^= 1;
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

/// The cuts of least length through blocks of cells, each block's best kept in a table.
class ShortestCuts {
  public:
    explicit ShortestCuts(const CellGrid& grid)
        : g_(grid), best_(blocks_x() * blocks_y()), count_((grid.columns() + 1) * (grid.rows() + 1), 0) {
        for (std::size_t j = 0; j < g_.rows(); ++j)
            for (std::size_t i = 0; i < g_.columns(); ++i)
                at(i + 1, j + 1) = at(i, j + 1) + at(i + 1, j) - at(i, j) + (g_.inside(i, j) ? 1 : 0);
    }

    void rectangles(std::size_t i0, std::size_t i1, std::size_t j0, std::size_t j1, std::vector<Rectangle>& out) {
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
            double length = 0;
            for (std::size_t j = j0; j < j1; ++j)
                if (g_.inside(i - 1, j) && g_.inside(i, j)) length += g_.y(j + 1) - g_.y(j);
            length += solve(i0, i, j0, j1).length + solve(i, i1, j0, j1).length;
            if (length < best.length) best = {Kind::column, i, length};
        }
        for (std::size_t j = j0 + 1; j < j1; ++j) {
            double length = 0;
            for (std::size_t i = i0; i < i1; ++i)
                if (g_.inside(i, j - 1) && g_.inside(i, j)) length += g_.x(i + 1) - g_.x(i);
            length += solve(i0, i1, j0, j).length + solve(i0, i1, j, j1).length;
            if (length < best.length) best = {Kind::row, j, length};
        }
        return choice = best;
    }

    const CellGrid& g_;
    std::vector<Choice> best_;
    std::vector<int> count_;  ///< Inside cells left of and below a grid point.
};

/// Runs of inside cells in every row, a run joined to the one below when both have the same ends.
std::vector<Rectangle> row_runs(const CellGrid& g) {
    struct Run {
        std::size_t i0, i1, j0;
    };
    std::vector<Rectangle> out;
    std::vector<Run> open;
    for (std::size_t j = 0; j <= g.rows(); ++j) {
        std::vector<Run> now;
        for (std::size_t i = 0; j < g.rows() && i < g.columns(); ++i) {
            if (!g.inside(i, j)) continue;
            const std::size_t i0 = i;
            while (i < g.columns() && g.inside(i, j)) ++i;
            now.push_back({i0, i, j});
        }
        for (const Run& r : open) {
            const auto same =
                std::find_if(now.begin(), now.end(), [&](const Run& n) { return n.i0 == r.i0 && n.i1 == r.i1; });
            if (same != now.end())
                same->j0 = r.j0;
            else
                out.push_back({{g.x(r.i0), g.y(r.j0)}, {g.x(r.i1), g.y(j)}});
        }
        open = std::move(now);
    }
    return out;
}

}  // namespace

std::vector<Rectangle> tile_by_rectangles(std::span<const std::vector<Vec2>> loops, double tolerance) {
    constexpr std::size_t most_lines = 16;
    constexpr std::size_t most_cells = 4'000'000;
    std::vector<double> xs, ys;
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 d = loop[(i + 1) % loop.size()] - loop[i];
            if (std::min(std::abs(d.x), std::abs(d.y)) > tolerance) return {};
            xs.push_back(loop[i].x), ys.push_back(loop[i].y);
        }
    xs = different(std::move(xs), tolerance), ys = different(std::move(ys), tolerance);
    if (xs.size() < 2 || ys.size() < 2 || xs.size() * ys.size() > most_cells) return {};
    CellGrid grid(xs, ys);
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 &p = loop[i], &q = loop[(i + 1) % loop.size()];
            if (std::abs(p.x - q.x) > std::abs(p.y - q.y)) continue;
            const auto [lo, hi] = std::minmax({nearest(ys, p.y), nearest(ys, q.y)});
            grid.flip_left_of(nearest(xs, p.x), lo, hi);
        }
    if (xs.size() > most_lines || ys.size() > most_lines) return row_runs(grid);
    std::vector<Rectangle> out;
    ShortestCuts(grid).rectangles(0, grid.columns(), 0, grid.rows(), out);
    return out;
}

}  // namespace exitance
