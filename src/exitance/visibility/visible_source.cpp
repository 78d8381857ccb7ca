#include "exitance/visibility/visible_source.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/four.hpp"
#include "exitance/base/limits.hpp"

namespace exitance {
namespace {

/// Share of the point's height over the source: blockers that reach higher are not projected but treated as unbounded.
/// Derived from double precision, of which seven digits are left there.
constexpr double max_projected_height = 1 - 1e-9;
/// Up to this many shadows are cut from the source in turn; more are subtracted one by one.
constexpr std::size_t max_shadows_in_turn = 8;
/// Share of the source's form factor below which the difference of two sums is too inaccurate. Derived from the sums'
/// rounding, 1e-13 of the source's form factor, and a relative accuracy of 1e-7.
constexpr double min_lit_share = 1e-6;

}  // namespace

void VisibleSource::Polygon::copy(const Polygon& other) {
    count = other.count;
    std::copy_n(other.u, count + lanes - 1, u);
    std::copy_n(other.v, count + lanes - 1, v);
    low_u = other.low_u, high_u = other.high_u, low_v = other.low_v, high_v = other.high_v;
}

void VisibleSource::set(std::span<const Point> source, std::span<const ConvexBlocker* const> blockers) {
    source_ = source;
    if (pool_.empty()) pool_.resize(256);
    frame_ = PlaneFrame(source[0], normalized(area_vector(source)));
    corners_.clear();
    for (const Point& p : source) corners_.push_back(frame_.flat(p));
    bodies_.clear();
    points_.clear();
    faces_.clear();
    split_.clear();
    for (const ConvexBlocker* shape : blockers)
        if (!shape->is_solid() && shape->edges.size() > Polygon::max_lines) split_sheet(*shape);
    const auto add = [&](const ConvexBlocker& shape) {
        bodies_.push_back(
            {&shape, static_cast<std::uint32_t>(points_.size()), static_cast<std::uint32_t>(faces_.size())});
        for (const Point& p : shape.points) points_.push_back(turned(p - frame_.origin));
        for (const Plane& face : shape.faces)
            faces_.push_back({turned(face.n), face.offset - dot(face.n, frame_.origin)});
    };
    for (const ConvexBlocker* shape : blockers)
        if (shape->is_solid() || shape->edges.size() <= Polygon::max_lines) add(*shape);
    for (const ConvexBlocker& part : split_) add(part);
}

/// Adds the parts of a sheet, each with at most max_lines edges, which have diagonals in common.
void VisibleSource::split_sheet(const ConvexBlocker& sheet) {
    const std::vector<std::uint32_t>& loop = sheet.loops[0];
    for (std::size_t first = 1; first + 1 < loop.size(); first += Polygon::max_lines - 2) {
        std::vector<Point> outline{sheet.points[loop[0]]};
        for (std::size_t i = first; i < std::min(loop.size(), first + Polygon::max_lines - 1); ++i)
            outline.push_back(sheet.points[loop[i]]);
        split_.push_back(make_sheet(outline, sheet.faces[0]));
    }
}

void VisibleSource::look_from(const Point& x) {
    lines_.clear();
    pyramids_.clear();
    x_ = turned(x - frame_.origin);
    size_ = 0;
    whole_.clear();
    for (Vec2 p : corners_) {
        whole_.add(p.x - x_.x, p.y - x_.y);
        size_ = std::max(size_, std::abs(p.x - x_.x) + std::abs(p.y - x_.y) + std::abs(x_.z));
    }
    whole_.close();
}

/// Computes a box around the blocker's projection onto the source's plane. Returns false if that is empty or outside
/// the source.
bool VisibleSource::find_box(const Body& body, Pyramid& pyramid) const {
    const double highest = max_projected_height * x_.z;
    bool any_high = false, all_high = true;
    double low_u = HUGE_VAL, low_v = HUGE_VAL, high_u = -HUGE_VAL, high_v = -HUGE_VAL;
    const Vec3* const points = points_.data() + body.first_point;
    for (std::size_t i = 0; i < body.shape->points.size(); ++i) {
        const Vec3& p = points[i];
        any_high |= p.z >= highest, all_high &= p.z >= x_.z;
        const double stretch = x_.z / (x_.z - p.z), u = (p.x - x_.x) * stretch, v = (p.y - x_.y) * stretch;
        low_u = std::min(low_u, u), high_u = std::max(high_u, u);
        low_v = std::min(low_v, v), high_v = std::max(high_v, v);
    }
    if (all_high) return false;
    if (any_high) low_u = low_v = -HUGE_VAL, high_u = high_v = HUGE_VAL;
    pyramid.low_u = low_u, pyramid.high_u = high_u, pyramid.low_v = low_v, pyramid.high_v = high_v;
    const double across = std::min(high_u, whole_.high_u) - std::max(low_u, whole_.low_u);
    const double along = std::min(high_v, whole_.high_v) - std::max(low_v, whole_.low_v);
    pyramid.overlap = across * along;
    return across > 0 && along > 0;
}

/// Adds the lines of a blocker's silhouette as seen from the point. Returns false if the blocker is seen edge-on. Sets
/// `inside` if the point is inside a solid.
bool VisibleSource::add_pyramid(const Body& body, Pyramid& pyramid, bool& inside) {
    const ConvexBlocker& shape = *body.shape;
    const std::size_t count = shape.faces.size();
    in_front_.resize(count + 1);
    bool any = false;
    for (std::size_t k = 0; k < count; ++k) {
        const double d = faces_[body.first_face + k].signed_distance(x_);
        in_front_[k] = d > 0;
        any |= d > 0;
    }
    inside = shape.is_solid() && !any;
    if (inside) return true;
    const auto first = static_cast<std::uint32_t>(lines_.size());
    for (const ConvexBlocker::Edge& e : shape.edges) {
        const bool left = in_front_[static_cast<std::size_t>(e.left)];
        if (e.right != ConvexBlocker::no_face &&
            left == static_cast<bool>(in_front_[static_cast<std::size_t>(e.right)]))
            continue;
        const Vec3 a = points_[body.first_point + e.a] - x_, b = points_[body.first_point + e.b] - x_;
        // A face seen from its front is counter-clockwise, so b x a points inwards.
        const Vec3 plane = left ? cross(b, a) : cross(a, b);
        lines_.push_back({plane.x, plane.y, -plane.z * x_.z,
                          zero_sine * size_ * (std::abs(plane.x) + std::abs(plane.y) + std::abs(plane.z))});
    }
    pyramid.first = pyramid.likely = first;
    pyramid.last = static_cast<std::uint32_t>(lines_.size());
    return pyramid.last - first >= 3;
}

void VisibleSource::add_edges(const Polygon& polygon, double weight) {
    const auto corner = [&](std::size_t i) { return Vec3{polygon.u[i], polygon.v[i], -x_.z}; };
    for (std::size_t i = 0; i < polygon.count; ++i)
        terms_.add(n_, corner(i), corner(i + 1 == polygon.count ? 0 : i + 1), weight);
}

/// The part of a convex polygon with sign * height >= 0. For either sign the cut points are identical.
void VisibleSource::cut(const Polygon& polygon, const double* heights, double sign, Polygon& out) {
    out.clear();
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const std::size_t j = i + 1 == polygon.count ? 0 : i + 1;
        const double a = heights[i], b = heights[j];
        if (sign * a >= 0) out.add(polygon.u[i], polygon.v[i]);
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
            const std::size_t low = a < b ? i : j, high = a < b ? j : i;
            const double t = heights[low] / (heights[low] - heights[high]);
            out.add(polygon.u[low] + t * (polygon.u[high] - polygon.u[low]),
                    polygon.v[low] + t * (polygon.v[high] - polygon.v[low]));
        }
    }
    out.close();
}

