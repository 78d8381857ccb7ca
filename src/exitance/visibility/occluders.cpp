#include "exitance/visibility/occluders.hpp"

#include <algorithm>
#include <limits>

#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/scene/other_side.hpp"
#include "exitance/visibility/narrow_gaps.hpp"

namespace exitance {
namespace {

/// Distance by which a piece is raised off its plane above the pieces that it covers, metres. All levels stay within
/// half of the thickness, so that other code treats the stack as one plane.
double stack_height(std::uint8_t level, double thickness) {
    return level * thickness / (2 * max_stacked);
}

Box box_of(std::span<const Point> corners) {
    Box box;
    for (const Point& p : corners) box.add(p);
    return box;
}

/// True if a piece and a region of the given plane are stacked, unlike the two sides of a sharp wedge.
bool is_stacked_on(const Occluders& occluders, PieceId p, const Plane& plane, RegionId own) {
    const ConvexPiece& piece = occluders.pieces()[p];
    const double thickness = 2 * piece.thickness;  // allows for stack_height() of both
    if (is_within(occluders.corners(p), plane, thickness)) return true;
    if (own.is_none()) return false;
    const IdRange<PieceId> own_pieces = occluders.pieces(own);
    return std::all_of(own_pieces.begin(), own_pieces.end(),
                       [&](PieceId q) { return is_within(occluders.corners(q), piece.plane, thickness); });
}

}  // namespace

Occluders::Occluders(const Scene& scene) : scene_(&scene), other_side_(other_sides_of_regions(scene)) {
    const Box& b = scene.box();
    const double reach = std::max(
        {std::abs(b.lo.x), std::abs(b.lo.y), std::abs(b.lo.z), std::abs(b.hi.x), std::abs(b.hi.y), std::abs(b.hi.z)});
    rounding_ = 16 * std::numeric_limits<double>::epsilon() * reach;
    of_region_.resize(scene.regions().size());
    // Share of the area, derived from double precision: the area of a triangle of collinear corners.
    constexpr double rounded_area = 1e-12;
    std::vector<Point> part;
    for (RegionId r : scene.regions().ids()) {
        const Region& region = scene.regions()[r];
        const std::size_t first = pieces_.size();
        const double tolerance = rounded_area * region.area;
        if (region.loops.size() == 1 && is_convex(region.loops[0], region.plane.n, tolerance)) {
            add_piece(region.loops[0], r, region.surfaces[0], region.plane);
        } else {
            for (SurfaceId s : region.surfaces) {
                const std::span<const Point> outline = scene.outline(s);
                for (const std::vector<std::uint32_t>& piece : convex_pieces(outline, scene.surfaces()[s].normal)) {
                    part.clear();
                    for (std::uint32_t i : piece) part.push_back(outline[i]);
                    const Normal& n = scene.surfaces()[s].normal;
                    add_piece(part, r, s, {n, dot(n, part[0])});
                }
            }
        }
        of_region_[r] = {first, pieces_.size()};
    }
    make_trees();
    add_distant_pieces();
    add_windows();
}

void Occluders::add_windows() {
    enclosure_ = find_enclosure(*scene_);
    const std::size_t first = pieces_.size();
    for (const Pane& window : enclosure_.windows) {
        const auto at = static_cast<std::uint32_t>(corners_.size());
        corners_.insert(corners_.end(), window.corners.begin(), window.corners.end());
        pieces_.add({at,
                     static_cast<std::uint32_t>(window.corners.size()),
                     RegionId(),
                     SurfaceId(),
                     {window.n, dot(window.n, corners_[at])},
                     rounding_});
    }
    windows_ = {first, pieces_.size()};
}

void Occluders::add_distant_pieces() {
    // Distance of the sky, as a multiple of the scene's size. Derived from coplanar_share: seen from anywhere in the
    // scene, directions to it differ by less than that.
    constexpr double sky_distance = 1e6;
    middle_ = scene_->box().centre();
    const std::size_t first = pieces_.size();
    for (const DistantFacet& facet : distant_facets(scene_->distant())) {
        const auto at = static_cast<std::uint32_t>(corners_.size());
        for (const Vec3& towards : facet.corners)
            corners_.push_back(middle_ + (sky_distance * scene_->size()) * towards);
        pieces_.add({at,
                     static_cast<std::uint32_t>(facet.corners.size()),
                     RegionId(),
                     SurfaceId(),
                     {facet.n, dot(facet.n, corners_[at])},
                     rounding_});
    }
    distant_ = {first, pieces_.size()};
}

/// For each piece, whether all of the scene is on one side of its plane, up to rounding. Most pieces have far corners
/// of the scene on both sides; only the others are compared with all corners.
std::vector<std::uint8_t> Occluders::find_outer() const {
    std::vector<std::uint8_t> outer(pieces_.size(), false);
    if (pieces_.empty()) return outer;
    // The farthest corners in 26 directions: if two of them are on different sides of a plane, so is the scene.
    std::vector<Point> far;
    for (int k = 0; k < 26; ++k) {
        const int code = k < 13 ? k : k + 1;  // visits all directions in {-1, 0, 1}^3 except (0, 0, 0)
        const Vec3 along{code % 3 - 1.0, code / 3 % 3 - 1.0, code / 9 - 1.0};
        far.push_back(*std::max_element(corners_.begin(), corners_.end(),
                                        [&](const Point& p, const Point& q) { return dot(along, p) < dot(along, q); }));
    }
    const auto crosses = [&](const Plane& plane, std::span<const Point> points) {
        double low = 0, high = 0;
        for (const Point& p : points) {
            const double h = plane.signed_distance(p);
            low = std::min(low, h), high = std::max(high, h);
            if (low < -rounding_ && high > rounding_) return true;
        }
        return false;
    };
    parallel_for(pieces_.size(), 64, [&](std::size_t i) {
        const Plane& plane = pieces_[PieceId(i)].plane;
        outer[i] = !crosses(plane, far) && !crosses(plane, corners_);
    });
    return outer;
}

void Occluders::make_trees() {
    const std::vector<std::uint8_t> is_outer = find_outer();
    std::vector<std::pair<double, std::uint32_t>> by_area;
    for (PieceId p : pieces_.ids()) {
        if (is_outer[p.value])
            outer_.pieces.push_back(p);
        else
            by_area.push_back({-squared_norm(area_vector(corners(p))), p.value});
    }
    const auto large = std::min(by_area.size(), static_cast<std::size_t>(4 * std::sqrt(by_area.size())));
    std::nth_element(by_area.begin(), by_area.begin() + static_cast<std::ptrdiff_t>(large), by_area.end());
    std::vector<bool> is_large(pieces_.size());
    for (std::size_t i = 0; i < large; ++i) is_large[by_area[i].second] = true;
    for (PieceId p : pieces_.ids())
        if (!is_outer[p.value]) trees_[is_large[p.value] ? 0 : 1].pieces.push_back(p);
    for (Tree* tree : {&trees_[0], &trees_[1], &outer_}) {
        std::vector<Box> boxes;
        boxes.reserve(tree->pieces.size());
        for (PieceId p : tree->pieces) boxes.push_back(box_of(corners(p)));
        tree->bvh = Bvh(boxes);
    }
}

void Occluders::add_piece(std::span<const Point> corners, RegionId region, SurfaceId surface, const Plane& plane) {
    ConvexPiece piece{static_cast<std::uint32_t>(corners_.size()),
                      static_cast<std::uint32_t>(corners.size()),
                      region,
                      surface,
                      plane,
                      0};
    // The tolerance shrinks with the piece, so that small objects stay distinct from the surface that supports them.
    piece.thickness = std::max(
        rounding_, std::min(coplanar_share * scene_->size(), coplanar_share_of_face * box_of(corners).diagonal()));
    const Vec3 lifted = stack_height(scene_->regions()[region].level, piece.thickness) * plane.n;
    for (const Point& p : corners) corners_.push_back(p + lifted);
    piece.plane.offset += dot(lifted, plane.n);
    pieces_.add(piece);
}

bool Occluders::is_back_of(RegionId a, RegionId b) const {
    const Region &front = scene_->regions()[a], &back = scene_->regions()[b];
    if (std::abs(front.area - back.area) > coplanar_share * front.area || front.loops.empty() || back.loops.empty())
        return false;
    const Box p = box_of(front.loops[0]), q = box_of(back.loops[0]);
    const double tolerance = coplanar_share * p.diagonal() + rounding_;
    return norm(p.lo - q.lo) <= tolerance && norm(p.hi - q.hi) <= tolerance;
}

bool Occluders::lie_in_one_plane(const Point& x, const Normal& n, PieceId p) const {
    const ConvexPiece& piece = pieces_[p];
    const auto is_low = [&](const Point& corner) { return std::abs(dot(n, corner - x)) <= piece.thickness; };
    const std::span<const Point> of_piece = corners(p);
    return std::abs(piece.plane.signed_distance(x)) <= piece.thickness &&
           std::all_of(of_piece.begin(), of_piece.end(), is_low);
}

double Occluders::lift(RegionId r) const {
    return stack_height(scene_->regions()[r].level, pieces_[*of_region_[r].begin()].thickness);
}

bool Occluders::is_covered(const Point& place, const Normal& n, RegionId own) const {
    const Point x = own.is_none() ? place : place + lift(own) * n;
    const double reach = coplanar_share * scene_->size() + rounding_;
    Box near;
    near.add(x - Vec3{reach, reach, reach});
    near.add(x + Vec3{reach, reach, reach});
    const auto covers = [&](PieceId p) {
        const ConvexPiece& piece = pieces_[p];
        if (is_own(piece.region, own)) return false;
        const double facing = dot(piece.plane.n, n);
        const double height = dot(corners(p)[0] - x, piece.plane.n) * facing;  // height of the piece above x, metres
        if (std::abs(height) > piece.thickness || std::abs(facing) < parallel_cosine) return false;
        if (facing > 0 && height <= rounding_) return false;
        if (!contains(corners(p), piece.plane.n, x) || !is_stacked_on(*this, p, {n, dot(n, x)}, own)) return false;
        return facing > 0 || own.is_none() || !(is_back_of(own, piece.region) || is_thin_wall(own, piece.region));
    };
    for (const Tree* tree : {&trees_[0], &trees_[1], &outer_})
        if (tree->bvh.visit_box(near, [&](std::uint32_t i) { return covers(tree->pieces[i]); })) return true;
    return false;
}

std::size_t Occluders::memory_bytes() const {
    return trees_[0].bvh.memory_bytes() + trees_[1].bvh.memory_bytes() + outer_.bvh.memory_bytes() +
           pieces_.size() * sizeof(PieceId) + corners_.capacity() * sizeof(Point) +
           pieces_.size() * sizeof(ConvexPiece) + of_region_.size() * sizeof(IdRange<PieceId>);
}

}  // namespace exitance
