#include "exitance/measure/light_maps/uv_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "exitance/base/clip_convex.hpp"
#include "exitance/base/disjoint_sets.hpp"

namespace exitance {
namespace {

using Triangle2 = std::array<Vec2, 3>;

/// Share of the map's side. Coordinates that differ by less are equal: they are rounded to single precision in files
/// of scenes.
constexpr double coordinate_rounding = 1e-6;

double doubled_area(const Triangle2& t) {
    return cross(t[1] - t[0], t[2] - t[0]);
}

double longest_edge(const Triangle2& t) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 edge = t[(k + 1) % 3] - t[k];
        longest = std::max(longest, std::hypot(edge.x, edge.y));
    }
    return longest;
}

/// True if a triangle has no width in the map, relative to its length.
bool is_collapsed(const Triangle2& t) {
    constexpr double flat = 1e-9;
    const double longest = longest_edge(t);
    return !(std::abs(doubled_area(t)) > flat * longest * longest);
}

struct Bounds {
    Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};

    void add(const Triangle2& t) {
        for (const Vec2& p : t)
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)}, hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    bool is_in_unit_square() const {
        return lo.x >= -coordinate_rounding && lo.y >= -coordinate_rounding && hi.x <= 1 + coordinate_rounding &&
               hi.y <= 1 + coordinate_rounding;
    }
};

/// Numbers the charts of all objects, in the order of their first triangles.
void find_charts(const UvSet& set, UvLayout& out) {
    using Key = std::tuple<std::uint32_t, double, double, double, double, double>;
    std::vector<std::pair<Key, std::uint32_t>> corners;
    const std::size_t n = set.triangles.size();
    for (std::size_t t = 0; t < n; ++t) {
        const UvTriangle& triangle = set.triangles[t];
        if (is_collapsed(triangle.place)) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point& p = triangle.corner[k];
            corners.emplace_back(Key{triangle.object, triangle.place[k].x, triangle.place[k].y, p.x, p.y, p.z},
                                 static_cast<std::uint32_t>(t));
        }
    }
    std::sort(corners.begin(), corners.end());
    DisjointSets connected(n);
    for (std::size_t i = 1; i < corners.size(); ++i)
        if (corners[i].first == corners[i - 1].first) connected.unite(corners[i].second, corners[i - 1].second);
    std::vector<std::uint32_t> number(n, UvLayout::no_chart);
    out.chart.assign(n, UvLayout::no_chart);
    for (std::uint32_t t = 0; t < n; ++t) {
        if (is_collapsed(set.triangles[t].place)) continue;
        std::uint32_t& chart = number[connected.root(t)];
        if (chart == UvLayout::no_chart) {
            chart = static_cast<std::uint32_t>(out.charts++);
            ++out.objects[set.triangles[t].object].charts;
        }
        out.chart[t] = chart;
    }
}

/// Moves every chart that is in another unit square into the map, and counts triangles that remain outside.
void move_charts(const UvSet& set, UvLayout& out) {
    std::vector<Bounds> bounds(out.charts);
    for (std::size_t t = 0; t < set.triangles.size(); ++t)
        if (out.chart[t] != UvLayout::no_chart) bounds[out.chart[t]].add(set.triangles[t].place);
    std::vector<Vec2> shift(out.charts);
    std::vector<bool> is_counted(out.charts);
    for (std::size_t c = 0; c < out.charts; ++c) {
        const Vec2 square{std::floor(bounds[c].lo.x + coordinate_rounding),
                          std::floor(bounds[c].lo.y + coordinate_rounding)};
        const Bounds moved{bounds[c].lo - square, bounds[c].hi - square};
        if (!bounds[c].is_in_unit_square() && moved.is_in_unit_square()) shift[c] = square;
    }
    for (std::size_t t = 0; t < set.triangles.size(); ++t) {
        Triangle2 place = set.triangles[t].place;
        UvObject& object = out.objects[set.triangles[t].object];
        if (const std::uint32_t c = out.chart[t]; c != UvLayout::no_chart) {
            for (Vec2& p : place) p = p - shift[c];
            if (shift[c] != Vec2{} && !is_counted[c]) is_counted[c] = true, ++object.moved_charts;
            Bounds own;
            own.add(place);
            object.outside += !own.is_in_unit_square();
            object.mirrored += doubled_area(place) > 0;
            object.map_area += 0.5 * std::abs(doubled_area(place));
        } else {
            ++object.collapsed;
        }
        out.places.push_back(place);
    }
}

