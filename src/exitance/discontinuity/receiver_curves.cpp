#include "exitance/discontinuity/receiver_curves.hpp"

#include <algorithm>
#include <map>

#include "exitance/discontinuity/cover_ends.hpp"
#include "exitance/shadow_lines/three_edge_events.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {
namespace {

// Of the scene's size: lines nearer than this are one.
constexpr double nearness = 2e-8;  // given by rounding of where long wedges meet a plane

PlaneFrame frame_of(const Region& region) {
    PlaneFrame frame(region.loops.front().front(), region.plane.n);
    Vec3 longest;
    for (const auto& loop : region.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec3 d = loop[(i + 1) % loop.size()] - loop[i];
            if (squared_norm(d) > squared_norm(longest)) longest = d;
        }
    const Vec3 in_plane = longest - dot(longest, region.plane.n) * region.plane.n;
    if (squared_norm(in_plane) > 0) frame.u = normalized(in_plane), frame.v = cross(region.plane.n, frame.u);
    return frame;
}

/// A box around a region in its own coordinates.
struct FlatBox {
    Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};

    explicit FlatBox(const std::vector<std::vector<Vec2>>& loops) {
        for (const auto& loop : loops)
            for (const Vec2 p : loop) {
                lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
                hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
            }
    }
};

/// The region, or a rectangle around it: a convex polygon to look at lights from.
std::vector<Point> convex_around(const Region& region, const ReceiverCurves& receiver) {
    if (region.loops.size() == 1 && is_convex(region.loops.front(), region.plane.n)) return region.loops.front();
    const FlatBox box(receiver.loops);
    return {receiver.frame.at(box.lo), receiver.frame.at({box.hi.x, box.lo.y}), receiver.frame.at(box.hi),
            receiver.frame.at({box.lo.x, box.hi.y})};
}

}  // namespace

ReceiverCurves::ReceiverCurves(const Region& region) : frame(frame_of(region)) {
    for (const auto& loop : region.loops) {
        loops.emplace_back();
        for (const Point& p : loop) loops.back().push_back(frame.flat(p));
    }
}

ReceiverCurves CurveFinder::look(RegionId number) const {
    const Region& region = stage_->scene.regions()[number];
    ReceiverCurves out(region);
    DirectLight::Workspace workspace;
    if (options_.search)
        out.light = options_.search->look(convex_around(region, out), number, workspace, out.searched);
    else if (options_.weak)
        look_at_strong(number, out, workspace);
    else
        stage_->direct.prepare(convex_around(region, out), region.plane.n, number, out.light, workspace);
    return out;
}

/// Of the sources that may have curves there alone.
void CurveFinder::look_at_strong(RegionId number, ReceiverCurves& out, DirectLight::Workspace& workspace) const {
    const Region& region = stage_->scene.regions()[number];
    std::vector<DirectLight::SourceName> sources;
    for (const DirectLight::SourceName& s : options_.weak->strong(number)) {
        const DirectLight::Emitter& emitter = stage_->direct.emitters()[s.emitter];
        const Effect effect{.centre = emitter.centre,
                            .radius = emitter.radius,
                            .weight = mean(light_weight(stage_->scene.material(number)) * emitter.exitance),
                            .area = stage_->scene.regions()[emitter.region].area};
        if (region.area >= options_.least_area &&
            greatest_effect(number, emitter, s.emitter, effect) >= options_.least_effect)
            sources.push_back(s);
        else
            ++out.left_out;
    }
    stage_->direct.prepare(convex_around(region, out), region.plane.n, number, sources, out.light, workspace);
}

