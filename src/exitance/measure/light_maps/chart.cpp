#include "exitance/measure/light_maps/chart.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

namespace exitance {
namespace {

/// Key of an oriented plane, equal for planes that differ by rounding. Rare planes at a rounding threshold get
/// different keys, and their regions separate lattices.
std::array<std::int64_t, 4> plane_key(const Plane& plane, double size) {
    constexpr double angle = 1e-6;
    const double offset = 1e-6 * size;
    return {std::llround(plane.n.x / angle), std::llround(plane.n.y / angle), std::llround(plane.n.z / angle),
            std::llround(plane.offset / offset)};
}

/// The lattice of all regions of a plane.
struct Lattice {
    Vec3 right, down;  ///< Unit vectors.
    double longest = 0;
    double left = HUGE_VAL, top = HUGE_VAL;  ///< Coordinates at which texel 0 starts, metres.
};

using Lattices = std::map<std::array<std::int64_t, 4>, Lattice>;

template <class Visit>
void for_each_edge(const Region& region, const Visit& visit) {
    for (const std::vector<Point>& loop : region.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()]);
}

Lattices find_lattices(const Scene& scene) {
    Lattices lattices;
    for (const Region& region : scene.regions()) {
        Lattice& lattice = lattices[plane_key(region.plane, scene.size())];
        for_each_edge(region, [&](const Point& a, const Point& b) {
            // Edges of equal length must not be chosen by rounding.
            if (const double length = norm(b - a); length > lattice.longest * (1 + 1e-6)) {
                lattice.longest = length, lattice.right = (b - a) / length;
                lattice.down = normalized(cross(lattice.right, region.plane.n));
            }
        });
    }
    for (const Region& region : scene.regions()) {
        Lattice& lattice = lattices[plane_key(region.plane, scene.size())];
        for_each_edge(region, [&](const Point& a, const Point&) {
            lattice.left = std::min(lattice.left, dot(lattice.right, a));
            lattice.top = std::min(lattice.top, dot(lattice.down, a));
        });
    }
    return lattices;
}

/// First texel and number of texels that an interval touches along one axis; touching within rounding does not count.
std::pair<double, double> texels_along(double begin, double end, double density) {
    constexpr double rounding = 1e-6;
    const double first = std::floor(begin * density + rounding);
    return {first, std::max(1.0, std::ceil(end * density - rounding) - first)};
}

/// Upper outline of the packed rectangles: heights over intervals of the map's width.
class Skyline {
  public:
    Skyline(int width, int most) : width_(width), max_(most), steps_{{0, 0}} {}

    struct Place {
        int x = 0, y = -1;
        bool is_none() const { return y < 0; }
    };

    /// The highest position for a rectangle, the leftmost one of several; none if it does not fit.
    Place find(int width, int height) const {
        Place best;
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            if (steps_[i].x + width > width_) break;
            int y = 0;
            for (std::size_t k = i; k < steps_.size() && steps_[k].x < steps_[i].x + width; ++k)
                y = std::max(y, steps_[k].y);
            if (y + height <= max_ && (best.is_none() || y < best.y)) best = {steps_[i].x, y};
        }
        return best;
    }

    void fill(Place place, int width, int height) {
        const int end = place.x + width;
        const auto first = std::find_if(steps_.begin(), steps_.end(), [&](const Step& s) { return s.x == place.x; });
        auto last = first;
        int y = 0;
        while (last != steps_.end() && last->x < end) y = last->y, ++last;
        const bool rest = end < width_ && (last == steps_.end() || last->x > end);
        auto next = steps_.erase(first, last);
        if (rest) next = steps_.insert(next, {end, y});
        steps_.insert(next, {place.x, place.y + height});
        height_ = std::max(height_, place.y + height);
    }

    MapSize size() const { return {width_, height_}; }

  private:
    struct Step {
        int x, y;
    };
    int width_, max_, height_ = 0;
    std::vector<Step> steps_;  ///< Sorted by x; each extends to the next one.
};

int round_up(int value, int unit) {
    return (value + unit - 1) / unit * unit;
}

}  // namespace