VisibleSource::Sides VisibleSource::measure(const Polygon& polygon, const Line& line, double* heights) const {
    bool any_in = false, any_out = false;
    for (std::size_t i = 0; i < polygon.count; i += four::lanes) {
        const four::Real h = line.a * four::load(&polygon.u[i]) + line.b * four::load(&polygon.v[i]) + line.c;
        const four::Mask in = h > line.none, out = h < -line.none;
        any_in |= four::any(in), any_out |= four::any(out);
        lanes_of::store(in || out ? h : four::Real{}, heights + i);
    }
    return {any_in, any_out};
}

/// Returns whether some line of a pyramid has the whole fragment outside. Tests the line that succeeded last time
/// first.
bool VisibleSource::misses(const Polygon& fragment, Pyramid& pyramid) const {
    const auto is_outside = [&](std::uint32_t k) {
        const Line& line = lines_[k];
        for (std::size_t i = 0; i < fragment.count; i += four::lanes)
            if (four::any(line.a * four::load(&fragment.u[i]) + line.b * four::load(&fragment.v[i]) + line.c >
                          line.none))
                return false;
        return true;
    };
    if (is_outside(pyramid.likely)) return true;
    for (std::uint32_t k = pyramid.first; k < pyramid.last; ++k)
        if (k != pyramid.likely && is_outside(k)) return pyramid.likely = k, true;
    return false;
}

