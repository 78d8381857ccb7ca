#include "exitance/visibility/convex_blockers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace exitance {
namespace {

using Place = std::array<std::int64_t, 3>;

/// Regions whose borders are single convex loops, joined along shared edges.
class Bodies {
  public:
    Bodies(const Occluders& occluders, double slack) : occluders_(occluders), slack_(slack) {
        const Scene& scene = occluders.scene();
        parent_.resize(scene.regions().size());
        std::iota(parent_.begin(), parent_.end(), 0u);
        spoilt_.assign(parent_.size(), false);
        for (RegionId r : scene.regions().ids()) add_edges(r);
        match_edges();
    }

    /// Groups of regions that form a convex body, in the order of their first regions. A body that is open on one side,
    /// such as a house on the ground, blocks as if it were closed if nothing is inside: whatever enters through the
    /// opening hits a face from behind.
    std::vector<ConvexBlocker> solids(std::vector<bool>& used) {
        std::map<std::uint32_t, std::vector<RegionId>> groups;
        for (std::uint32_t r = 0; r < parent_.size(); ++r) groups[root(r)].push_back(RegionId(r));
        std::vector<ConvexBlocker> found;
        for (const auto& [first, group] : groups) {
            const bool sound = std::none_of(group.begin(), group.end(), [&](RegionId r) { return spoilt_[r.value]; });
            const auto open = open_.find(first);
            const bool is_open = open != open_.end();
            if (!sound || group.size() + is_open < 4 || group.size() + is_open > ConvexBlocker::max_faces) continue;
            ConvexBlocker body = make_body(group, is_open ? open->second : std::vector<Side>());
            if (body.points.empty() || !is_convex_body(body)) continue;
            if (is_open && holds_a_face(body, group)) continue;
            for (RegionId r : group) used[r.value] = true;
            found.push_back(std::move(body));
        }
        return found;
    }

  private:
    struct Side {
        Place from, to;
        std::uint32_t region;
    };

    Place place(const Point& p) const {
        const double grid = 4 * slack_;
        return {std::llround(p.x / grid), std::llround(p.y / grid), std::llround(p.z / grid)};
    }

    void add_edges(RegionId r) {
        const Region& region = occluders_.scene().regions()[r];
        const IdRange<PieceId> pieces = occluders_.pieces(r);
        if (pieces.size() != 1 || region.loops.size() != 1) {
            spoilt_[r.value] = true;
            return;
        }
        const std::span<const Point> loop = occluders_.corners(pieces.front());
        for (std::size_t i = 0; i < loop.size(); ++i)
            sides_.push_back({place(loop[i]), place(loop[(i + 1) % loop.size()]), r.value});
    }

    /// Every edge of a closed body occurs exactly once in each direction. A region with any other edge disqualifies its
    /// group.
    void match_edges() {
        std::map<std::pair<Place, Place>, std::vector<std::uint32_t>> by_ends;
        for (const Side& side : sides_) by_ends[{side.from, side.to}].push_back(side.region);
        for (const auto& [ends, regions] : by_ends) {
            const auto back = by_ends.find({ends.second, ends.first});
            const bool matched = regions.size() == 1 && back != by_ends.end() && back->second.size() == 1;
            const bool open = regions.size() == 1 && back == by_ends.end();
            for (std::uint32_t r : regions) {
                if (!matched && !open) spoilt_[r] = true;
                if (back != by_ends.end())
                    for (std::uint32_t other : back->second) parent_[root(other)] = root(r);
            }
        }
        for (const Side& side : sides_)
            if (!by_ends.contains({side.to, side.from})) open_[root(side.region)].push_back(side);
    }

    /// Adds the face that closes a body. `open`: the body's edges with a face on one side only. Returns false unless
    /// they form one planar loop.
    bool add_cap(const std::vector<Side>& open, std::map<Place, std::uint32_t>& numbers, ConvexBlocker& body) const {
        std::map<std::uint32_t, std::uint32_t> next;
        for (const Side& side : open)
            if (!next.try_emplace(numbers.at(side.to), numbers.at(side.from)).second) return false;
        std::vector<std::uint32_t> loop;
        for (std::uint32_t at = next.begin()->first; loop.size() < next.size(); at = next[at]) {
            if (!next.contains(at)) return false;
            loop.push_back(at);
        }
        if (loop.size() < 3 || next[loop.back()] != loop.front()) return false;
        std::vector<Point> corners;
        for (std::uint32_t c : loop) corners.push_back(body.points[c]);
        const Vec3 area = area_vector(corners);
        if (!(norm(area) > slack_ * slack_)) return false;
        const Normal n = normalized(area);
        const Plane plane{n, dot(n, corners[0])};
        for (const Point& p : corners)
            if (std::abs(plane.signed_distance(p)) > slack_) return false;
        body.faces.push_back(plane);
        body.loops.push_back(std::move(loop));
        return true;
    }

