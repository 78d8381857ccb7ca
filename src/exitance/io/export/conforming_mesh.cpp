#include "exitance/io/export/conforming_mesh.hpp"

#include <algorithm>

#include "exitance/base/bvh.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/scene/joining/weld.hpp"

namespace exitance {
namespace {

using Values = std::array<float, bands>;

/// Distance, in metres, within which corners are merged: eight units of single precision at the largest coordinate. A
/// strip of one unit's width has an arbitrary normal; at this width the normal is tilted by less than 0.1.
double tolerance_of(const ElementMesh& mesh) {
    double largest = 0;
    for (const Point& p : mesh.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return 0x1p-21 * largest;
}

Values between(const Values& a, const Values& b, double t) {
    Values out;
    for (std::size_t i = 0; i < bands; ++i)
        out[i] = static_cast<float>(std::lerp(static_cast<double>(a[i]), static_cast<double>(b[i]), t));
    return out;
}

/// A corner of an output polygon: its position, and the edge of the input mesh between whose ends its values are
/// interpolated at `t`.
struct Corner {
    std::uint32_t place, from, to;
    double t = 0;
};

class Conformer {
  public:
    explicit Conformer(const ElementMesh& mesh)
        : mesh_(mesh), tolerance_(tolerance_of(mesh)), place_(weld(mesh.points, tolerance_)) {
        std::vector<Box> boxes;
        for (std::size_t polygon = 0; polygon < mesh.size(); ++polygon)
            for (std::uint32_t i = mesh.first_point[polygon]; i < mesh.first_point[polygon + 1]; ++i)
                corners_.emplace_back(mesh.region[polygon], place_[i]);
        std::sort(corners_.begin(), corners_.end());
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
        for (const auto& [region, place] : corners_) {
            boxes.emplace_back();
            boxes.back().add(mesh_.points[place]);
        }
        tree_ = Bvh(boxes);
    }

    /// Corners of a polygon and, on its edges, those of others; empty if it has no area. Consecutive corners always
    /// differ in position.
    std::vector<Corner> corners(std::size_t polygon) const {
        std::vector<std::uint32_t> own;
        const std::uint32_t begin = mesh_.first_point[polygon], end = mesh_.first_point[polygon + 1];
        for (std::uint32_t i = begin; i < end; ++i)
            if (own.empty() || place_[i] != place_[own.back()]) own.push_back(i);
        while (own.size() > 1 && place_[own.front()] == place_[own.back()]) own.pop_back();
        std::vector<Corner> out;
        if (own.size() < 3 || is_sliver(own)) return out;
        for (std::size_t k = 0; k < own.size(); ++k) {
            out.push_back({place_[own[k]], own[k], own[k]});
            add_on_edge(own[k], own[(k + 1) % own.size()], mesh_.region[polygon], out);
        }
        return out;
    }

    const Point& point(std::uint32_t place) const { return mesh_.points[place]; }

  private:
    /// True if a polygon is nowhere wider than the tolerance.
    bool is_sliver(std::span<const std::uint32_t> corners) const {
        std::vector<Point> outline;
        for (const std::uint32_t i : corners) outline.push_back(point(place_[i]));
        double longest = 0;
        for (std::size_t i = 1; i < outline.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) longest = std::max(longest, norm(outline[i] - outline[k]));
        return norm(area_vector(outline)) <= 0.5 * tolerance_ * longest;
    }

    void add_on_edge(std::uint32_t from, std::uint32_t to, std::int32_t region, std::vector<Corner>& out) const {
        const Point &a = point(place_[from]), &b = point(place_[to]);
        const Vec3 along = b - a, slack = Vec3{1, 1, 1} * tolerance_;
        const double length_squared = squared_norm(along);
        Box box;
        box.add(a), box.add(b);
        box.lo -= slack, box.hi += slack;
        const std::size_t first = out.size();
        tree_.visit_box(box, [&](std::uint32_t i) {
            const auto [other, place] = corners_[i];
            if (other != region || place == place_[from] || place == place_[to]) return;
            const Vec3 r = point(place) - a;
            const double t = dot(r, along) / length_squared;
            if (t > 0 && t < 1 && squared_norm(r - t * along) <= tolerance_ * tolerance_)
                out.push_back({place, from, to, t});
        });
        std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                  [](const Corner& x, const Corner& y) { return std::pair(x.t, x.place) < std::pair(y.t, y.place); });
    }

    const ElementMesh& mesh_;
    double tolerance_;
    std::vector<std::uint32_t> place_;                             ///< Per point: the first point at the same position.
    std::vector<std::pair<std::int32_t, std::uint32_t>> corners_;  ///< Region and position of every corner of a region.
    Bvh tree_;
};

}  // namespace

ConformingMesh make_conforming(const ElementMesh& mesh) {
    const Conformer conformer(mesh);
    std::vector<std::vector<Corner>> corners(mesh.size());
    parallel_for(mesh.size(), 256, [&](std::size_t i) { corners[i] = conformer.corners(i); });
    ConformingMesh out;
    ElementMesh& m = out.mesh;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (corners[i].empty()) continue;
        const bool has_middle = std::any_of(corners[i].begin(), corners[i].end(), [](auto& c) { return c.t > 0; });
        Point middle;
        Spectrum irradiance, radiosity;
        double own = 0;
        for (const Corner& c : corners[i]) {
            m.points.push_back(conformer.point(c.place));
            m.irradiance.push_back(between(mesh.irradiance[c.from], mesh.irradiance[c.to], c.t));
            m.radiosity.push_back(between(mesh.radiosity[c.from], mesh.radiosity[c.to], c.t));
            if (c.t > 0) continue;
            own += 1, middle += m.points.back();
            for (std::size_t b = 0; b < bands; ++b) {
                irradiance[b] += static_cast<double>(m.irradiance.back()[b]);
                radiosity[b] += static_cast<double>(m.radiosity.back()[b]);
            }
        }
        if (has_middle) {
            m.points.push_back(middle / own);
            m.irradiance.emplace_back(), m.radiosity.emplace_back();
            for (std::size_t b = 0; b < bands; ++b) {
                m.irradiance.back()[b] = static_cast<float>(irradiance[b] / own);
                m.radiosity.back()[b] = static_cast<float>(radiosity[b] / own);
            }
        }
        m.first_point.push_back(static_cast<std::uint32_t>(m.points.size()));
        m.surface.push_back(mesh.surface[i]), m.region.push_back(mesh.region[i]);
        m.material.push_back(mesh.material[i]), m.group.push_back(mesh.group[i]);
        out.has_middle.push_back(has_middle);
    }
    return out;
}

}  // namespace exitance
