#include "exitance/direct/beams.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/visibility/glazed_part.hpp"

namespace exitance {

/// Returns a point in the direction of parallel light that is outside of the whole scene.
Vec3 Beams::far_away(const PunctualLight& light, const Point& x) const {
    const Scene& scene = occluders_->scene();
    return x - (2 * (scene.size() + norm(x - scene.box().centre()))) * light.direction;
}

Beams::Arrival Beams::arrival(const PunctualLight& light, const SurfacePoint& at) const {
    if (light.is_directional()) {
        const double cosine = -dot(at.n, light.direction);
        return {std::max(0.0, cosine) * light.intensity, far_away(light, at.x)};
    }
    const Vec3 d = light.position - at.x;
    const double r2 = squared_norm(d), cosine_r = dot(at.n, d);
    if (!(cosine_r > 0)) return {};
    const double r = std::sqrt(r2);
    return {(light.share_towards(-d / r) * cosine_r / (r2 * r)) * light.intensity, light.position};
}

bool Beams::blocks(PieceId p, const SurfacePoint& at, const Point& from) const {
    const ConvexPiece& piece = occluders_->pieces()[p];
    if (occluders_->is_own(piece.region, at.region)) return false;
    const std::span<const Point> corners = occluders_->corners(p);
    const double here = dot(piece.plane.n, at.x - corners[0]), there = dot(piece.plane.n, from - corners[0]);
    const double rounding = occluders_->rounding();
    if (std::abs(here) <= rounding || std::abs(there) <= rounding || (here > 0) == (there > 0)) return false;
    const Vec3 d = from - at.x;
    bool left = false, right = false;
    for (std::size_t i = 0, m = corners.size(); i < m; ++i) {
        // Each pair of corners uses an identical product, so that pieces on both sides of an edge agree on which side d
        // passes.
        const double side = dot(d, cross(corners[i] - at.x, corners[i + 1 == m ? 0 : i + 1] - at.x));
        left |= side > 0, right |= side < 0;
        if (left && right) return false;
    }
    return true;
}

bool Beams::is_blocked(const SurfacePoint& at, const Point& from) const {
    bool blocked = false;
    for (const Occluders::Size size : {Occluders::Size::large, Occluders::Size::small}) {
        occluders_->visit_segment(size, at.x, from - at.x, [&](PieceId p) { return blocked = blocks(p, at, from); });
        if (blocked) return true;
    }
    return false;
}

Spectrum Beams::irradiance(const SurfacePoint& at, Spectrum* parallel) const {
    Spectrum sum;
    for (const PunctualLight& light : *lights_) {
        Arrival arriving = arrival(light, at);
        if (!(max(arriving.E) > 0) || is_blocked(at, arriving.from)) continue;
        if (!occluders_->scene().panes().empty())
            arriving.E *= transmission_between(occluders_->scene().panes(), at.x, arriving.from);
        sum += arriving.E;
        if (parallel && light.is_directional()) *parallel += arriving.E;
    }
    return sum;
}

Spectrum Beams::irradiance(const SurfacePoint& at, std::span<const Beam> beams, std::span<const PieceId> candidates,
                           Spectrum* parallel) const {
    Spectrum sum;
    for (const Beam& beam : beams) {
        const PunctualLight& light = (*lights_)[beam.light];
        Arrival arriving = arrival(light, at);
        if (!(max(arriving.E) > 0)) continue;
        const auto between = candidates.subspan(beam.first, beam.count);
        if (std::any_of(between.begin(), between.end(), [&](PieceId p) { return blocks(p, at, arriving.from); }))
            continue;
        if (!occluders_->scene().panes().empty())
            arriving.E *= transmission_between(occluders_->scene().panes(), at.x, arriving.from);
        sum += arriving.E;
        if (parallel && light.is_directional()) *parallel += arriving.E;
    }
    return sum;
}

template <class EachPiece>
void Beams::prepare_light(std::uint32_t number, std::span<const Point> receiver, const Normal& n, RegionId own,
                          const EachPiece& each_piece, std::vector<Beam>& out, std::vector<PieceId>& candidates) const {
    const PunctualLight& light = (*lights_)[number];
    const double slack = occluders_->rounding();
    const auto towards = [&](const Point& x) { return light.is_directional() ? -light.direction : light.position - x; };
    if (!(dot(n, towards(receiver[0])) > 0)) return;

    // The pyramid (or prism) between the polygon and the light, its side planes facing inwards.
    ConvexRegion region;
    std::vector<Plane> sides;
    region.add({n, dot(n, receiver[0]) + slack});
    if (!light.is_directional()) region.add({-n, -dot(n, light.position) - slack});
    for (std::size_t i = 0; i < receiver.size(); ++i) {
        const Point &a = receiver[i], &b = receiver[i + 1 == receiver.size() ? 0 : i + 1];
        const Vec3 inward = cross(towards(a), b - a);
        const double length = norm(inward);
        if (!(length > 0)) continue;
        sides.push_back({inward / length, dot(inward, a) / length - slack});
        region.add(sides.back());
    }
    const std::size_t first = candidates.size();
    std::vector<Point> part, rest;
    const bool hidden = each_piece(region, [&](PieceId p) {
        if (occluders_->is_own(occluders_->pieces()[p].region, own)) return false;
        part.assign(occluders_->corners(p).begin(), occluders_->corners(p).end());
        if (std::all_of(part.begin(), part.end(), [&](const Point& q) { return dot(n, q - receiver[0]) <= slack; }))
            return false;
        for (const Plane& side : sides) {
            clip(part, side, rest);
            part.swap(rest);
            if (part.size() < 3) return false;
        }
        candidates.push_back(p);
        // The shadow of a convex piece is convex: if it contains all corners, it contains the polygon.
        return std::all_of(receiver.begin(), receiver.end(), [&](const Point& x) {
            return blocks(p, {x, n, own}, light.is_directional() ? far_away(light, x) : light.position);
        });
    });
    if (hidden) return candidates.resize(first);
    out.push_back({number, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(candidates.size() - first)});
}

void Beams::prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::vector<Beam>& out,
                    std::vector<PieceId>& candidates) const {
    for (std::uint32_t i = 0; i < lights_->size(); ++i)
        prepare_light(
            i, receiver, n, own,
            [&](const ConvexRegion& region, const auto& visit) {
                return occluders_->visit_region(Occluders::Size::large, region, visit, {}) ||
                       occluders_->visit_region(Occluders::Size::small, region, visit, {});
            },
            out, candidates);
}

void Beams::prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::span<const Beam> whole,
                    std::span<const PieceId> whole_candidates, std::vector<Beam>& out,
                    std::vector<PieceId>& candidates) const {
    for (const Beam& beam : whole)
        prepare_light(
            beam.light, receiver, n, own,
            [&](const ConvexRegion&, const auto& visit) {
                const auto between = whole_candidates.subspan(beam.first, beam.count);
                return std::any_of(between.begin(), between.end(), visit);
            },
            out, candidates);
}

}  // namespace exitance
