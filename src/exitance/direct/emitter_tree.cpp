#include "exitance/direct/emitter_tree.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exitance/base/polygon.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {

EmitterTree::EmitterTree(const DirectLight& direct, Windows windows) : direct_(&direct) {
    const Occluders& occluders = direct.occluders();
    for (std::uint32_t e = 0; e < direct.emitters().size(); ++e) {
        if (windows == Windows::left_out ? direct.is_distant(e) : direct.looks_far(e)) continue;
        const DirectLight::Emitter& emitter = direct.emitters()[e];
        for (PieceId piece : emitter.pieces) {
            const double area = norm(area_vector(occluders.corners(piece)));
            const double power = area * mean(emitter.exitance);
            if (power > 0) sources_.push_back({{e, piece}, emitter.region, area, power});
        }
    }
    if (!sources_.empty()) nodes_.push_back(make_node(0, static_cast<std::uint32_t>(sources_.size())));
    // Children come after their parent; the loop reaches every node that it adds.
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        const auto [first, last] = std::pair(nodes_[i].first, nodes_[i].last);
        if (last - first == 1) continue;
        const std::uint32_t middle = middle_of(nodes_[i]);
        nodes_[i].left = static_cast<std::uint32_t>(nodes_.size()), nodes_[i].right = nodes_[i].left + 1;
        nodes_.push_back(make_node(first, middle)), nodes_.push_back(make_node(middle, last));
    }
    power_before_.assign(1, 0);
    for (const Source& source : sources_) power_before_.push_back(power_before_.back() + source.power);
}

EmitterTree::Node EmitterTree::make_node(std::uint32_t first, std::uint32_t last) const {
    const Occluders& occluders = direct_->occluders();
    const auto plane_of = [&](const Source& s) -> const Plane& { return direct_->emitters()[s.name.emitter].plane; };
    const std::span<const Source> sources = std::span(sources_).subspan(first, last - first);
    Node out;
    out.first = first, out.last = last;
    Spectrum light;
    for (const Source& s : sources) {
        out.power += s.power;
        light += s.area * direct_->emitters()[s.name.emitter].exitance;
        out.centre += s.power * centroid(occluders.corners(s.name.piece));
        out.normal += s.power * plane_of(s).n;
    }
    out.centre *= 1 / out.power, out.normal *= 1 / out.power;
    out.colour = (1 / out.power) * light;
    const double length = norm(out.normal);
    out.normal_spread = std::sqrt(std::max(0.0, 1 - length * length));
    constexpr double min_mean_normal = 1e-6;  // derived from rounding: the direction of a shorter mean is inaccurate
    out.axis = length > min_mean_normal ? out.normal / length : plane_of(sources.front()).n;
    for (const Source& s : sources) {
        const std::span<const Point> corners = occluders.corners(s.name.piece);
        const Point middle = centroid(corners);
        double of_piece = 0;
        for (const Point& corner : corners) {
            const double along = dot(out.axis, corner - out.centre);
            out.radius = std::max(out.radius, norm(corner - out.centre));
            out.lowest = std::min(out.lowest, along), out.highest = std::max(out.highest, along);
            // exact for a square: r^2 / 3
            of_piece += squared_norm(corner - middle) / static_cast<double>(3 * corners.size());
        }
        out.spread_squared += s.power / out.power * (squared_norm(middle - out.centre) + of_piece);
        out.cosine = std::min(out.cosine, std::max(dot(plane_of(s).n, out.axis), -1.0));
    }
    constexpr double rounding = 1e-14;  // derived from normals of one plane, which differ by roundings alone
    if (out.cosine > 1 - rounding) out.cosine = 1;
    out.sine = std::sqrt(1 - out.cosine * out.cosine);
    return out;
}

/// Sorts a node's sources along its widest extent. Returns the index at which about half of its power is reached.
std::uint32_t EmitterTree::middle_of(const Node& node) {
    const auto begin = sources_.begin() + node.first, end = sources_.begin() + node.last;
    const auto key = [&](const Source& s, std::size_t axis) {
        return axis < 3 ? centroid(direct_->occluders().corners(s.name.piece))[axis]
                        : direct_->emitters()[s.name.emitter].plane.n[axis - 3];
    };
    std::size_t widest = 0;
    double most = -1;
    for (std::size_t axis = 0; axis < 6; ++axis) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (auto s = begin; s != end; ++s) {
            const double value = key(*s, axis);
            lo = std::min(lo, value), hi = std::max(hi, value);
        }
        const double extent = (hi - lo) * (axis < 3 ? 1 : node.radius);
        if (extent > most) most = extent, widest = axis;
    }
    std::vector<std::pair<double, Source>> sorted;
    for (auto s = begin; s != end; ++s) sorted.push_back({key(*s, widest), *s});
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
        return std::tuple(a.first, a.second.name.piece) < std::tuple(b.first, b.second.name.piece);
    });
    std::uint32_t middle = 0;
    double power = 0;
    for (std::uint32_t i = 0; i < sorted.size(); ++i) {
        *(begin + i) = sorted[i].second;
        if (power + sorted[i].second.power / 2 <= node.power / 2) middle = i + 1;
        power += sorted[i].second.power;
    }
    return node.first + std::clamp<std::uint32_t>(middle, 1, node.last - node.first - 1);
}