/// Appends to cuts_ the lines of a pyramid that cross a fragment.
void VisibleSource::find_cuts(const Polygon& fragment, const Pyramid& pyramid) {
    double heights[Polygon::most + Polygon::lanes];
    for (std::uint32_t k = pyramid.first; k < pyramid.last; ++k)
        if (measure(fragment, lines_[k], heights).any_out) cuts_.push_back(k);
}

/// Subtracts the pyramids reaching_[first, last) from a fragment and adds the contour of the rest.
void VisibleSource::subtract(const Polygon& fragment, std::size_t first, std::size_t last, bool is_whole) {
    if (fragment.count > Polygon::max_fragment) return subtract_halves(fragment, first, last);
    const std::size_t mark = pool_used_, first_cut = cuts_.size(), first_left = reaching_.size();
    for (std::size_t i = first; i < last; ++i) {
        const std::uint32_t p = reaching_[i];
        if (pyramids_[p].is_beside(fragment) || misses(fragment, pyramids_[p])) continue;
        if (reaching_.size() == first_left) {
            find_cuts(fragment, pyramids_[p]);
            if (cuts_.size() == first_cut) {  // the fragment is inside the pyramid
                anything_hidden_ = true;
                hidden_by_one_ |= is_whole;
                return;
            }
        }
        reaching_.push_back(p);
    }
    const std::size_t left = reaching_.size() - first_left;
    if (left == 0) {
        anything_lit_ = true;
        add_edges(fragment, weight_);
        return;
    }
    if (pool_used_ + 2 + cuts_.size() - first_cut > pool_.size()) pool_.resize(2 * pool_.size() + cuts_.size());
    std::size_t rest = pool_used_++, spare = pool_used_++;
    const std::size_t first_offcut = pool_used_;
    const Polygon* polygon = &fragment;
    bool hidden = true;
    for (std::size_t c = first_cut; hidden && c < cuts_.size(); ++c) {
        double heights[Polygon::most];
        const Sides sides = measure(*polygon, lines_[cuts_[c]], heights);
        hidden = sides.any_in;
        if (!sides.any_in || !sides.any_out) continue;
        if (left > 1) cut(*polygon, heights, -1, pool_[pool_used_++]);
        cut(*polygon, heights, 1, pool_[spare]);
        std::swap(rest, spare);
        polygon = &pool_[rest];
    }
    const std::size_t end = pool_used_;
    cuts_.resize(first_cut);
    if (!hidden) {  // the fragment is outside the pyramid
        pool_used_ = mark;
        subtract(fragment, first_left + 1, first_left + left, is_whole);
    } else if (left == 1) {  // the last pyramid: subtract the hidden part's contour instead of cutting
        anything_hidden_ = anything_lit_ = true;
        add_edges(fragment, weight_);
        add_edges(*polygon, -weight_);
    } else {
        anything_hidden_ = true;
        for (std::size_t i = first_offcut; i < end; ++i) {
            Polygon piece;
            piece.copy(pool_[i]);
            subtract(piece, first_left + 1, first_left + left, false);
        }
    }
    pool_used_ = mark;
    reaching_.resize(first_left);
}

/// Splits a fragment with too many corners into two halves and subtracts each; their common side cancels in the
/// contour.
void VisibleSource::subtract_halves(const Polygon& fragment, std::size_t first, std::size_t last) {
    const std::size_t middle = fragment.count / 2;
    Polygon half;
    const auto subtract_corners = [&](std::size_t from, std::size_t to) {
        half.clear();
        for (std::size_t i = from; i <= to; ++i)
            half.add(fragment.u[i % fragment.count], fragment.v[i % fragment.count]);
        half.close();
        subtract(half, first, last, false);
    };
    subtract_corners(0, middle);
    subtract_corners(middle, fragment.count);
}

/// Computes the part of the source inside a pyramid. Sets `is_whole` if that is the whole source.
void VisibleSource::clip_source(const Pyramid& pyramid, Polygon& inside, bool& is_whole) const {
    double heights[Polygon::most + Polygon::lanes];
    Polygon spare;
    inside.copy(whole_);
    is_whole = true;
    for (std::uint32_t k = pyramid.first; k < pyramid.last && inside.count > 0; ++k) {
        const Sides sides = measure(inside, lines_[k], heights);
        is_whole &= !sides.any_out;
        if (!sides.any_out) continue;
        cut(inside, heights, 1, spare);
        inside.copy(spare);
        if (!sides.any_in || inside.count < 3) inside.clear();
    }
}