    /// Returns whether any face of the scene outside the group reaches into a body.
    bool holds_a_face(const ConvexBlocker& body, const std::vector<RegionId>& group) const {
        const Scene& scene = occluders_.scene();
        Box inner;
        for (const Point& p : body.points) inner.add(p);
        std::vector<Point> inside, next;
        for (const Surface& surface : scene.surfaces()) {
            if (std::find(group.begin(), group.end(), surface.region) != group.end()) continue;
            const auto first = static_cast<std::size_t>(&surface - &*scene.surfaces().begin());
            const std::span<const Point> outline = scene.outline(SurfaceId(first));
            Box box;
            for (const Point& p : outline) box.add(p);
            bool apart = false;
            for (std::size_t s = 0; s < 3; ++s) apart |= box.lo[s] >= inner.hi[s] || box.hi[s] <= inner.lo[s];
            if (apart) continue;
            inside.assign(outline.begin(), outline.end());
            for (const Plane& face : body.faces) {
                clip(inside, {-face.n, -face.offset + 2 * slack_}, next);
                inside.swap(next);
                if (inside.size() < 3) break;
            }
            if (inside.size() >= 3) return true;
        }
        return false;
    }

    std::uint32_t root(std::uint32_t r) {
        while (parent_[r] != r) r = parent_[r] = parent_[parent_[r]];
        return r;
    }

    /// The body that is bounded by the regions of a group, with one more face if edges are open; no points if that face
    /// does not exist.
    ConvexBlocker make_body(const std::vector<RegionId>& group, const std::vector<Side>& open) const {
        ConvexBlocker body;
        std::map<Place, std::uint32_t> numbers;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::int32_t> faces_of_edges;
        for (RegionId r : group) {
            const PieceId piece = occluders_.pieces(r).front();
            body.faces.push_back(occluders_.pieces()[piece].plane);
            std::vector<std::uint32_t>& loop = body.loops.emplace_back();
            for (const Point& p : occluders_.corners(piece)) {
                const auto [known, is_new] =
                    numbers.try_emplace(place(p), static_cast<std::uint32_t>(body.points.size()));
                if (is_new) body.points.push_back(p);
                loop.push_back(known->second);
            }
        }
        if (!open.empty() && !add_cap(open, numbers, body)) return {};
        for (std::size_t face = 0; face < body.loops.size(); ++face) {
            const std::vector<std::uint32_t>& loop = body.loops[face];
            for (std::size_t i = 0; i < loop.size(); ++i)
                faces_of_edges[{loop[i], loop[(i + 1) % loop.size()]}] = static_cast<std::int32_t>(face);
        }
        for (const auto& [ends, face] : faces_of_edges)
            if (ends.first < ends.second) {
                const auto back = faces_of_edges.find({ends.second, ends.first});
                if (back != faces_of_edges.end()) body.edges.push_back({ends.first, ends.second, face, back->second});
            }
        return body;
    }

    bool is_convex_body(const ConvexBlocker& body) const {
        std::size_t sides = 0;
        for (const auto& loop : body.loops) sides += loop.size();
        if (2 * body.edges.size() != sides || body.points.size() + body.faces.size() != body.edges.size() + 2)
            return false;
        for (const Plane& face : body.faces)
            for (const Point& p : body.points)
                if (face.signed_distance(p) > slack_) return false;
        return true;
    }

    const Occluders& occluders_;
    double slack_;
    std::vector<std::uint32_t> parent_;
    std::vector<bool> spoilt_;
    std::vector<Side> sides_;
    std::map<std::uint32_t, std::vector<Side>> open_;  ///< Edges with a face on one side only, by group.
};

/// A side of a face: a corner and the next one.
using Ends = std::pair<std::uint32_t, std::uint32_t>;

/// The corners of a face in order, from the map of each corner to the next; empty unless they form one loop.
std::vector<std::uint32_t> one_loop(const std::map<std::uint32_t, std::uint32_t>& next) {
    if (next.size() < 3) return {};
    std::vector<std::uint32_t> loop;
    for (auto at = next.begin(); loop.size() < next.size(); at = next.find(at->second)) {
        if (at == next.end()) return {};
        loop.push_back(at->first);
    }
    return next.at(loop.back()) == loop.front() ? loop : std::vector<std::uint32_t>();
}

/// Builds the body's edges from the sides of its faces. Returns false unless every side has a reverse and the body is
/// closed.
bool join_sides(const std::map<Ends, std::int32_t>& left_of, ConvexBlocker& body) {
    std::size_t sides = 0;
    for (const auto& loop : body.loops) sides += loop.size();
    for (const auto& [ends, face] : left_of) {
        const auto back = left_of.find({ends.second, ends.first});
        if (back == left_of.end()) return false;
        if (ends.first < ends.second) body.edges.push_back({ends.first, ends.second, face, back->second});
    }
    return 2 * body.edges.size() == sides && body.points.size() + body.faces.size() == body.edges.size() + 2;
}

}  // namespace