/// Triangles by the cells of a square grid over the map.
class TriangleGrid {
  public:
    explicit TriangleGrid(const UvLayout& layout) : layout_(layout) {
        constexpr int max_cells = 1024;
        constexpr double max_entries = 1e8;  ///< 400 MB
        side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(layout.places.size()))), 1, max_cells);
        while (side_ > 1 && entries() > max_entries) side_ /= 2;
        begin_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
        visit_entries([&](std::size_t cell, std::uint32_t) { ++begin_[cell + 1]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        triangles_.resize(begin_.back());
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        visit_entries([&](std::size_t cell, std::uint32_t t) { triangles_[next[cell]++] = t; });
    }

    std::size_t cells() const { return begin_.size() - 1; }
    std::span<const std::uint32_t> in_cell(std::size_t cell) const {
        return std::span(triangles_).subspan(begin_[cell], begin_[cell + 1] - begin_[cell]);
    }
    /// True if a cell is the first one that contains both triangles.
    bool is_first_common(std::size_t cell, std::uint32_t a, std::uint32_t b) const {
        const Range p = range(a), q = range(b);
        return cell == index(std::max(p.x0, q.x0), std::max(p.y0, q.y0));
    }

  private:
    struct Range {
        int x0, y0, x1, y1;
    };
    Range range(std::uint32_t t) const {
        Bounds bounds;
        bounds.add(layout_.places[t]);
        const auto cell = [&](double x) { return static_cast<int>(std::clamp(x * side_, 0.0, side_ - 1.0)); };
        return {cell(bounds.lo.x), cell(bounds.lo.y), cell(bounds.hi.x), cell(bounds.hi.y)};
    }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * side_ + x); }
    double entries() const {
        double sum = 0;
        for (std::uint32_t t = 0; t < layout_.places.size(); ++t) {
            const Range r = range(t);
            sum += (r.x1 - r.x0 + 1.0) * (r.y1 - r.y0 + 1.0);
        }
        return sum;
    }
    template <class Visit>
    void visit_entries(const Visit& visit) const {
        for (std::uint32_t t = 0; t < layout_.places.size(); ++t) {
            if (layout_.chart[t] == UvLayout::no_chart) continue;
            const Range r = range(t);
            for (int y = r.y0; y <= r.y1; ++y)
                for (int x = r.x0; x <= r.x1; ++x) visit(index(x, y), t);
        }
    }

    const UvLayout& layout_;
    int side_ = 1;
    std::vector<std::size_t> begin_;
    std::vector<std::uint32_t> triangles_;
};

bool overlap(const Triangle2& a, const Triangle2& b) {
    return common_area(a, b) > coordinate_rounding * std::min(longest_edge(a), longest_edge(b));
}

/// Marks triangles that overlap others of their object, and objects that overlap each other.
class OverlapFinder {
  public:
    OverlapFinder(const UvSet& set, UvLayout& out) : set_(set), out_(out), grid_(out) {}

    void find() {
        out_.is_overlapped.assign(set_.triangles.size(), 0);
        for (cell_ = 0; cell_ < grid_.cells(); ++cell_) {
            const std::span<const std::uint32_t> triangles = grid_.in_cell(cell_);
            find_runs(triangles);
            for (const std::uint32_t a : triangles) compare(a, triangles);
        }
        for (std::size_t t = 0; t < set_.triangles.size(); ++t)
            out_.objects[set_.triangles[t].object].overlapping += out_.is_overlapped[t];
    }

  private:
    /// For each triangle of a cell, finds the first one of the next object in the list, which is sorted by objects.
    void find_runs(std::span<const std::uint32_t> triangles) {
        next_object_.resize(triangles.size());
        for (std::size_t i = triangles.size(); i-- > 0;) {
            const bool is_last = i + 1 == triangles.size() || object(triangles[i]) != object(triangles[i + 1]);
            next_object_[i] = is_last ? i + 1 : next_object_[i + 1];
        }
    }

    /// Compares one triangle with the others of its cell, until it overlaps one of its object and one of another.
    void compare(std::uint32_t a, std::span<const std::uint32_t> triangles) {
        UvObject& own = out_.objects[object(a)];
        for (std::size_t j = 0; j < triangles.size();) {
            const std::uint32_t b = triangles[j];
            const bool is_same = object(a) == object(b);
            if (is_same ? out_.is_overlapped[a] != 0 : own.overlaps_others) {
                j = next_object_[j];
                continue;
            }
            ++j;
            if (a == b || !grid_.is_first_common(cell_, a, b) || !overlap(out_.places[a], out_.places[b])) continue;
            if (is_same)
                out_.is_overlapped[a] = out_.is_overlapped[b] = 1;
            else
                own.overlaps_others = out_.objects[object(b)].overlaps_others = true;
        }
    }

    std::uint32_t object(std::uint32_t t) const { return set_.triangles[t].object; }

    const UvSet& set_;
    UvLayout& out_;
    TriangleGrid grid_;
    std::size_t cell_ = 0;
    std::vector<std::size_t> next_object_;
};

}  // namespace

double common_area(const Triangle2& a, const Triangle2& b) {
    std::vector<Vec2> polygon(a.begin(), a.end()), rest;
    const double side = doubled_area(b) < 0 ? -1 : 1;
    for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
        const Vec2 from = b[k], edge = b[(k + 1) % 3] - b[k];
        clip_convex<Vec2>(
            polygon, [&](const Vec2& p) { return side * cross(edge, p - from); }, rest);
        polygon.swap(rest);
    }
    double area = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        area += 0.5 * cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return std::abs(area);
}

UvLayout lay_out(const UvSet& set) {
    UvLayout out;
    for (const std::string& name : set.objects) out.objects.push_back({.name = name});
    for (const UvTriangle& t : set.triangles) {
        UvObject& object = out.objects[t.object];
        ++object.triangles;
        object.area += 0.5 * norm(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
    }
    find_charts(set, out);
    move_charts(set, out);
    OverlapFinder(set, out).find();
    const bool share = std::none_of(out.objects.begin(), out.objects.end(),
                                    [](const UvObject& object) { return object.overlaps_others; });
    if (share) return out;
    out.maps = 0;
    for (UvObject& object : out.objects)
        if (object.triangles > 0) object.map = static_cast<std::uint32_t>(out.maps++);
    return out;
}

}  // namespace exitance
