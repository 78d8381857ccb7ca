#include "exitance/transport/visible_source.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr double on_plane = 1e-12;  ///< Sine of an angle that counts as none: scenes are full of aligned edges.

}  // namespace

void VisibleSource::set(std::span<const Point> source, std::span<const ConvexBlocker* const> blockers) {
    source_ = source, blockers_ = blockers;
    if (pool_.empty()) pool_.resize(256);
}

/// Adds the planes through x and the silhouette of a blocker, normals pointing into its pyramid. False when x sees it
/// edge-on; `inside` when x lies within a body.
bool VisibleSource::add_pyramid(const ConvexBlocker& blocker, const Point& x, bool& inside) {
    const std::size_t count = blocker.faces.size();
    in_front_.resize(count + 1);
    bool any = false;
    for (std::size_t k = 0; k < count; ++k) {
        const double d = blocker.faces[k].signed_distance(x);
        in_front_[k] = d > 0;
        any |= d > 0;
    }
    inside = blocker.is_solid() && !any;
    if (inside) return true;
    const auto first = static_cast<std::uint32_t>(planes_.size());
    for (const ConvexBlocker::Edge& e : blocker.edges) {
        const bool left = in_front_[static_cast<std::size_t>(e.left)];
        if (e.right != ConvexBlocker::no_face &&
            left == static_cast<bool>(in_front_[static_cast<std::size_t>(e.right)]))
            continue;
        const Vec3 a = blocker.points[e.a] - x, b = blocker.points[e.b] - x;
        // A face seen from its front runs counter-clockwise: b x a points inwards.
        planes_.push_back(left ? cross(b, a) : cross(a, b));
    }
    const auto last = static_cast<std::uint32_t>(planes_.size());
    pyramids_.push_back({first, last, first});
    return last - first >= 3;
}

void VisibleSource::add_edges(const Polygon& polygon, double weight) {
    for (std::size_t i = 0; i < polygon.count; ++i)
        terms_.add(n_, polygon.at(i), polygon.at(i + 1 == polygon.count ? 0 : i + 1), weight);
}

/// The part of a convex polygon with sign * height >= 0. Both parts meet in the same points.
void VisibleSource::cut(const Polygon& polygon, const double* heights, double sign, Polygon& out) {
    out.count = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const std::size_t j = i + 1 == polygon.count ? 0 : i + 1;
        const double a = heights[i], b = heights[j];
        if (sign * a >= 0) out.add(polygon.at(i));
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
            const Vec3 p = polygon.at(i), q = polygon.at(j);
            out.add(a < b ? p + (a / (a - b)) * (q - p) : q + (b / (b - a)) * (p - q));
        }
    }
}

VisibleSource::Sides VisibleSource::measure(const Polygon& polygon, const Vec3& plane, double* heights) const {
    const double none = on_plane * size_ * (std::abs(plane.x) + std::abs(plane.y) + std::abs(plane.z));
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        double h = plane.x * polygon.xyz[i][0] + plane.y * polygon.xyz[i][1] + plane.z * polygon.xyz[i][2];
        if (std::abs(h) <= none) h = 0;
        heights[i] = h;
        lowest = std::min(lowest, h), highest = std::max(highest, h);
    }
    return {highest > 0, lowest < 0};
}

/// Has a plane of a pyramid all of a fragment outside? The plane that had the last one is asked first.
bool VisibleSource::misses(const Polygon& fragment, Pyramid& pyramid) const {
    const auto is_outside = [&](std::uint32_t k) {
        const Vec3& plane = planes_[k];
        const double none = on_plane * size_ * (std::abs(plane.x) + std::abs(plane.y) + std::abs(plane.z));
        for (std::size_t i = 0; i < fragment.count; ++i)
            if (plane.x * fragment.xyz[i][0] + plane.y * fragment.xyz[i][1] + plane.z * fragment.xyz[i][2] > none)
                return false;
        return true;
    };
    if (is_outside(pyramid.likely)) return true;
    for (std::uint32_t k = pyramid.first; k < pyramid.last; ++k)
        if (k != pyramid.likely && is_outside(k)) return pyramid.likely = k, true;
    return false;
}

