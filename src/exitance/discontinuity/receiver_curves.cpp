#include "exitance/discontinuity/receiver_curves.hpp"

#include <algorithm>
#include <map>

#include "exitance/discontinuity/cover_ends.hpp"
#include "exitance/shadow_lines/three_edge_events.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {
namespace {

// Curves closer together than this share of the scene's size are merged.
constexpr double nearness = 2e-8;  // derived from the rounding error where long wedges meet a plane

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

/// Bounding box of a region in its own coordinates.
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

/// The region's outline if convex, otherwise a rectangle around it: a polygon from which lights are prepared.
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

/// Prepares the light of those sources that are strong enough to have curves on the region.
void CurveFinder::look_at_strong(RegionId number, ReceiverCurves& out, DirectLight::Workspace& workspace) const {
    const Region& region = stage_->scene.regions()[number];
    std::vector<DirectLight::SourceName> sources;
    for (const DirectLight::SourceName& s : options_.weak->strong(number)) {
        const DirectLight::Emitter& emitter = stage_->direct.emitters()[s.emitter];
        const Effect effect{.centre = emitter.centre,
                            .radius = emitter.radius,
                            .weight = mean(light_weight(stage_->scene.material(number)) * emitter.exitance),
                            .area = stage_->scene.regions()[emitter.region].area};
        if (region.area >= options_.min_area && max_effect(number, emitter, s.emitter, effect) >= options_.min_effect)
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
    const bool is_followed = !options_.regions || (*options_.regions)[number];
    if (region.area >= options_.min_area && is_followed)
        add_events(number, out), add_secondary(number, out), add_curves_behind(number, out);
    else if (!out.light.is_unshadowed())
        out.left_out += out.light.sources.size();
    if (options_.stop && options_.stop->requested()) return out;
    ArrangedCurves arranged = arranged_curves(std::move(out.curves), out.loops, nearness * stage_->scene.size());
    out.curves = std::move(arranged.curves), out.loops = std::move(arranged.loops);
    if (out.curves.size() > options_.max_curves) {
        const auto effect = [](const FlatCurve& c) { return c.order == CurveOrder::d0 ? HUGE_VAL : c.effect(); };
        std::stable_sort(out.curves.begin(), out.curves.end(),
                         [&](const FlatCurve& a, const FlatCurve& b) { return effect(a) > effect(b); });
        out.left_out += out.curves.size() - options_.max_curves;
        out.curves.resize(options_.max_curves);
    }
    return out;
}

/// Adds the curves of a diffusing pane's other side, whose light is transmitted.
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

/// Upper bound on a source's light anywhere on a region, W/m^2 of rho E: M A / (pi d^2), at most M.
double CurveFinder::max_effect(RegionId region, const Effect& effect) const {
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

/// The bound for an emitter, which uses the bound of WeakLight as well, if there is one.
double CurveFinder::max_effect(RegionId region, const DirectLight::Emitter& emitter, std::uint32_t number,
                               const Effect& effect) const {
    const double by_distance = max_effect(region, effect);
    if (!options_.weak) return by_distance;
    const double M = mean(emitter.exitance);
    return std::min(by_distance, M > 0 ? effect.weight * options_.weak->bound(region, number) / M : 0);
}

/// Upper bound on the light of a source at points of the region that see it past an edge, W/m^2 of rho E. Let d be the
/// edge's distance from the source's centre minus three radii. A point x there is at least d from any point s of the
/// source: the line of sight past the edge passes it before it reaches the source, and two lines of sight differ by no
/// more than two points of the source do. So E is at most M A / (pi d^2) times two cosines: at x, h/d, where h is the
/// source's height over the region's plane; at s, the edge's height over the source's plane divided by d.
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
    std::map<std::uint32_t, std::vector<PieceId>> blockers;  // the blockers of each emitter
    const auto candidates = [&](const auto& from) {
        return std::span(out.light.candidates).subspan(from.first, from.count);
    };
    for (const ReceiverLight::Source& s : out.light.sources)
        for (const PieceId p : candidates(s)) blockers[s.emitter].push_back(p);
    for (const auto& [number, pieces] : blockers) {
        if (options_.stop && options_.stop->requested()) return;
        const DirectLight::Emitter& emitter = stage_->direct.emitters()[number];
        if (stage_->direct.is_distant(number)) continue;  // bisection resolves the shadows of skies and suns
        Effect effect{.centre = emitter.centre,
                      .radius = emitter.radius,
                      .weight = mean(light_weight(stage_->scene.material(region)) * emitter.exitance),
                      .area = stage_->scene.regions()[emitter.region].area};
        effect.gain = max_effect(region, emitter, number, effect);
        if (effect.gain < options_.min_effect) {
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
        // A directional light is treated as a point so far away that its shadows are accurate to 1e-8 of the scene's
        // size.
        // Distance in sizes of the scene, derived from double precision: its square keeps all digits.
        constexpr double far_distance = 1e8;
        const Point place = light.is_directional()
                                ? stage_->scene.box().centre() - (far_distance * stage_->scene.size()) * light.direction
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
    // Past edges far from the source, the light and its shadow are too weak to matter.
    std::vector<std::uint32_t> strong;
    std::vector<double> gains;
    for (const std::uint32_t e : edges) {
        const double gain = effect_beyond(edges_->edges()[e], source, effect, out);
        if (gain >= options_.min_effect) strong.push_back(e), gains.push_back(gain);
    }
    out.left_out += edges.size() - strong.size();
    const FlatBox box(out.loops);
    ShadowEventFinder finder(stage_->occluders, *edges_,
                             {gains, options_.min_bend, options_.min_narrow_bend, options_.stop, lists});
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
    // Two edges that each hide half of the source leave a quarter of it together.
    const double least = (options_.conics == ConicCurves::all ? 1 : 4) * options_.min_bend;
    if (source.is_point || effect.gain < least) return;
    std::erase_if(edges,
                  [&](std::uint32_t e) { return effect_beyond(edges_->edges()[e], source, effect, out) < least; });
    add_non_emitter_events(region, source, effect.gain, lists, edges, out);
}

/// Adds NEV and EEE events. They come from pairs of blockers' edges: above a limit, bisection has to resolve them
/// instead.
void CurveFinder::add_non_emitter_events(RegionId region, const EventSource& source, double gain,
                                         const WedgeLists* lists, std::span<const std::uint32_t> edges,
                                         ReceiverCurves& out) const {
    if (edges.size() > options_.max_edges) {
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
    // A larger deviation would place points between a conic and its polyline on the wrong side.
    // Share of the region's width, derived from the D2 error, which grows with its third power.
    constexpr double max_sagitta = 1e-3;
    const double sagitta = max_sagitta * std::min(box.hi.x - box.lo.x, box.hi.y - box.lo.y);
    std::vector<ThreeEdgeEvent> conics;
    ThreeEdgeEventFinder(stage_->occluders, *edges_, options_.stop)
        .find({out.frame, region, box.lo, box.hi}, source, edges, options_.conics == ConicCurves::at_umbras, sagitta,
              conics);
    for (const ThreeEdgeEvent& c : conics)
        for (std::size_t i = 1; i < c.places.size(); ++i)
            out.curves.push_back(
                {c.places[i - 1], c.places[i], CurveOrder::eee, CurveCause::three_edges, source.region, gain});
}

/// Adds the events of secondary sources. A shaft between the region and each part of a source finds the blockers.
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
            effect.gain = max_effect(region, effect);
            if (effect.gain < options_.min_effect) {
                ++out.left_out;
                continue;
            }
            add_events(region, {{part.outline}, plane, s.region, false, 2 * radius}, effect, candidates, nullptr, out);
        }
    }
}

}  // namespace exitance