ReceiverCurves CurveFinder::find(RegionId number) const {
    const Region& region = stage_->scene.regions()[number];
    ReceiverCurves out = look(number);
    const bool is_dark = options_.weak ? !options_.weak->is_reached(number) : out.light.is_dark();
    if (is_dark && options_.secondary.empty()) return out;
    add_contacts(number, out);
    if (region.area >= options_.least_area)
        add_events(number, out), add_secondary(number, out), add_curves_behind(number, out);
    else if (!out.light.is_unshadowed())
        out.left_out += out.light.sources.size();
    if (options_.stop && options_.stop->requested()) return out;
    ArrangedCurves arranged = arranged_curves(std::move(out.curves), out.loops, nearness * stage_->scene.size());
    out.curves = std::move(arranged.curves), out.loops = std::move(arranged.loops);
    if (out.curves.size() > options_.most_curves) {
        const auto effect = [](const FlatCurve& c) {
            return c.order == CurveOrder::d0 ? HUGE_VAL : c.gain * std::hypot(c.b.x - c.a.x, c.b.y - c.a.y);
        };
        std::stable_sort(out.curves.begin(), out.curves.end(),
                         [&](const FlatCurve& a, const FlatCurve& b) { return effect(a) > effect(b); });
        out.left_out += out.curves.size() - options_.most_curves;
        out.curves.resize(options_.most_curves);
    }
    return out;
}

/// Curves of a diffusing pane's other side, whose light comes through.
void CurveFinder::add_curves_behind(RegionId region, ReceiverCurves& out) const {
    const RegionId behind = stage_->scene.behind(region);
    if (behind.is_none()) return;
    ReceiverCurves there = look(behind);
    add_contacts(behind, there), add_events(behind, there), add_secondary(behind, there);
    for (FlatCurve& c : there.curves) {
        c.a = out.frame.flat(there.frame.at(c.a)), c.b = out.frame.flat(there.frame.at(c.b));
        out.curves.push_back(c);
    }
}

void CurveFinder::add_contacts(RegionId region, ReceiverCurves& out) const {
    const auto add = [&](const auto& lines) {
        for (const auto& [a, b] : lines)
            out.curves.push_back(
                {out.frame.flat(a), out.frame.flat(b), CurveOrder::d0, CurveCause::contact, RegionId(), HUGE_VAL});
    };
    add(stage_->contacts.of_region(region));
    add(cover_ends(stage_->occluders, region));
}

void CurveFinder::add_contacts_in_the_dark(RegionId region, ReceiverCurves& out) const {
    if (!out.light.is_dark() || !out.curves.empty()) return;
    add_contacts(region, out);
    ArrangedCurves arranged = arranged_curves(std::move(out.curves), out.loops, nearness * stage_->scene.size());
    out.curves = std::move(arranged.curves), out.loops = std::move(arranged.loops);
}

/// An upper bound of what a source may bring anywhere on a region, W/m^2 of rho E: M A / (pi d^2), at most M.
double CurveFinder::greatest_effect(RegionId region, const Effect& effect) const {
    Box box;
    for (const auto& loop : stage_->scene.regions()[region].loops)
        for (const Point& p : loop) box.add(p);
    double squared_gap = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double gap = std::max({0.0, box.lo[k] - effect.centre[k], effect.centre[k] - box.hi[k]});
        squared_gap += gap * gap;
    }
    const double distance = std::max(0.0, std::sqrt(squared_gap) - effect.radius);
    const double area = effect.area;
    return effect.weight * (area < pi * distance * distance ? area / (pi * distance * distance) : 1);
}

/// The same of an emitter, of which more may be known.
double CurveFinder::greatest_effect(RegionId region, const DirectLight::Emitter& emitter, std::uint32_t number,
                                    const Effect& effect) const {
    const double by_distance = greatest_effect(region, effect);
    if (!options_.weak) return by_distance;
    const double M = mean(emitter.exitance);
    return std::min(by_distance, M > 0 ? effect.weight * options_.weak->bound(region, number) / M : 0);
}

/// The same where lines of sight by an edge may meet the region. From x there to any point s of the source it is at
/// least as far as d, the edge's distance from the source's centre less three radii: a line of sight that passes the
/// edge has one of them before it, and two are as far apart as points of the source may be. So E is at most
/// M A / (pi d^2) times cosines, h/d at x where the source rises to h over the region's plane, and at s what the edge
/// rises over the source's plane over d.
double CurveFinder::effect_beyond(const BlockerEdges::Edge& edge, const EventSource& source, const Effect& effect,
                                  const ReceiverCurves& receiver) const {
    if (!(effect.weight > 0)) return effect.gain;
    const Vec3 along = edge.b - edge.a, to = effect.centre - edge.a;
    const double length = squared_norm(along);
    const double t = length > 0 ? std::clamp(dot(to, along) / length, 0.0, 1.0) : 0;
    const double d = norm(to - t * along) - 3 * effect.radius;
    if (!(d > 0)) return effect.gain;
    double rise = 0;
    for (const auto& loop : source.loops)
        for (const Point& p : loop) rise = std::max(rise, receiver.frame.height(p));
    const double out = std::max(source.plane.signed_distance(edge.a), source.plane.signed_distance(edge.b));
    const double cosines = std::min(1.0, rise / d) * std::clamp(out / d, 0.0, 1.0);
    return std::min(effect.gain, effect.weight * cosines * effect.area / (pi * d * d));
}