/// Adds the planes of a pyramid that run through a fragment to cuts_; false when one has all of it outside.
bool VisibleSource::find_cuts(const Polygon& fragment, const Pyramid& pyramid) {
    double heights[Polygon::most];
    for (std::uint32_t k = pyramid.first; k < pyramid.last; ++k) {
        const Sides sides = measure(fragment, planes_[k], heights);
        if (!sides.any_in) return false;
        if (sides.any_out) cuts_.push_back(k);
    }
    return true;
}

/// Adds the edges of what the pyramids named in reaching_[first, last) leave of a fragment. Those that miss it miss all
/// that is cut from it, too.
void VisibleSource::subtract(const Polygon& fragment, std::size_t first, std::size_t last, bool is_whole) {
    const std::size_t mark = pool_used_, first_cut = cuts_.size(), first_left = reaching_.size();
    for (std::size_t i = first; i < last; ++i) {
        const std::uint32_t p = reaching_[i];
        if (misses(fragment, pyramids_[p])) continue;
        if (reaching_.size() == first_left) {
            find_cuts(fragment, pyramids_[p]);
            if (cuts_.size() == first_cut) {  // it lies within
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
        add_edges(fragment, 1);
        return;
    }
    if (pool_used_ + 2 + cuts_.size() - first_cut > pool_.size()) pool_.resize(2 * pool_.size() + cuts_.size());
    std::size_t rest = pool_used_++, spare = pool_used_++;
    const std::size_t first_offcut = pool_used_;
    const Polygon* polygon = &fragment;
    bool hidden = true;
    for (std::size_t c = first_cut; hidden && c < cuts_.size(); ++c) {
        double heights[Polygon::most];
        const Sides sides = measure(*polygon, planes_[cuts_[c]], heights);
        hidden = sides.any_in;
        if (!sides.any_in || !sides.any_out) continue;
        if (left > 1) cut(*polygon, heights, -1, pool_[pool_used_++]);
        cut(*polygon, heights, 1, pool_[spare]);
        std::swap(rest, spare);
        polygon = &pool_[rest];
    }
    const std::size_t end = pool_used_;
    cuts_.resize(first_cut);
    if (!hidden) {  // beside the pyramid after all
        pool_used_ = mark;
        subtract(fragment, first_left + 1, first_left + left, is_whole);
    } else if (left == 1) {  // nothing more is cut: the hidden part may count negative
        anything_hidden_ = anything_lit_ = true;
        add_edges(fragment, 1);
        add_edges(*polygon, -1);
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

double VisibleSource::operator()(const Point& x, const Normal& n, Seen& seen) {
    planes_.clear();
    pyramids_.clear();
    terms_.clear();
    n_ = n;
    anything_lit_ = anything_hidden_ = hidden_by_one_ = false;
    pool_used_ = 0;
    cuts_.clear();
    Polygon whole;
    whole.count = 0;
    size_ = 0;
    for (const Point& p : source_) {
        whole.add(p - x);
        const Vec3 r = whole.at(whole.count - 1);
        size_ = std::max(size_, std::abs(r.x) + std::abs(r.y) + std::abs(r.z));
    }
    reaching_.clear();
    for (const ConvexBlocker* blocker : blockers_) {
        bool inside = false;
        const bool opens = add_pyramid(*blocker, x, inside);
        if (inside) return seen = Seen::nothing, 0;
        // What misses the source as a whole would miss every part of it, and most of many blockers do.
        if (opens && !misses(whole, pyramids_.back()))
            reaching_.push_back(static_cast<std::uint32_t>(pyramids_.size() - 1));
        else
            planes_.resize(pyramids_.back().first), pyramids_.pop_back();
    }
    subtract(whole, 0, reaching_.size(), true);
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

bool VisibleSource::is_hidden_from(std::span<const Point> receiver) {
    for (const ConvexBlocker* blocker : blockers_) {
        bool hides = true;
        for (const Point& x : receiver) {
            planes_.clear();
            pyramids_.clear();
            bool inside = false;
            if (!add_pyramid(*blocker, x, inside) || inside) hides = false;
            for (std::size_t k = 0; hides && k < planes_.size(); ++k)
                for (const Point& y : source_)
                    if (dot(planes_[k], y - x) < 0) hides = false;
            if (!hides) break;
        }
        if (hides) return true;
    }
    return false;
}

}  // namespace exitance