ConvexBlocker make_sheet(std::span<const Point> outline, const Plane& plane) {
    ConvexBlocker sheet;
    sheet.points.assign(outline.begin(), outline.end());
    sheet.faces.push_back(plane);
    const auto count = static_cast<std::uint32_t>(outline.size());
    std::vector<std::uint32_t>& loop = sheet.loops.emplace_back();
    for (std::uint32_t i = 0; i < count; ++i) {
        loop.push_back(i);
        sheet.edges.push_back({i, (i + 1) % count, 0, ConvexBlocker::no_face});
    }
    return sheet;
}

bool clip_body(const ConvexBlocker& body, const Plane& plane, double slack, ConvexBlocker& part) {
    part = {};
    std::vector<double> height;
    bool any_in = false, any_out = false;
    for (const Point& p : body.points) {
        const double d = plane.signed_distance(p);
        height.push_back(std::abs(d) <= slack ? 0 : d);
        any_in |= height.back() > 0, any_out |= height.back() < 0;
    }
    if (!any_in) return true;
    if (!any_out) return part = body, true;
    if (body.faces.size() + 1 >= ConvexBlocker::max_faces) return false;

    // Key: a corner of the body (twice), or the ends of a cut edge.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;
    const auto number = [&](std::uint32_t a, std::uint32_t b) {
        const auto [known, is_new] =
            numbers.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(part.points.size()));
        if (is_new) {
            const auto [low, high] = std::minmax(a, b);
            const double t = low == high ? 0 : height[low] / (height[low] - height[high]);
            part.points.push_back(body.points[low] + t * (body.points[high] - body.points[low]));
        }
        return known->second;
    };
    std::map<std::uint32_t, std::uint32_t> border;  // border of the new face: from each corner to the next
    std::map<Ends, std::int32_t> left_of;
    const auto add_face = [&](const Plane& face, const std::vector<std::uint32_t>& loop) {
        for (std::size_t i = 0; i < loop.size(); ++i)
            left_of[{loop[i], loop[(i + 1) % loop.size()]}] = static_cast<std::int32_t>(part.faces.size());
        part.faces.push_back(face);
        part.loops.push_back(loop);
    };
    for (std::size_t k = 0; k < body.faces.size(); ++k) {
        std::vector<std::uint32_t> loop;
        std::vector<bool> lies_on;
        const std::vector<std::uint32_t>& whole = body.loops[k];
        for (std::size_t i = 0; i < whole.size(); ++i) {
            const std::uint32_t a = whole[i], b = whole[(i + 1) % whole.size()];
            if (height[a] >= 0) loop.push_back(number(a, a)), lies_on.push_back(height[a] == 0);
            if (height[a] * height[b] < 0) loop.push_back(number(a, b)), lies_on.push_back(true);
        }
        if (std::find(lies_on.begin(), lies_on.end(), false) == lies_on.end()) continue;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::size_t next = (i + 1) % loop.size();
            if (lies_on[i] && lies_on[next]) border[loop[next]] = loop[i];
        }
        add_face(body.faces[k], loop);
    }
    const std::vector<std::uint32_t> cap = one_loop(border);
    if (cap.empty()) return false;
    add_face({-plane.n, -plane.offset}, cap);
    return join_sides(left_of, part);
}

std::vector<ConvexBlocker> make_solid_blockers(const Occluders& occluders, double slack) {
    std::vector<bool> used(occluders.scene().regions().size(), false);
    return Bodies(occluders, slack).solids(used);
}

std::vector<ConvexBlocker> make_convex_blockers(const Occluders& occluders, double slack) {
    const Scene& scene = occluders.scene();
    std::vector<bool> used(scene.regions().size(), false);
    std::vector<ConvexBlocker> blockers = Bodies(occluders, slack).solids(used);
    std::vector<Point> corners;
    for (SurfaceId s : scene.surfaces().ids())
        for (const Point& p : scene.outline(s)) corners.push_back(p);
    for (PieceId p : occluders.pieces().ids()) {
        if (occluders.is_distant(p)) continue;
        const ConvexPiece& piece = occluders.pieces()[p];
        if (used[piece.region.value]) continue;
        ConvexBlocker sheet = make_sheet(occluders.corners(p), piece.plane);
        if (sides(sheet, corners, slack) == 0) blockers.push_back(std::move(sheet));
    }
    return blockers;
}

std::uint32_t sides(const ConvexBlocker& blocker, std::span<const Point> polygon, double slack) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < blocker.faces.size(); ++k) {
        bool in_front = true, behind = true;
        for (const Point& p : polygon) {
            const double d = blocker.faces[k].signed_distance(p);
            in_front &= d >= -slack, behind &= d <= slack;
        }
        if (in_front) bits |= 1u << k;
        if (behind && !blocker.is_solid()) bits |= 2u;
    }
    return bits;
}

}  // namespace exitance