Result<std::vector<Chart>> make_charts(const Scene& scene, double density, int most) {
    const Lattices lattices = find_lattices(scene);
    std::vector<Chart> charts;
    charts.reserve(scene.regions().size());
    for (RegionId r : scene.regions().ids()) {
        const Region& region = scene.regions()[r];
        const Lattice& lattice = lattices.at(plane_key(region.plane, scene.size()));
        double left = HUGE_VAL, right = -HUGE_VAL, top = HUGE_VAL, bottom = -HUGE_VAL;
        for_each_edge(region, [&](const Point& a, const Point&) {
            const double s = dot(lattice.right, a) - lattice.left, t = dot(lattice.down, a) - lattice.top;
            left = std::min(left, s), right = std::max(right, s);
            top = std::min(top, t), bottom = std::max(bottom, t);
        });
        const auto [column, width] = texels_along(left, right, density);
        const auto [row, height] = texels_along(top, bottom, density);
        if (!(std::max(width, height) <= most)) {
            const double longest = std::max(right - left, bottom - top);
            return Error{ErrorCode::usage,
                         "a surface " + std::to_string(longest) + " m long needs more than " + std::to_string(most) +
                             " texels along a side of a map",
                         "--density", "at most " + std::to_string(std::floor(most / longest)) + " fit"};
        }
        const Point& corner = region.loops.front().front();  // any point of the plane serves as origin
        const double s = lattice.left + (column + 0.5) / density, t = lattice.top + (row + 0.5) / density;
        Chart chart;
        chart.region = r;
        chart.origin =
            corner + (s - dot(lattice.right, corner)) * lattice.right + (t - dot(lattice.down, corner)) * lattice.down;
        chart.origin -= region.plane.signed_distance(chart.origin) * region.plane.n;
        chart.du = lattice.right / density, chart.dv = lattice.down / density;
        chart.width = static_cast<int>(width), chart.height = static_cast<int>(height);
        charts.push_back(chart);
    }
    return charts;
}

std::vector<MapSize> pack_charts(std::vector<Chart>& charts, int padding, int most, int given_width) {
    const int unit = static_cast<int>(std::bit_floor(static_cast<unsigned>(std::max(padding, 1))));
    double area = 0;
    int widest = unit;
    for (Chart& chart : charts) {
        chart.room.width = round_up(chart.width + 2 * padding, unit);
        chart.room.height = round_up(chart.height + 2 * padding, unit);
        area += static_cast<double>(chart.room.width) * chart.room.height;
        widest = std::max(widest, chart.room.width);
    }
    std::vector<std::size_t> order(charts.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const Chart::Rectangle &p = charts[a].room, &q = charts[b].room;
        return std::pair(p.height, p.width) > std::pair(q.height, q.width);
    });

    constexpr double slack = 1.05;  // parts of a map stay empty: makes the map approximately square
    const int square = static_cast<int>(std::min(std::sqrt(slack * area), static_cast<double>(most)));
    const int width = std::max(
        widest, given_width > 0 ? given_width / unit * unit : std::min(round_up(square, unit), most / unit * unit));
    std::vector<Skyline> maps;
    std::size_t first_open = 0;  // only the newest maps are searched, since older ones have little space
    for (const std::size_t i : order) {
        Chart& chart = charts[i];
        Skyline::Place place;
        std::size_t m = first_open;
        for (; m < maps.size(); ++m)
            if (place = maps[m].find(chart.room.width, chart.room.height); !place.is_none()) break;
        if (m == maps.size()) {
            maps.emplace_back(width, std::max(most / unit * unit, chart.room.height));
            first_open = maps.size() > 4 ? maps.size() - 4 : 0;
            place = maps[m].find(chart.room.width, chart.room.height);
        }
        maps[m].fill(place, chart.room.width, chart.room.height);
        chart.map = static_cast<std::uint32_t>(m);
        chart.room.x = place.x, chart.room.y = place.y;
        chart.x = place.x + padding, chart.y = place.y + padding;
    }
    std::vector<MapSize> sizes;
    for (const Skyline& map : maps) sizes.push_back(map.size());
    return sizes;
}

}  // namespace exitance
