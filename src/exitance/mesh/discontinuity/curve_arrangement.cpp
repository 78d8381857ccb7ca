#include "exitance/mesh/discontinuity/curve_arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exitance/base/bvh.hpp"

namespace exitance {
namespace {

/// A line n . p = offset with the curve segments on it.
struct Line {
    Vec2 n;
    double offset = 0;
    std::vector<std::size_t> curves;

    Vec2 at(double s) const { return {offset * n.x - s * n.y, offset * n.y + s * n.x}; }
    double along(Vec2 p) const { return n.x * p.y - n.y * p.x; }
    double distance(Vec2 p) const { return dot(n, p) - offset; }
};

Box box_of(Vec2 a, Vec2 b, double around) {
    Box box;
    box.add(Point{a.x, a.y, 0}), box.add(Point{b.x, b.y, 0});
    box.lo -= Vec3{around, around, around}, box.hi += Vec3{around, around, around};
    return box;
}

double distance_to(Vec2 p, Vec2 a, Vec2 b) {
    const Vec2 d = b - a;
    const double dd = dot(d, d), t = dd > 0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0;
    return length(p - (a + t * d));
}

class Arrangement {
  public:
    Arrangement(std::vector<FlatCurve> curves, std::span<const std::vector<Vec2>> loops, double tolerance)
        : curves_(std::move(curves)), loops_(loops), tolerance_(tolerance) {
        std::vector<Box> boxes;
        for (const auto& loop : loops_)
            for (std::size_t i = 0; i < loop.size(); ++i) {
                border_.emplace_back(loop[i], loop[(i + 1) % loop.size()]);
                boxes.push_back(box_of(border_.back().first, border_.back().second, tolerance_));
            }
        border_tree_ = Bvh(boxes);
    }

    ArrangedCurves run() {
        std::erase_if(curves_, [&](const FlatCurve& c) {
            return !std::isfinite(c.a.x + c.a.y + c.b.x + c.b.y) || length(c.b - c.a) <= 2 * tolerance_;
        });
        // Longest first, because their directions are the most accurate. Ties are resolved by position, so that the
        // input order does not matter.
        std::sort(curves_.begin(), curves_.end(), [](const FlatCurve& p, const FlatCurve& q) {
            const double lp = dot(p.b - p.a, p.b - p.a), lq = dot(q.b - q.a, q.b - q.a);
            return std::tuple(-lp, p.a.x, p.a.y, p.b.x, p.b.y, p.order, p.cause, p.source.value) <
                   std::tuple(-lq, q.a.x, q.a.y, q.b.x, q.b.y, q.order, q.cause, q.source.value);
        });
        find_lines();
        for (const Line& line : lines_) add_stretches(line);
        weld_ends();
        find_ends();
        return {split_at_ends(), split_border()};
    }

  private:
    /// Assigns each curve to the line of the first longer curve that contains both its ends, or to a line of its own.
    void find_lines() {
        std::vector<Box> boxes;
        for (const FlatCurve& c : curves_) boxes.push_back(box_of(c.a, c.b, tolerance_));
        const Bvh tree(boxes);
        constexpr std::size_t none = ~std::size_t(0);
        std::vector<std::size_t> line_of(curves_.size(), none);
        for (std::size_t i = 0; i < curves_.size(); ++i) {
            const FlatCurve& c = curves_[i];
            std::size_t joined = none;
            tree.visit_box(boxes[i], [&](std::uint32_t k) {
                if (line_of[k] >= joined || k >= i) return;
                const Line& line = lines_[line_of[k]];
                if (std::abs(line.distance(c.a)) <= tolerance_ && std::abs(line.distance(c.b)) <= tolerance_)
                    joined = line_of[k];
            });
            if (joined == none) {
                const Vec2 d = c.b - c.a;
                const double l = length(d);
                const Vec2 n = {-d.y / l, d.x / l};
                joined = lines_.size();
                lines_.push_back({n, 0.5 * (dot(n, c.a) + dot(n, c.b)), {}});
            }
            line_of[i] = joined;
            lines_[joined].curves.push_back(i);
        }
    }

    /// Sorted positions along the line at which curves begin or end, or the border crosses it.
    std::vector<double> places_on(const Line& line) const {
        std::vector<double> at;
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (const std::size_t i : line.curves)
            for (const Vec2 p : {curves_[i].a, curves_[i].b}) {
                at.push_back(line.along(p));
                lo = std::min(lo, at.back()), hi = std::max(hi, at.back());
            }
        border_tree_.visit_box(box_of(line.at(lo), line.at(hi), tolerance_), [&](std::uint32_t i) {
            const auto& [p, q] = border_[i];
            const double dp = line.distance(p), dq = line.distance(q);
            if (std::abs(dp) <= tolerance_) at.push_back(line.along(p));
            if (std::abs(dq) <= tolerance_) at.push_back(line.along(q));
            if (std::min(dp, dq) < -tolerance_ && std::max(dp, dq) > tolerance_)
                at.push_back(line.along(p + (dp / (dp - dq)) * (q - p)));
        });
        std::sort(at.begin(), at.end());
        std::vector<double> out;
        for (const double s : at)
            if (s >= lo && s <= hi && (out.empty() || s > out.back() + tolerance_)) out.push_back(s);
        return out;
    }

    /// Returns whether the point is inside the polygon and not on its border.
    bool is_inside(Vec2 p) const {
        bool on_border = false;
        border_tree_.visit_box(box_of(p, p, tolerance_), [&](std::uint32_t i) {
            on_border |= distance_to(p, border_[i].first, border_[i].second) <= tolerance_;
            return on_border;
        });
        if (on_border) return false;
        bool inside = false;
        for (const auto& [a, b] : border_)
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
        return inside;
    }

