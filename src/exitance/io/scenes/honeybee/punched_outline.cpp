#include "exitance/io/scenes/honeybee/punched_outline.hpp"

#include <algorithm>
#include <map>

#include "exitance/base/polygon.hpp"
#include "exitance/mesh/planar_subdivision.hpp"

namespace exitance {
namespace {

/// Coordinates in the plane of a face, and the corners that were converted to them.
class FacePlane {
  public:
    FacePlane(const Point& origin, const Normal& n) : origin_(origin), axes_(n) {}

    Vec2 flat(const Point& p) {
        const Vec3 d = p - origin_;
        const Vec2 at{dot(d, axes_.u), dot(d, axes_.v)};
        corners_.try_emplace({at.x, at.y}, p);
        return at;
    }
    std::vector<Vec2> flat(const std::vector<Point>& loop) {
        std::vector<Vec2> out;
        for (const Point& p : loop) out.push_back(flat(p));
        return out;
    }
    /// The corner that was converted to `at`, or the point of the plane there.
    Point solid(const Vec2& at) const {
        const auto corner = corners_.find({at.x, at.y});
        return corner != corners_.end() ? corner->second : origin_ + at.x * axes_.u + at.y * axes_.v;
    }

  private:
    Point origin_;
    Frame axes_;
    std::map<std::pair<double, double>, Point> corners_;
};

bool contains(const std::vector<Vec2>& loop, const Vec2& p) {
    bool inside = false;
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++)
        if ((loop[i].y > p.y) != (loop[j].y > p.y) &&
            p.x < loop[i].x + (p.y - loop[i].y) / (loop[j].y - loop[i].y) * (loop[j].x - loop[i].x))
            inside = !inside;
    return inside;
}

}  // namespace

std::vector<std::vector<Point>> punched(const HoneybeeOutline& outline, std::span<const HoneybeeOutline> openings) {
    const Vec3 area = area_vector(outline.boundary);
    if ((outline.holes.empty() && openings.empty()) || !(norm(area) > 0)) return {outline.boundary};
    FacePlane plane(outline.boundary.front(), normalized(area));
    const std::vector<std::vector<Vec2>> border{plane.flat(outline.boundary)};
    std::vector<std::vector<Vec2>> cuts;
    for (const std::vector<Point>& hole : outline.holes) cuts.push_back(plane.flat(hole));
    for (const HoneybeeOutline& opening : openings) cuts.push_back(plane.flat(opening.boundary));
    std::vector<LabelledSegment> segments;
    for (const std::vector<Vec2>& cut : cuts)
        for (std::size_t i = 0; i < cut.size(); ++i) segments.push_back({cut[i], cut[(i + 1) % cut.size()], 1});
    const LabelledTriangles triangles = labelled_triangles(border, segments);
    std::vector<std::vector<Point>> out;
    for (const auto& [a, b, c] : triangles.corners) {
        const Vec2 &p = triangles.points[a], &q = triangles.points[b], &r = triangles.points[c];
        const Vec2 middle{(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3};
        if (std::any_of(cuts.begin(), cuts.end(), [&](const auto& cut) { return contains(cut, middle); })) continue;
        out.push_back({plane.solid(p), plane.solid(q), plane.solid(r)});
    }
    return out;
}

}  // namespace exitance
