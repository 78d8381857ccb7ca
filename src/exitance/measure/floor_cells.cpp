#include "exitance/measure/floor_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

constexpr double cell_width = 0.1;   ///< Metres; derived from the narrowest corridors, which are ten times as wide.
constexpr double max_cells = 40000;  ///< Derived from half a second of ray casting.
/// Minimum number of cells along the shorter side, derived from models at a tenth of their size.
constexpr double min_across = 20;
/// Position of the first centre, in cells: derived from the golden section, so that walls at round numbers do not pass
/// through centres.
constexpr double first_centre = 0.118;
constexpr double furniture_height = 1.9;  ///< Metres; derived from the height of people: lower spaces are not rooms.
constexpr double furniture_share =        ///< Share of the usual height; derived from cupboards in models out of scale.
    0.7;
constexpr double door_height = 2.15;    ///< Metres, derived from doors of 2.0 to 2.1 m.
constexpr double door_share = 0.78;     ///< Share of the height, derived from doors of 2.1 m below ceilings of 2.7 m.
constexpr double min_lintel = 0.1;      ///< Share of the height, derived from doors of 2.1 m below ceilings of 2.35 m.
constexpr double below_ceiling = 0.98;  ///< Share of the height, derived from sheets just below a ceiling.
/// Number of rays per pair of neighbouring cells, derived from beams that block only one of them.
constexpr std::size_t heights = 4;

}  // namespace

FloorCells::FloorCells(Floor floor, double top, const RayTracer& tracer)
    : floor_(std::move(floor)), tracer_(&tracer), frame_(rectangle_about(floor_)) {
    const double length = norm(frame_.u), breadth = norm(frame_.v);
    u_ = normalized(frame_.u), v_ = normalized(frame_.v);
    width_ =
        std::max(std::min(cell_width, std::min(length, breadth) / min_across), std::sqrt(length * breadth / max_cells));
    columns_ = static_cast<std::size_t>(std::ceil(length / width_)) + 1;
    rows_ = static_cast<std::size_t>(std::ceil(breadth / width_)) + 1;
    part_.assign(columns_ * rows_, none);
    measure_heights(top);
    join_cells();
    find_parts();
}

Point FloorCells::centre(std::size_t cell) const {
    const double column = static_cast<double>(cell % columns_), row = static_cast<double>(cell / columns_);
    return frame_.origin + (column + first_centre) * width_ * u_ + (row + first_centre) * width_ * v_;
}

/// Casts a ray upwards from every cell on the floor, and marks these cells by part 0.
void FloorCells::measure_heights(double top) {
    free_.assign(size(), 0), is_open_.assign(size(), 0), is_inside_.assign(size(), 0);
    parallel_for(size(), 64, [&](std::size_t i) {
        const Point p = centre(i);
        const std::size_t shape = floor_.shape_at(p);
        if (shape == floor_.shapes.size()) return;
        part_[i] = 0;
        const Vec3 up = floor_.shapes[shape].plane.n;
        RayHit hit;
        tracer_->nearest(std::span(&up, 1), p, floor_.shapes[shape].region, std::span(&hit, 1));
        is_open_[i] = hit.surface.is_none(), is_inside_[i] = !is_open_[i] && !hit.front;
        free_[i] = is_open_[i] ? std::max(0.0, top - p.z) : hit.distance;
    });
    // Below furniture the height of the nearest free cell counts. It spreads ring by ring, in the order of cells.
    std::vector<double> known;
    for (std::size_t i = 0; i < size(); ++i)
        if (part_[i] == 0) known.push_back(free_[i]);
    if (known.empty()) return;
    std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2), known.end());
    const double least = std::min(furniture_height, furniture_share * known[known.size() / 2]);
    height_ = free_;
    std::vector<std::size_t> ring, next;
    std::vector<std::uint8_t> is_known(size());
    for (std::size_t i = 0; i < size(); ++i)
        if (part_[i] == 0 && free_[i] >= least) is_known[i] = 1, ring.push_back(i);
    for (; !ring.empty(); ring.swap(next), next.clear())
        for (const std::size_t i : ring)
            for (const std::ptrdiff_t step :
                 {std::ptrdiff_t{-1}, std::ptrdiff_t{1}, -static_cast<std::ptrdiff_t>(columns_),
                  static_cast<std::ptrdiff_t>(columns_)}) {
                const auto j = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + step);
                if (j >= size() || part_[j] == none || is_known[j]) continue;
                is_known[j] = 1, height_[j] = height_[i], next.push_back(j);
            }
}