    /// Adds the strongest curve of every stretch of a line. Consecutive stretches of the same curve are joined.
    void add_stretches(const Line& line) {
        const std::vector<double> at = places_on(line);
        constexpr std::size_t none = ~std::size_t(0);
        std::size_t before = none;
        for (std::size_t k = 0; k + 1 < at.size(); ++k) {
            const double middle = 0.5 * (at[k] + at[k + 1]);
            std::size_t best = none;
            double gain = 0;
            for (const std::size_t i : line.curves) {
                const double p = line.along(curves_[i].a), q = line.along(curves_[i].b);
                if (std::min(p, q) > middle || std::max(p, q) < middle) continue;
                gain += curves_[i].gain;
                if (best == none || curves_[i].order < curves_[best].order) best = i;
            }
            if (best == none || !is_inside(line.at(middle))) {
                before = none;
                continue;
            }
            if (before == best && out_.back().gain == gain) {
                out_.back().b = line.at(at[k + 1]);
                continue;
            }
            out_.push_back(curves_[best]);
            out_.back().a = line.at(at[k]), out_.back().b = line.at(at[k + 1]), out_.back().gain = gain;
            before = best;
        }
    }

    /// Moves ends to the nearest border corner or the first nearby end.
    void weld_ends() {
        std::vector<Box> boxes;
        std::vector<Vec2*> ends;
        for (FlatCurve& c : out_)
            for (Vec2* end : {&c.a, &c.b}) ends.push_back(end), boxes.push_back(box_of(*end, *end, 2 * tolerance_));
        const Bvh tree(boxes);
        const double near = 4 * tolerance_;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            Vec2& p = *ends[i];
            border_tree_.visit_box(boxes[i], [&](std::uint32_t k) {
                for (const Vec2 corner : {border_[k].first, border_[k].second})
                    if (length(corner - p) <= near) p = corner;
            });
            std::uint32_t first = static_cast<std::uint32_t>(i);
            tree.visit_box(boxes[i], [&](std::uint32_t k) {
                if (k < first && length(*ends[k] - p) <= near) first = k;
            });
            p = *ends[first];
        }
    }

    void find_ends() {
        std::vector<Box> boxes;
        for (const FlatCurve& c : out_)
            for (const Vec2 end : {c.a, c.b}) ends_.push_back(end), boxes.push_back(box_of(end, end, tolerance_));
        end_tree_ = Bvh(boxes);
    }

    /// The segment's ends, and the ends of curves on it, in order.
    std::vector<Vec2> stops_on(Vec2 a, Vec2 b) const {
        std::vector<std::pair<double, Vec2>> stops = {{0, a}, {1, b}};
        const Vec2 d = b - a;
        end_tree_.visit_box(box_of(a, b, tolerance_), [&](std::uint32_t k) {
            const Vec2 p = ends_[k];
            if (p == a || p == b || distance_to(p, a, b) > 4 * tolerance_) return;
            const double t = dot(p - a, d) / dot(d, d);
            if (t > 0 && t < 1) stops.emplace_back(t, p);
        });
        std::sort(stops.begin(), stops.end(), [](const auto& p, const auto& q) {
            return std::tuple(p.first, p.second.x, p.second.y) < std::tuple(q.first, q.second.x, q.second.y);
        });
        std::vector<Vec2> out;
        for (const auto& [t, p] : stops)
            if (out.empty() || !(out.back() == p)) out.push_back(p);
        return out;
    }

    /// Splits curves at the ends of other curves on them.
    std::vector<FlatCurve> split_at_ends() const {
        std::vector<FlatCurve> out;
        for (const FlatCurve& c : out_) {
            if (c.a == c.b) continue;
            const std::vector<Vec2> stops = stops_on(c.a, c.b);
            for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
                out.push_back(c);
                out.back().a = stops[k], out.back().b = stops[k + 1];
            }
        }
        return out;
    }

    /// Splits the border at the ends of curves on it. An end near a sharp corner is near both sides but becomes a
    /// corner of the nearer one only; otherwise the loop would visit it twice and enclose nothing in between.
    std::vector<std::vector<Vec2>> split_border() const {
        std::vector<std::vector<Vec2>> out;
        for (const auto& loop : loops_) {
            out.emplace_back();
            const std::size_t n = loop.size();
            for (std::size_t i = 0; i < n; ++i) {
                const Vec2 before = loop[(i + n - 1) % n], a = loop[i], b = loop[(i + 1) % n],
                           after = loop[(i + 2) % n];
                for (const Vec2 p : stops_on(a, b)) {
                    if (p == b) continue;
                    const double here = distance_to(p, a, b);
                    if (p == a || (here < distance_to(p, before, a) && here <= distance_to(p, b, after)))
                        out.back().push_back(p);
                }
            }
        }
        return out;
    }

    std::vector<FlatCurve> curves_, out_;
    std::span<const std::vector<Vec2>> loops_;
    double tolerance_;
    std::vector<std::pair<Vec2, Vec2>> border_;
    Bvh border_tree_, end_tree_;
    std::vector<Vec2> ends_;
    std::vector<Line> lines_;
};

}  // namespace

ArrangedCurves arranged_curves(std::vector<FlatCurve> curves, std::span<const std::vector<Vec2>> loops,
                               double tolerance) {
    return Arrangement(std::move(curves), loops, tolerance).run();
}

}  // namespace exitance