void CurveFinder::add_events(RegionId region, ReceiverCurves& out) const {
    std::map<std::uint32_t, std::vector<PieceId>> blockers;  // by emitter
    const auto candidates = [&](const auto& from) {
        return std::span(out.light.candidates).subspan(from.first, from.count);
    };
    for (const ReceiverLight::Source& s : out.light.sources)
        for (const PieceId p : candidates(s)) blockers[s.emitter].push_back(p);
    for (const auto& [number, pieces] : blockers) {
        if (options_.stop && options_.stop->requested()) return;
        const DirectLight::Emitter& emitter = stage_->direct.emitters()[number];
        if (stage_->direct.is_distant(number)) continue;  // bisection follows the shadows of skies and suns
        Effect effect{.centre = emitter.centre,
                      .radius = emitter.radius,
                      .weight = mean(light_weight(stage_->scene.material(region)) * emitter.exitance),
                      .area = stage_->scene.regions()[emitter.region].area};
        effect.gain = greatest_effect(region, emitter, number, effect);
        if (effect.gain < options_.least_effect) {
            ++out.left_out;
            continue;
        }
        const EventSource source{stage_->scene.regions()[emitter.region].loops, emitter.plane, emitter.region, false,
                                 2 * emitter.radius};
        WedgeLists lists;
        if (options_.search) lists = options_.search->wedge_lists(number, region);
        add_events(region, source, effect, pieces, options_.search ? &lists : nullptr, out);
    }
    for (const Beam& beam : out.light.beams) {
        if (beam.count == 0) continue;
        const PunctualLight& light = stage_->scene.lights()[beam.light];
        // Parallel light comes from a point so far away that its shadows lie right to 1e-8 of the scene.
        constexpr double far = 1e8;  // given by that
        const Point place = light.is_directional()
                                ? stage_->scene.box().centre() - (far * stage_->scene.size()) * light.direction
                                : light.position;
        const EventSource source{{{place}}, Plane{}, RegionId(), true, 0};
        add_events(region, source, {}, candidates(beam), nullptr, out);
    }
}

