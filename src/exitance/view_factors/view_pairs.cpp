#include "exitance/view_factors/view_pairs.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "exitance/base/parallel.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/view_factors/accuracy.hpp"

namespace exitance {
namespace {

/// Shaft between two boxes: planes parallel to an axis with both boxes on one side. Source: [Haines91].
class BoxShaft {
  public:
    BoxShaft(const Box& a, const Box& b) {
        both_ = a;
        both_.add(b);
        for (std::size_t s = 0; s < 3; ++s) {
            const std::size_t t = (s + 1) % 3;
            for (int corner = 0; corner < 4; ++corner) {
                const bool up_s = corner & 1, up_t = corner & 2;
                const auto at = [&](const Box& box, std::size_t axis, bool up) {
                    return up ? box.hi[axis] : box.lo[axis];
                };
                const double ds = at(b, s, up_s) - at(a, s, up_s), dt = at(b, t, up_t) - at(a, t, up_t);
                // The normal perpendicular to the line through this corner of both boxes that points away from them, if
                // there is one.
                const double sign = dt * (up_s ? 1 : -1) > 0 ? 1 : -1, ns = sign * dt, nt = -sign * ds;
                if (ns * (up_s ? 1 : -1) <= 0 || nt * (up_t ? 1 : -1) <= 0) continue;
                sides_[count_++] = {s, t, ns, nt, ns * at(a, s, up_s) + nt * at(a, t, up_t)};
            }
        }
    }
    bool misses(const Box& box) const {
        for (std::size_t s = 0; s < 3; ++s)
            if (box.lo[s] >= both_.hi[s] || box.hi[s] <= both_.lo[s]) return true;
        for (std::size_t k = 0; k < count_; ++k) {
            const Side& side = sides_[k];
            const double nearest =
                side.ns * (side.ns > 0 ? box.lo : box.hi)[side.s] + side.nt * (side.nt > 0 ? box.lo : box.hi)[side.t];
            if (nearest >= side.offset) return true;
        }
        return false;
    }