bool FloorCells::is_wall_between(const Point& p, const Point& q, double height) const {
    if (!(height > 0)) return false;
    const double low = std::max(door_share * height, std::min(door_height, (1 - min_lintel) * height));
    std::array<Point, heights> from, to;
    std::array<bool, heights> blocked{};
    for (std::size_t k = 0; k < heights; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(heights - 1);
        const Vec3 rise{0, 0, low + share * (below_ceiling * height - low)};
        from[k] = p + rise, to[k] = q + rise;
    }
    tracer_->occluded(from, to, RegionId(), RegionId(), blocked);
    return std::all_of(blocked.begin(), blocked.end(), [](bool b) { return b; });
}

bool FloorCells::are_linked(std::size_t a, std::size_t b) const {
    if (part_[a] == none || part_[b] == none) return false;
    const Point p = centre(a), q = centre(b);
    return !is_wall_between(p, q, height_[a]) && (height_[a] == height_[b] || !is_wall_between(p, q, height_[b]));
}

/// Joins neighbouring cells without a wall between them, and numbers the parts by their first cells.
void FloorCells::join_cells() {
    // per cell: whether it is joined to the next column, and to the next row
    std::vector<std::array<std::uint8_t, 2>> links(size());
    parallel_for(size(), 64, [&](std::size_t i) {
        links[i][0] = i % columns_ + 1 < columns_ && are_linked(i, i + 1);
        links[i][1] = i + columns_ < size() && are_linked(i, i + columns_);
    });
    DisjointSets sets(size());
    for (std::size_t i = 0; i < size(); ++i) {
        if (links[i][0]) sets.unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1));
        if (links[i][1]) sets.unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + columns_));
    }
    std::vector<std::uint32_t> number(size(), none);
    for (std::size_t i = 0; i < size(); ++i) {
        if (part_[i] == none) continue;
        std::uint32_t& at = number[sets.root(static_cast<std::uint32_t>(i))];
        if (at == none) at = static_cast<std::uint32_t>(parts_.size()), parts_.emplace_back();
        part_[i] = at;
    }
}

void FloorCells::find_parts() {
    std::vector<std::vector<double>> free(parts_.size());
    std::vector<std::size_t> open(parts_.size()), inside(parts_.size());
    for (std::size_t i = 0; i < size(); ++i)
        if (part_[i] != none)
            free[part_[i]].push_back(free_[i]), open[part_[i]] += is_open_[i], inside[part_[i]] += is_inside_[i];
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        Part& part = parts_[k];
        part.cells = free[k].size(), part.area = static_cast<double>(part.cells) * width_ * width_;
        const std::size_t upper = 3 * part.cells / 4;
        std::nth_element(free[k].begin(), free[k].begin() + static_cast<std::ptrdiff_t>(upper), free[k].end());
        part.height = free[k][upper], part.has_ceiling = 2 * open[k] <= part.cells;
        part.is_inside_body = 2 * inside[k] > part.cells;
    }
    // Side of the largest square of one part's cells that ends at each cell, in cells.
    std::vector<std::uint32_t> side(size());
    for (std::size_t i = 0; i < size(); ++i) {
        if (part_[i] == none) continue;
        const bool is_first = i % columns_ == 0 || i < columns_;
        const auto same = [&](std::size_t j) { return part_[j] == part_[i] ? side[j] : 0; };
        side[i] = 1 + (is_first ? 0 : std::min({same(i - 1), same(i - columns_), same(i - columns_ - 1)}));
        double& breadth = parts_[part_[i]].breadth;
        breadth = std::max(breadth, side[i] * width_);
    }
}