void CurveFinder::add_events(RegionId region, const EventSource& source, const Effect& effect,
                             std::span<const PieceId> blockers, const WedgeLists* lists, ReceiverCurves& out) const {
    std::vector<std::uint32_t> regions, edges;
    for (const PieceId p : blockers) regions.push_back(stage_->occluders.pieces()[p].region.value);
    std::sort(regions.begin(), regions.end());
    regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
    for (const std::uint32_t r : regions) {
        const auto own = edges_->of_region(RegionId(r));
        edges.insert(edges.end(), own.begin(), own.end());
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    // Beyond edges far from the source its light, and so its shadow, is too weak to matter.
    std::vector<std::uint32_t> strong;
    std::vector<double> gains;
    for (const std::uint32_t e : edges) {
        const double gain = effect_beyond(edges_->edges()[e], source, effect, out);
        if (gain >= options_.least_effect) strong.push_back(e), gains.push_back(gain);
    }
    out.left_out += edges.size() - strong.size();
    const FlatBox box(out.loops);
    ShadowEventFinder finder(stage_->occluders, *edges_,
                             {gains, options_.least_bend, options_.least_narrow_bend, options_.stop, lists});
    std::vector<ShadowEvent> events;
    finder.find(out.frame, region, box.lo, box.hi, source, strong, events);
    out.wedges += finder.wedges, out.left_out += finder.too_weak, out.searched.plane_tests += finder.plane_tests;
    for (const ShadowEvent& e : events)
        out.curves.push_back({e.a, e.b,
                              source.is_point ? CurveOrder::d0
                              : e.is_kink     ? CurveOrder::d1
                                              : CurveOrder::d2,
                              e.by_edge_of_source ? CurveCause::edge_vertex : CurveCause::vertex_edge, source.region,
                              e.gain});
    // Where two edges each leave half of the source, they leave a quarter of it together.
    const double least = (options_.conics == ConicCurves::all ? 1 : 4) * options_.least_bend;
    if (source.is_point || effect.gain < least) return;
    std::erase_if(edges,
                  [&](std::uint32_t e) { return effect_beyond(edges_->edges()[e], source, effect, out) < least; });
    add_non_emitter_events(region, source, effect.gain, lists, edges, out);
}

/// NEV and EEE: pairs of blockers' edges, so that where there are very many they are left to bisection.
void CurveFinder::add_non_emitter_events(RegionId region, const EventSource& source, double gain,
                                         const WedgeLists* lists, std::span<const std::uint32_t> edges,
                                         ReceiverCurves& out) const {
    constexpr std::size_t many = 400;
    if (edges.size() > many) {
        ++out.left_out;
        return;
    }
    const FlatBox box(out.loops);
    ShadowEventFinder finder(stage_->occluders, *edges_, {.stop = options_.stop, .lists = lists});
    std::vector<ShadowEvent> events;
    finder.find_non_emitter(out.frame, region, box.lo, box.hi, source, edges, events);
    out.wedges += finder.wedges, out.searched.plane_tests += finder.plane_tests;
    for (const ShadowEvent& e : events)
        out.curves.push_back({e.a, e.b, CurveOrder::d2, CurveCause::blocker_edge, source.region, gain});
    if (options_.conics == ConicCurves::none) return;
    // A polyline beside its conic leaves a strip where the polynomial is the neighbour's, of less than a thousandth of
    // the region.
    constexpr double beside = 1e-3;  // given by that: what it costs is D2, a third power of it
    const double sagitta = beside * std::min(box.hi.x - box.lo.x, box.hi.y - box.lo.y);
    std::vector<ThreeEdgeEvent> conics;
    ThreeEdgeEventFinder(stage_->occluders, *edges_, options_.stop)
        .find(out.frame, region, box.lo, box.hi, source, edges, options_.conics == ConicCurves::at_umbras, sagitta,
              conics);
    for (const ThreeEdgeEvent& c : conics)
        for (std::size_t i = 1; i < c.places.size(); ++i)
            out.curves.push_back(
                {c.places[i - 1], c.places[i], CurveOrder::eee, CurveCause::three_edges, source.region, gain});
}

/// What stands between the region and each part of a secondary source is found by the shaft between them.
void CurveFinder::add_secondary(RegionId region, ReceiverCurves& out) const {
    const Region& receiver = stage_->scene.regions()[region];
    const std::vector<Point> outline = convex_around(receiver, out);
    Shaft shaft;
    std::vector<PieceId> candidates;
    for (const SecondarySource& s : options_.secondary) {
        if (s.region == region) continue;
        const Plane& plane = stage_->scene.regions()[s.region].plane;
        for (const SecondarySource::Part& part : s.parts) {
            if (options_.stop && options_.stop->requested()) return;
            shaft.set(stage_->occluders, {outline, receiver.plane.n, region}, {part.outline, plane.n, s.region});
            if (shaft.classify(candidates) != View::mixed) continue;
            Point centre;
            for (const Point& p : part.outline) centre = centre + (1.0 / static_cast<double>(part.outline.size())) * p;
            double radius = 0;
            for (const Point& p : part.outline) radius = std::max(radius, norm(p - centre));
            Effect effect{.centre = centre,
                          .radius = radius,
                          .weight = mean(light_weight(stage_->scene.material(region)) * part.radiosity),
                          .area = part.area};
            effect.gain = greatest_effect(region, effect);
            if (effect.gain < options_.least_effect) {
                ++out.left_out;
                continue;
            }
            add_events(region, {{part.outline}, plane, s.region, false, 2 * radius}, effect, candidates, nullptr, out);
        }
    }
}

}  // namespace exitance
