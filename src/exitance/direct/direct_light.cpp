#include "exitance/direct/direct_light.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/visibility/glazed_part.hpp"
#include "exitance/visibility/window_view.hpp"

namespace exitance {
namespace {

/// True unless the emitter's front and the receiver's upper side certainly do not face each other. Cheap and
/// conservative.
bool may_see(const SurfacePoint& at, const DirectLight::Emitter& emitter, double rounding) {
    return emitter.plane.signed_distance(at.x) > rounding &&
           dot(at.n, emitter.centre - at.x) > -emitter.radius - rounding;
}

/// True if nothing in the scene is above a receiver's plane, so that nothing occludes the sky.
bool is_on_top(const Occluders& occluders, const Point& x, const Normal& n) {
    const Box& box = occluders.scene().box();
    const double highest = std::max(n.x * box.lo.x, n.x * box.hi.x) + std::max(n.y * box.lo.y, n.y * box.hi.y) +
                           std::max(n.z * box.lo.z, n.z * box.hi.z);
    return highest <= dot(n, x) + occluders.rounding();
}

}  // namespace

void ReceiverLight::clear() {
    sources.clear(), beams.clear(), candidates.clear();
    open.clear(), open_light.clear();
    behind.clear(), through = 0;
}

DirectLight::DirectLight(const Scene& scene, const Occluders& occluders)
    : scene_(&scene), occluders_(&occluders), beams_(scene.lights(), occluders) {
    for (RegionId r : scene.regions().ids()) {
        if (!scene.material(r).emits()) continue;
        const Region& region = scene.regions()[r];
        Emitter emitter{
            r, scene.material(r).exitance, region.plane, {}, 0, occluders.pieces(r), scene.relative_radiance(r)};
        Box box;
        for (PieceId p : emitter.pieces)
            for (const Point& corner : occluders.corners(p)) box.add(corner);
        emitter.centre = box.centre();
        for (PieceId p : emitter.pieces)
            for (const Point& corner : occluders.corners(p))
                emitter.radius = std::max(emitter.radius, norm(corner - emitter.centre));
        emitters_.push_back(emitter);
    }
    add_distant_emitters(scene);
}

DirectLight::Emitter DirectLight::emitter_of(PieceId p, const Spectrum& exitance) const {
    Emitter emitter{RegionId(), exitance, occluders_->pieces()[p].plane, {}, 0, {p.value, p.value + 1}};
    const std::span<const Point> corners = occluders_->corners(p);
    emitter.centre = centroid(corners);
    for (const Point& corner : corners) emitter.radius = std::max(emitter.radius, norm(corner - emitter.centre));
    return emitter;
}

void DirectLight::add_distant_emitters(const Scene& scene) {
    first_distant_ = emitters_.size();
    if (scene.distant().empty()) return;  // although the occluders may be of a scene that has some (light groups)
    const std::vector<DistantFacet> facets = distant_facets(scene.distant());
    std::size_t next = 0;
    for (const PieceId p : occluders_->distant_pieces()) {
        const DistantFacet& facet = facets[next++];
        Emitter emitter = emitter_of(p, facet.exitance);
        if (facet.sky) emitter.radiance = RelativeRadiance(*facet.sky, facet.smooth_width, facet.n);
        if (facet.is_dome) emitter.sky = Emitter::Sky::open;
        emitters_.push_back(emitter);
    }
    add_windows(scene);
}

/// Adds one emitter per window if all bands are equal, else one per band.
void DirectLight::add_windows(const Scene& scene) {
    const auto& domes = scene.distant().domes;
    const bool is_grey_sky =
        std::all_of(domes.begin(), domes.end(), [&](const auto& d) { return is_grey(d.irradiance); });
    const Enclosure& enclosure = occluders_->enclosure();
    for (std::size_t i = 0; i < enclosure.windows.size(); ++i) {
        const Pane& pane = enclosure.windows[i];
        const bool together = is_grey_sky && is_grey(pane.transmissivity);
        for (std::size_t band = 0; band < (together ? 1 : bands); ++band) {
            Spectrum one(together ? 1.0 : 0.0);
            one[band] = 1;
            auto window = std::make_unique<const SkyWindow>(pane, scene.distant(), band);
            if (window->is_dark()) continue;
            one *= window->reference();
            Emitter emitter = emitter_of(occluders_->windows()[i], one);
            emitter.radiance = RelativeRadiance(*window, pane.n);
            emitter.sky = Emitter::Sky::window;
            emitters_.push_back(emitter);
            windows_.push_back(std::move(window));
        }
    }
}

void DirectLight::keep_only(std::span<const std::uint32_t> emitters, bool beams) {
    static const std::vector<PunctualLight> no_lights;
    std::vector<Emitter> kept;
    std::size_t first_distant = emitters.size();
    for (const std::uint32_t e : emitters) {
        if (is_distant(e)) first_distant = std::min(first_distant, kept.size());
        kept.push_back(emitters_[e]);
    }
    emitters_ = std::move(kept), first_distant_ = first_distant;
    if (!beams) beams_ = Beams(no_lights, *occluders_);
}

double DirectLight::form_factor(const SurfacePoint& at, const Emitter& emitter, Workspace& scratch) const {
    if (!shines_on(emitter, at.region) || !may_see(at, emitter, occluders_->rounding())) return 0;
    double sum = 0;
    for (PieceId piece : emitter.pieces) sum += visible_form_factor(*occluders_, at, piece, scratch, emitter.radiance);
    return sum;
}

/// Projects the point to the plane of its region. Points from files and ray hits are off it by more than rounding, so
/// that the other side of a two-sided sheet could block all light.
SurfacePoint DirectLight::receiver(const Point& x, const Normal& n, RegionId own) const {
    if (own.is_none()) return {x, n, own};
    const Plane& plane = occluders_->scene().regions()[own].plane;
    return {x - (plane.signed_distance(x) - occluders_->lift(own)) * plane.n, n, own};
}

/// Light of one emitter, through panes if there are any.
Spectrum DirectLight::light_of(const Emitter& emitter, const SurfacePoint& at, Workspace& scratch) const {
    if (!is_glazed(emitter)) {
        const double f = form_factor(at, emitter, scratch);
        return f > 0 ? f * emitter.exitance : Spectrum();
    }
    Spectrum sum;
    if (!shines_on(emitter, at.region) || !may_see(at, emitter, occluders_->rounding())) return sum;
    for (PieceId piece : emitter.pieces)
        sum += emitter.exitance * glazed_form_factor(*occluders_, at, piece, {}, scratch, emitter.radiance);
    return sum;
}

Spectrum DirectLight::irradiance(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const {
    const Spectrum front = on_side(x, n, own, scratch);
    const RegionId behind = occluders_->scene().behind(own);
    if (behind.is_none()) return front;
    const double through = occluders_->scene().material(own).through;
    return (1 - through) * front + through * on_side(x, -n, behind, scratch);
}

std::optional<Spectrum> DirectLight::irradiance_within(const Point& x, const Normal& n, RegionId own, double max_work,
                                                       Workspace& scratch) const {
    scratch.work = 0, scratch.max_work = max_work;
    const Spectrum found = irradiance(x, n, own, scratch);
    scratch.max_work = HUGE_VAL;
    return scratch.work > max_work ? std::nullopt : std::optional(found);
}

Spectrum DirectLight::on_side(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const {
    const SurfacePoint at = receiver(x, n, own);
    Spectrum sum;
    for (const Emitter& emitter : emitters_) {
        sum += light_of(emitter, at, scratch);
        if (scratch.gave_up()) return {};
    }
    return beams_.empty() ? sum : sum + beams_.irradiance(at);
}

void DirectLight::prepare(std::span<const Point> receiver, const Normal& n, RegionId own, ReceiverLight& light,
                          Workspace& scratch, const WorthCounting& worth) const {
    const RegionId behind = occluders_->scene().behind(own);
    prepare_side(receiver, n, own, light, scratch, worth);
    if (behind.is_none()) return;
    light.behind.resize(1), light.through = occluders_->scene().material(own).through;
    const std::vector<Point> turned(receiver.rbegin(), receiver.rend());
    prepare_side(turned, -n, behind, light.behind[0], scratch, worth);
}

void DirectLight::prepare_side(std::span<const Point> receiver, const Normal& n, RegionId own, ReceiverLight& light,
                               Workspace& scratch, const WorthCounting& worth) const {
    light.n = n, light.own = own;
    light.clear();
    const Point middle = centroid(receiver);
    double radius = occluders_->rounding();
    for (const Point& p : receiver) radius = std::max(radius, norm(p - middle));
    for (std::uint32_t e = 0; e < emitters_.size(); ++e) {
        const Emitter& emitter = emitters_[e];
        if (!shines_on(emitter, own) || emitter.plane.signed_distance(middle) <= -radius ||
            dot(n, emitter.centre - middle) <= -emitter.radius)
            continue;
        for (PieceId piece : emitter.pieces) look_at({e, piece}, receiver, light, scratch, worth);
    }
    if (!beams_.empty()) beams_.prepare(receiver, n, own, light.beams, light.candidates);
}

void DirectLight::prepare(std::span<const Point> receiver, const Normal& n, RegionId own,
                          std::span<const SourceName> sources, ReceiverLight& light, Workspace& scratch,
                          const WorthCounting& worth) const {
    if (!occluders_->scene().behind(own).is_none()) return prepare(receiver, n, own, light, scratch, worth);
    light.n = n, light.own = own;
    light.clear();
    for (const SourceName& source : sources) look_at(source, receiver, light, scratch, worth);
}

void DirectLight::look_at(const SourceName& source, std::span<const Point> receiver, ReceiverLight& light,
                          Workspace& scratch, const WorthCounting& worth) const {
    const auto& [e, piece] = source;
    const Emitter& emitter = emitters_[e];
    if (std::all_of(receiver.begin(), receiver.end(),
                    [&](const Point& x) { return occluders_->lie_in_one_plane(x, light.n, source.piece); }))
        return;
    if (occluders_->has_nothing_inside() && !is_distant(e)) {
        if (face_each_other({light.n, dot(light.n, receiver[0])}, receiver, emitter.plane, occluders_->corners(piece)))
            add_open(source, receiver[0], light, scratch);
        return;
    }
    if (looks_far(e) && is_on_top(*occluders_, receiver[0], light.n)) {
        const auto is_above = [&](const Point& corner) { return dot(light.n, corner - occluders_->middle()) > 0; };
        const std::span<const Point> corners = occluders_->corners(piece);
        if (std::any_of(corners.begin(), corners.end(), is_above)) add_open(source, receiver[0], light, scratch);
        return;
    }
    scratch.shaft.set(*occluders_, {receiver, light.n, light.own},
                      {occluders_->corners(piece), emitter.plane.n, emitter.region, looks_far(e)});
    PieceId& likely = scratch.last_blocker(*occluders_, piece);
    if (!likely.is_none() && scratch.shaft.is_blocked_by(likely)) return;
    const std::size_t most = worth ? worth(source) : Shaft::all_candidates;
    View view = scratch.shaft.classify(scratch.candidates, most);
    const bool is_crowded = scratch.candidates.size() > most;
    if (view != View::none && looks_out_on_faces(*occluders_, piece)) {
        WindowView().add(*occluders_, {receiver, light.n, light.own}, piece, scratch.candidates);
        if (!scratch.candidates.empty()) view = View::mixed;
    }
    add_source(source, view, receiver[0], light, scratch);
    if (is_crowded) light.sources.back().is_crowded = true;
    if (!scratch.shaft.blocker().is_none()) likely = scratch.shaft.blocker();
}

void DirectLight::prepare(std::span<const Point> receiver, const ReceiverLight& whole, ReceiverLight& light,
                          Workspace& scratch) const {
    light.n = whole.n, light.own = whole.own;
    light.clear();
    for (const ReceiverLight::Source& source : whole.sources) {
        const SourceName name{source.emitter, source.piece};
        if (source.count == 0) {
            if (source.far_factor >= 0)
                light.sources.push_back(source);
            else
                add_open(name, receiver[0], light, scratch);
            continue;
        }
        const Emitter& emitter = emitters_[source.emitter];
        scratch.shaft.set(
            *occluders_, {receiver, whole.n, whole.own},
            {occluders_->corners(source.piece), emitter.plane.n, emitter.region, looks_far(source.emitter)});
        const auto from = std::span(whole.candidates).subspan(source.first, source.count);
        View view = scratch.shaft.classify(from, scratch.candidates);
        if (view != View::none && looks_out_on_faces(*occluders_, source.piece)) {
            WindowView().add(*occluders_, {receiver, whole.n, whole.own}, source.piece, from, scratch.candidates);
            if (!scratch.candidates.empty()) view = View::mixed;
        }
        add_source(name, view, receiver[0], light, scratch);
    }
    if (!whole.beams.empty())
        beams_.prepare(receiver, whole.n, whole.own, whole.beams, whole.candidates, light.beams, light.candidates);
    if (whole.behind.empty()) return;
    light.behind.resize(1), light.through = whole.through;
    const std::vector<Point> turned(receiver.rbegin(), receiver.rend());
    prepare(turned, whole.behind[0], light.behind[0], scratch);
}

bool DirectLight::face_each_other(const Plane& receiver_plane, std::span<const Point> receiver,
                                  const Plane& source_plane, std::span<const Point> source) const {
    const auto rises_over = [&](std::span<const Point> points, const Plane& plane) {
        return std::any_of(points.begin(), points.end(),
                           [&](const Point& p) { return plane.signed_distance(p) > occluders_->rounding(); });
    };
    return rises_over(receiver, source_plane) && rises_over(source, receiver_plane);
}

void DirectLight::add_source(const SourceName& source, View view, const Point& x, ReceiverLight& light,
                             Workspace& scratch) const {
    if (view == View::none) return;
    if (view == View::open) return add_open(source, x, light, scratch);
    light.sources.push_back({source.emitter, source.piece, static_cast<std::uint32_t>(light.candidates.size()),
                             static_cast<std::uint32_t>(scratch.candidates.size())});
    light.candidates.insert(light.candidates.end(), scratch.candidates.begin(), scratch.candidates.end());
}

void DirectLight::add_open(const SourceName& source, const Point& x, ReceiverLight& light, Workspace& scratch) const {
    const auto& [e, piece] = source;
    const std::span<const Point> corners = occluders_->corners(piece);
    const bool no_panes = occluders_->scene().panes().empty();
    const bool in_batch = corners.size() <= 4 && !emitters_[e].radiance.is_directed() && !is_distant(e) && no_panes;
    light.sources.push_back({.emitter = e, .piece = piece, .in_batch = in_batch});
    if (looks_far(e) && no_panes)
        light.sources.back().far_factor = visible_form_factor(*occluders_, receiver(x, light.n, light.own), piece, {},
                                                              scratch, emitters_[e].radiance);
    if (!in_batch) return;
    light.open.add({corners[0], corners[1], corners[2], corners[corners.size() - 1]});
    light.open_light.push_back(emitters_[e].exitance);
}

Spectrum DirectLight::irradiance(const ReceiverLight& light, const Point& x, Workspace& scratch,
                                 Spectrum* parallel) const {
    if (light.behind.empty()) return on_side(light, x, scratch, parallel);
    Spectrum outside, outside_behind;
    const Spectrum front = on_side(light, x, scratch, &outside),
                   back = on_side(light.behind[0], x, scratch, &outside_behind);
    if (parallel) *parallel += (1 - light.through) * outside + light.through * outside_behind;
    return (1 - light.through) * front + light.through * back;
}

Spectrum DirectLight::on_side(const ReceiverLight& light, const Point& x, Workspace& scratch,
                              Spectrum* parallel) const {
    const SurfacePoint at = receiver(x, light.n, light.own);
    Spectrum sum;
    scratch.factors.resize(light.open.size());
    point_to_quads(at.x, light.n, light.open, scratch.factors);
    for (std::size_t i = 0; i < scratch.factors.size(); ++i) sum += scratch.factors[i] * light.open_light[i];
    for (const ReceiverLight::Source& source : light.sources) {
        if (source.in_batch) continue;
        EXI_ASSERT(!source.is_crowded);
        const auto candidates = std::span(light.candidates).subspan(source.first, source.count);
        const Emitter& emitter = emitters_[source.emitter];
        const Spectrum light_there =
            emitter.exitance *
            (is_glazed(emitter)
                 ? glazed_form_factor(*occluders_, at, source.piece, candidates, scratch, emitter.radiance)
             : source.far_factor >= 0
                 ? Spectrum(source.far_factor)
                 : Spectrum(visible_form_factor(*occluders_, at, source.piece, candidates, scratch, emitter.radiance)));
        sum += light_there;
        if (parallel && is_distant(source.emitter)) *parallel += light_there;
    }
    return light.beams.empty() ? sum : sum + beams_.irradiance(at, light.beams, light.candidates, parallel);
}

}  // namespace exitance