/// Clips the source to each pyramid in reaching_ and drops those that hide nothing. Each pyramid's box shrinks to its
/// shadow on the source; before, the box of a blocker as high as the point is unbounded. Returns false if one pyramid
/// hides everything.
bool VisibleSource::find_shadows() {
    if (shadows_.size() < pyramids_.size()) shadows_.resize(pyramids_.size());
    bool is_whole = false;
    std::erase_if(reaching_, [&](std::uint32_t p) {
        bool hides_all = false;
        clip_source(pyramids_[p], shadows_[p], hides_all);
        is_whole |= hides_all;
        const Polygon& shadow = shadows_[p];
        pyramids_[p].low_u = shadow.low_u, pyramids_[p].high_u = shadow.high_u;
        pyramids_[p].low_v = shadow.low_v, pyramids_[p].high_v = shadow.high_v;
        pyramids_[p].overlap = (shadow.high_u - shadow.low_u) * (shadow.high_v - shadow.low_v);
        return shadow.count < 3;
    });
    return !is_whole;
}

/// Subtracts the shadows of the pyramids in reaching_ from the whole source, each without the parts that earlier ones
/// hide. This is used if many small shadows lie on a large source: each overlaps few others, whereas cutting the source
/// in turn would leave hundreds of slivers. Returns false, with no effect, if nearly nothing remains visible: exact
/// cutting must then decide whether anything does.
bool VisibleSource::take_shadows() {
    if (!find_shadows()) return false;
    put_largest_first();
    add_edges(whole_, 1);
    const double all = terms_.sum();
    weight_ = -1;
    for (std::size_t i = 0, count = reaching_.size(); i < count; ++i) {
        const Polygon shadow = shadows_[reaching_[i]];
        subtract(shadow, 0, i, false);
    }
    weight_ = 1;
    anything_hidden_ = !reaching_.empty();
    if (terms_.sum() > min_lit_share * all) return anything_lit_ = true;
    terms_.clear();
    anything_lit_ = anything_hidden_ = false;
    return false;
}

/// Sorts by hidden area, largest first, so that less is left to be cut.
void VisibleSource::put_largest_first() {
    std::sort(reaching_.begin(), reaching_.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double of_a = pyramids_[a].overlap, of_b = pyramids_[b].overlap;
        return of_a > of_b || (of_a == of_b && a < b);
    });
}

double VisibleSource::operator()(const Point& x, const Normal& n, Seen& seen) {
    look_from(x);
    terms_.clear();
    n_ = turned(n);
    anything_lit_ = anything_hidden_ = hidden_by_one_ = false;
    pool_used_ = 0;
    cuts_.clear();
    for (const Body& body : bodies_) {
        // A blocker that misses the whole source misses every part of it. If there are many blockers, most miss it.
        Pyramid pyramid{};
        if (!find_box(body, pyramid)) continue;
        const std::size_t mark = lines_.size();
        bool inside = false;
        const bool opens = add_pyramid(body, pyramid, inside);
        if (inside) return seen = Seen::nothing, 0;
        if (opens && !misses(whole_, pyramid))
            pyramids_.push_back(pyramid);
        else
            lines_.resize(mark);
    }
    reaching_.clear();
    for (std::uint32_t k = 0; k < pyramids_.size(); ++k) reaching_.push_back(k);
    if (reaching_.size() > 2) put_largest_first();
    if (reaching_.size() <= max_shadows_in_turn || !take_shadows()) subtract(whole_, 0, reaching_.size(), true);
    seen = !anything_lit_     ? (hidden_by_one_ ? Seen::nothing : Seen::nothing_past_several)
           : anything_hidden_ ? Seen::part
                              : Seen::all;
    return anything_lit_ ? std::max(0.0, terms_.sum()) : 0;
}

double VisibleSource::unoccluded(const Point& x, const Normal& n) {
    terms_.clear();
    for (std::size_t i = 0; i < source_.size(); ++i)
        terms_.add(n, source_[i] - x, source_[i + 1 == source_.size() ? 0 : i + 1] - x, 1);
    return std::max(0.0, terms_.sum());
}

}  // namespace exitance