std::vector<FloorCells::Edge> FloorCells::edges(std::uint32_t part) const {
    const std::array<Vec3, 4> ways{width_ * u_, -width_ * u_, width_ * v_, -width_ * v_};
    std::vector<Edge> out;
    for (std::size_t i = 0; i < size(); ++i) {
        if (part_[i] != part) continue;
        const std::size_t column = i % columns_;
        const std::array<bool, 4> is_last{column + 1 == columns_, column == 0, i + columns_ >= size(), i < columns_};
        const std::array<std::size_t, 4> next{i + 1, i - 1, i + columns_, i - columns_};
        for (std::size_t k = 0; k < ways.size(); ++k) {
            if (!is_last[k] && part_[next[k]] == part) continue;
            const Point p = centre(i), q = p + ways[k];
            const bool is_linked =
                is_last[k] || part_[next[k]] == none ? !is_wall_between(p, q, height_[i]) : are_linked(i, next[k]);
            out.push_back({p, q, !is_linked});
        }
    }
    return out;
}

std::size_t FloorCells::cell_of(std::uint32_t part, const Point& p) const {
    const Vec3 d = p - frame_.origin;
    const auto column = static_cast<std::ptrdiff_t>(std::lround(dot(d, u_) / width_ - first_centre));
    const auto row = static_cast<std::ptrdiff_t>(std::lround(dot(d, v_) / width_ - first_centre));
    constexpr std::array<std::array<std::ptrdiff_t, 2>, 9> around{
        {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
    for (const auto& [right, up] : around) {
        const std::ptrdiff_t x = column + right, y = row + up;
        if (x < 0 || y < 0 || x >= static_cast<std::ptrdiff_t>(columns_) || y >= static_cast<std::ptrdiff_t>(rows_))
            continue;
        const auto cell = static_cast<std::size_t>(y) * columns_ + static_cast<std::size_t>(x);
        if (part_[cell] == part && !is_wall_between(centre(cell), p, height_[cell])) return cell;
    }
    return size();
}

bool FloorCells::holds(std::uint32_t part, const Point& p, double border) const {
    constexpr int places = 24;
    if (!floor_.holds(p)) return false;
    const std::size_t cell = cell_of(part, p);
    if (cell == size()) return false;
    for (int i = 0; i < places && border > 0; ++i) {
        const double a = 2 * pi * i / places;
        const Point place = p + border * std::cos(a) * u_ + border * std::sin(a) * v_;
        if (!floor_.holds(place) || is_wall_between(p, place, height_[cell])) return false;
    }
    return true;
}

/// Distance from a cell's centre to the wall or outline in a direction, metres, by bisection.
double FloorCells::reach(std::size_t cell, const Vec3& way) const {
    constexpr int halvings = 40;
    constexpr double far = 1.5;  // cells; derived from the distance to the next but one cell's centre
    const Point p = centre(cell);
    const auto is_open = [&](double t) {
        return floor_.holds(p + t * way) && !is_wall_between(p, p + t * way, height_[cell]);
    };
    double within = 0, beyond = far * width_;
    if (is_open(beyond)) return beyond;
    for (int i = 0; i < halvings; ++i) {
        const double t = 0.5 * (within + beyond);
        (is_open(t) ? within : beyond) = t;
    }
    return within;
}

MeasuringPlane FloorCells::rectangle(std::uint32_t part) const {
    const std::array<Vec3, 4> ways{u_, -1 * u_, v_, -1 * v_};
    const Vec3 whole{norm(frame_.u), norm(frame_.v), 0};
    std::array<double, 4> most{};
    for (std::size_t k = 0; k < ways.size(); ++k) {
        double far = -HUGE_VAL;
        for (std::size_t i = 0; i < size(); ++i)
            if (part_[i] == part) far = std::max(far, dot(centre(i) - frame_.origin, ways[k]));
        most[k] = far;
        for (std::size_t i = 0; i < size(); ++i) {
            if (part_[i] != part) continue;
            const double at = dot(centre(i) - frame_.origin, ways[k]);
            if (at > far - width_) most[k] = std::max(most[k], at + reach(i, ways[k]));
        }
        // The sides of the whole floor are known exactly: a side of a part within `snap` of one is moved onto it.
        constexpr double snap = 1e-4;  // metres; derived from the accuracy of ray hits
        const double side = k % 2 == 1 ? 0 : k == 0 ? whole.x : whole.y;
        if (std::abs(most[k] - side) < snap) most[k] = side;
    }
    return {frame_.origin - most[1] * u_ - most[3] * v_, (most[0] + most[1]) * u_, (most[2] + most[3]) * v_};
}

}  // namespace exitance