  private:
    struct Side {
        std::size_t s, t;
        double ns, nt, offset;
    };
    Box both_;
    std::array<Side, 12> sides_;
    std::size_t count_ = 0;
};

/// Lowers sheets into their faces if they are raised because they are on top of others in one plane (Occluders::lift):
/// raised ones would hide their own faces.
void lower_raised_sheets(const Occluders& occluders, std::vector<ConvexBlocker>& blockers) {
    const Field<PieceId, ConvexPiece>& pieces = occluders.pieces();
    for (const PieceId p : pieces.ids()) {
        const double lift = pieces[p].region.is_none() ? 0 : occluders.lift(pieces[p].region);
        if (lift == 0) continue;
        const std::span<const Point> corners = occluders.corners(p);
        for (ConvexBlocker& blocker : blockers) {
            if (blocker.is_solid() || !std::ranges::equal(blocker.points, corners)) continue;
            const Vec3 down = -lift * blocker.faces[0].n;
            for (Point& q : blocker.points) q = q + down;
            blocker.faces[0].offset -= lift;
        }
    }
}

/// Replaces hollow solids by their faces: a solid as a whole would hide everything inside it.
std::vector<ConvexBlocker> with_open_hollows(std::vector<ConvexBlocker> blockers, std::span<const ViewFace> faces,
                                             const FaceGroups& groups, double slack) {
    std::vector<ConvexBlocker> out, sheets;
    for (ConvexBlocker& blocker : blockers) {
        if (!blocker.is_solid() || !groups.is_hollow(blocker)) {
            out.push_back(std::move(blocker));
            continue;
        }
        std::vector<Point> corners;
        for (std::size_t k = 0; k < blocker.faces.size(); ++k) {
            corners.clear();
            for (const std::uint32_t c : blocker.loops[k]) corners.push_back(blocker.points[c]);
            sheets.push_back(make_sheet(corners, blocker.faces[k]));
        }
    }
    std::erase_if(sheets, [&](const ConvexBlocker& sheet) {  // with all faces on one side, it hides nothing
        std::uint32_t shared = ~0u;
        for (const ViewFace& face : faces) shared &= sides(sheet, face.outline, slack);
        return shared != 0;
    });
    std::move(sheets.begin(), sheets.end(), std::back_inserter(out));
    return out;
}

}  // namespace

ViewPairs::ViewPairs(const Scene& scene, const StopRequest& stop)
    : occluders_(scene),
      slack_(plane_slack(occluders_)),
      faces_(make_view_faces(scene)),
      groups_(faces_, slack_),
      hidden_parts_(occluders_, faces_, slack_, stop, nullptr, &groups_) {
    blockers_ = with_open_hollows(make_convex_blockers(occluders_, slack_), faces_, groups_, slack_);
    lower_raised_sheets(occluders_, blockers_);
    for (const ConvexBlocker& b : blockers_) {
        Box box;
        for (const Point& p : b.points) box.add(p);
        boxes_.push_back(box);
    }
    // Share of the slack. Derived from the slack of faces, which must stay larger.
    constexpr double enlarged = 0.1;
    for (const ConvexBlocker& b : blockers_) planes_.add(b, enlarged * slack_);
    hidden_.resize(faces_.size() * faces_.size());
    sides_.resize(faces_.size() * blockers_.size());
    standing_.resize(sides_.size());
    parallel_for(faces_.size(), 16, [&](std::size_t i) {
        if (stop.requested()) return;
        for (std::size_t b = 0; b < blockers_.size(); ++b) {
            sides_[i * blockers_.size() + b] = sides(blockers_[b], faces_[i].outline, slack_);
            standing_[i * blockers_.size() + b] = standing(blockers_[b], faces_[i].plane);
        }
    });
}

std::uint8_t ViewPairs::standing(const ConvexBlocker& blocker, const Plane& plane) const {
    std::uint8_t bits = 0;
    for (const Point& p : blocker.points) {
        const double d = plane.signed_distance(p);
        bits |= d > slack_ ? in_front : d < -slack_ ? behind : 0;
    }
    return bits;
}

void ViewPairs::find_blockers(std::size_t face, std::vector<std::uint32_t>& found) const {
    found.clear();
    for (std::uint32_t b = 0; b < blockers_.size(); ++b)
        if (standing_[face * blockers_.size() + b] & in_front) found.push_back(b);
}

void ViewPairs::find_blockers(std::size_t i, std::size_t j, std::span<const std::uint32_t> before_i,
                              std::vector<std::uint32_t>& found) const {
    found.clear();
    const std::uint32_t* sides_i = sides_.data() + i * blockers_.size();  // null if there are no blockers
    const std::uint32_t* sides_j = sides_.data() + j * blockers_.size();
    for (std::uint32_t b : before_i)
        if ((sides_i[b] & sides_j[b]) == 0 && (standing_[j * blockers_.size() + b] & in_front)) found.push_back(b);
    if (found.empty()) return;
    const BoxShaft shaft(faces_[i].box, faces_[j].box);
    std::erase_if(found, [&](std::uint32_t b) { return shaft.misses(boxes_[b]); });
}

void ViewPairs::find_hidden(std::size_t first, std::size_t last, const StopRequest& stop) {
    const std::size_t n = faces_.size();
    shared_ranges(
        last - first, 4,
        [&](std::size_t from, std::size_t to) {
            JointShadow shadow;
            std::vector<std::uint32_t> of_face, of_pair;
            std::vector<Point> part_i, part_j;
            for (std::size_t i = first + from; i < first + to; ++i) {
                find_blockers(i, of_face);
                for (std::size_t j = 0; j < i && !stop.requested(); ++j) {
                    bool cut = false;
                    if (!face_each_other(i, j, cut)) continue;
                    find_blockers(i, j, of_face, of_pair);
                    if (of_pair.empty()) continue;
                    bool hidden = true;
                    for (const std::vector<Point>& piece_i : faces_[i].pieces)
                        for (const std::vector<Point>& piece_j : faces_[j].pieces) {
                            if (!hidden) continue;
                            clip(piece_i, faces_[j].plane, part_i);
                            clip(piece_j, faces_[i].plane, part_j);
                            hidden = part_i.empty() || part_j.empty() || shadow.hides(part_i, part_j, planes_, of_pair);
                        }
                    hidden_[i * n + j] = hidden;
                }
            }
        },
        [&](std::size_t k) { return std::span(hidden_).subspan((first + k) * n, first + k); }, {"hidden pairs"});
    for (std::size_t i = first; i < last; ++i)
        for (std::size_t j = 0; j < i; ++j) hidden_[j * n + i] = hidden_[i * n + j];
}

}  // namespace exitance