/// Unoccluded light of a single source, exact.
double EmitterTree::exact(const Node& leaf, const SurfacePoint& at) const {
    const Source& source = sources_[leaf.first];
    const DirectLight::Emitter& emitter = direct_->emitters()[source.name.emitter];
    const Occluders& occluders = direct_->occluders();
    if (source.region == at.region || emitter.plane.signed_distance(at.x) <= occluders.rounding() ||
        occluders.lie_in_one_plane(at.x, at.n, source.name.piece))
        return 0;
    return point_to_polygon(at.x, at.n, occluders.corners(source.name.piece)) * mean(emitter.exitance);
}

/// True if no source of a cluster can light a place: the place is behind all of them, or all are below its horizon. The
/// extent of the cluster along its axis is a tighter bound than its ball for lamps in one plane. `d`: from the place to
/// the cluster's centre; `up`: n . d.
bool EmitterTree::is_dark(const Node& node, const Normal& n, const Vec3& d, double up) const {
    const double rounding = direct_->occluders().rounding();
    // A source at y with the normal m lights x only if m . (x - y) > 0. All m are within a cone around the axis; the
    // bound holds for cones of up to 90 degrees.
    const double reach = norm(d) + node.radius;
    const double above = (-dot(node.axis, d) - node.lowest) * node.cosine + reach * node.sine;
    if (node.cosine >= 0 && above <= rounding) return true;
    // All corners are in the ball around the centre, and between two planes across the axis.
    const double tilt = dot(n, node.axis), across = std::sqrt(std::max(0.0, 1 - tilt * tilt));
    return up + std::max(tilt * node.lowest, tilt * node.highest) + across * node.radius <= rounding;
}

/// From far away a cluster is treated as one source at its centre, with its mean normal m:
///
///     L = P (n . d) (-m . d) / (pi d^4),
///
/// The relative error is about (spread / d)^2, plus the spread of the normals times (spread / d). If the horizon or the
/// plane of one of its sources crosses the cluster, its light is anything from 0 to the maximum for its power; it then
/// counts as 0 with that maximum as its error.
EmitterTree::Term EmitterTree::look_at(std::uint32_t number, const SurfacePoint& at) const {
    const Node& node = nodes_[number];
    const Vec3 d = node.centre - at.x;
    const double d2 = squared_norm(d), distance = std::sqrt(d2), up = dot(at.n, d);
    if (up <= -node.radius || is_dark(node, at.n, d, up)) return {number, 0, 0};
    // Derived from a bound that is finite, and so large that clusters around the point are split first.
    constexpr double min_nearness = 0.1;
    const double nearest = std::max(distance - node.radius, min_nearness * node.radius);
    const double highest = std::min(1.0, (up + node.radius) / nearest);  // upper bound of the receiver's cosine
    const auto anything = [&](double cosine) {
        return Term{number, 0, node.power / (pi * nearest * nearest) * highest * cosine};
    };
    if (distance <= 2 * node.radius) return anything(1);
    // Cosines and sines of the angle between the axis and the direction to x, and of that angle minus and plus the
    // cone's half angle.
    const double c = std::clamp(-dot(node.axis, d) / distance, -1.0, 1.0), s = std::sqrt(1 - c * c);
    const double ball = node.radius / distance;
    const bool in_cone = c >= node.cosine;
    const double towards = in_cone ? 1 : c * node.cosine + s * node.sine, away = c * node.cosine - s * node.sine;
    if (towards <= -ball) return {number, 0, 0};
    if (up < node.radius || away <= ball || -c >= node.cosine) return anything(std::min(1.0, towards + ball));
    const double cosine_x = up / distance, cosine_y = -dot(node.normal, d) / distance;
    const double sent = node.power / (pi * d2);
    const double askew = std::sqrt(node.spread_squared) / distance;
    const double either = std::min(1.0, cosine_x + askew) * std::min(1.0, cosine_y + askew + node.normal_spread);
    return {number, sent * cosine_x * cosine_y,
            sent * (either * askew * askew + std::min(1.0, cosine_x + askew) * node.normal_spread * askew)};
}

/// Splits all nodes with an error larger than `most`; single sources become exact.
void EmitterTree::open(const Term& term, const SurfacePoint& at, double most, std::vector<Term>& out) const {
    if (term.light <= 0 && term.error <= 0) return;
    const Node& node = nodes_[term.node];
    if (term.error <= most || out.size() >= max_terms) {
        out.push_back(term);
    } else if (node.is_leaf()) {
        const double light = exact(node, at);
        if (light > 0) out.push_back({term.node, light, 0});
    } else {
        open(look_at(node.left, at), at, most, out);
        open(look_at(node.right, at), at, most, out);
    }
}

void EmitterTree::cut(const SurfacePoint& at, double relative, double absolute, Cut& out) const {
    out.terms.clear(), out.light = out.error = 0;
    if (nodes_.empty()) return;
    out.terms.push_back(look_at(0, at));
    for (double most = out.terms.front().error;;) {
        double squares = 0, unknown = 0;
        out.light = 0;
        for (const Term& term : out.terms) {
            out.light += term.light;
            if (term.light > 0)
                squares += term.error * term.error;
            else
                unknown += term.error / 2;
        }
        out.error = std::hypot(std::sqrt(squares), unknown);
        const double limit = std::max(relative * out.light, absolute);
        if (out.error <= limit || out.terms.size() >= max_terms) break;
        most /= 2;
        out.next.clear();
        for (const Term& term : out.terms) open(term, at, most, out.next);
        out.terms.swap(out.next);
    }
}

}  // namespace exitance
