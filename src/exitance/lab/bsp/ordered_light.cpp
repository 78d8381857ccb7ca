#include "exitance/lab/bsp/ordered_light.hpp"

#include <algorithm>

#include "exitance/lab/bsp/merged_volumes.hpp"

namespace exitance {

/// Umbra and penumbra volume of one candidate blocker and one source.
struct OrderedLight::Volume {
    PieceId piece;
    ShadowVolume shadow;

    /// True if the blocker hides all of the source from all of the face.
    bool hides(std::span<const Point> face, Counts& counts) const {
        return shadow.has_umbra() && shadow.in_umbra(face, counts.plane_tests) == ShadowVolume::Place::inside;
    }
};

/// The volumes of all candidates of one source.
struct OrderedLight::SourceVolumes {
    std::vector<Volume> all;
    std::optional<MergedVolumes> merged = {};
};

OrderedLight::OrderedLight(const DirectLight& direct, bool merges_volumes) : direct_(&direct), merges_(merges_volumes) {
    std::vector<Normal> normals;
    for (std::uint32_t e = 0; e < direct.emitters().size() && !direct.is_distant(e); ++e) {
        const DirectLight::Emitter& emitter = direct.emitters()[e];
        std::vector<Point>& corners = corners_.emplace_back();
        for (const auto& loop : direct.occluders().scene().regions()[emitter.region].loops)
            corners.insert(corners.end(), loop.begin(), loop.end());
        normals.push_back(emitter.plane.n);
    }
    lists_.emplace(direct.occluders(), corners_, normals);
}

bool OrderedLight::face_each_other(std::span<const Point> receiver, const Normal& n,
                                   const DirectLight::SourceName& source) const {
    const Occluders& occluders = direct_->occluders();
    const Plane plane{n, dot(n, receiver[0])};
    const auto rises_over = [&](std::span<const Point> points, const Plane& p) {
        return std::any_of(points.begin(), points.end(),
                           [&](const Point& x) { return p.signed_distance(x) > occluders.rounding(); });
    };
    return rises_over(receiver, direct_->emitters()[source.emitter].plane) &&
           rises_over(occluders.corners(source.piece), plane);
}

/// Bit k: corner k of the emitter is above the receiver's plane. If a rectangle replaces the corners, all bits are set.
std::uint64_t OrderedLight::corners_over(std::uint32_t emitter, std::span<const Point> receiver,
                                         const Normal& n) const {
    std::uint64_t out = 0;
    const std::size_t count = lists_->corner_count(emitter);
    const bool own = lists_->has_own_corners(emitter);
    for (std::size_t k = 0; k < count; ++k)
        if (!own || dot(n, corners_[emitter][k] - receiver[0]) > direct_->occluders().rounding())
            out |= std::uint64_t(1) << k;
    return out;
}

/// Returns the volumes of all pieces that may block a source seen from the region's outline. `is_hidden`: set if one of
/// them hides the source from all of the outline.
std::vector<OrderedLight::Volume> OrderedLight::volumes_before(const DirectLight::SourceName& source,
                                                               std::span<const Point> outline, RegionId region,
                                                               bool& is_hidden, Counts& counts) const {
    const Occluders& occluders = direct_->occluders();
    const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
    const MinimumLists::Limits limits = lists_->limits(source.emitter, region);
    std::vector<Volume> out;
    std::uint64_t before = 0;
    for (const PieceId p : occluders.pieces().ids()) {
        const ConvexPiece& c = occluders.pieces()[p];
        if (occluders.is_distant(p) || occluders.is_own(c.region, region) || c.region == emitter.region) continue;
        const std::uint64_t corners = lists_->stands_before(source.emitter, p, limits);
        if (corners == 0) continue;
        before |= corners;
        out.push_back({p, ShadowVolume(occluders.corners(source.piece), emitter.plane, occluders.corners(p), c.plane,
                                       occluders.rounding())});
    }
    std::erase_if(out, [&](const Volume& v) {
        return v.shadow.is_empty() || v.shadow.in_penumbra(outline, counts.plane_tests) == ShadowVolume::Place::outside;
    });
    const Normal& n = occluders.scene().regions()[region].plane.n;
    is_hidden = (corners_over(source.emitter, outline, n) & ~before) == 0 &&
                std::any_of(out.begin(), out.end(), [&](const Volume& v) { return v.hides(outline, counts); });
    return out;
}

namespace {

/// Appends the sources and candidates of one light to those of another.
void append(const ReceiverLight& more, ReceiverLight& light) {
    const auto first = static_cast<std::uint32_t>(light.candidates.size());
    for (ReceiverLight::Source s : more.sources) s.first += first, light.sources.push_back(s);
    for (Beam b : more.beams) b.first += first, light.beams.push_back(b);
    light.candidates.insert(light.candidates.end(), more.candidates.begin(), more.candidates.end());
}

}  // namespace

ReceiverLight OrderedLight::look(std::span<const Point> outline, RegionId region, DirectLight::Workspace& workspace,
                                 Counts& counts) const {
    const Occluders& occluders = direct_->occluders();
    const Scene& scene = occluders.scene();
    const Normal& n = scene.regions()[region].plane.n;
    ReceiverLight out;
    std::vector<DirectLight::SourceName> distant;
    for (std::uint32_t e = 0; e < direct_->emitters().size(); ++e)
        if (direct_->is_distant(e) && direct_->shines_on(direct_->emitters()[e], region))
            for (const PieceId piece : direct_->emitters()[e].pieces) distant.push_back({e, piece});
    direct_->prepare(outline, n, region, distant, out, workspace);
    if (!scene.behind(region).is_none()) return out;  // all sources of a diffusing pane, both sides, use shafts
    if (!direct_->beams().empty()) direct_->beams().prepare(outline, n, region, out.beams, out.candidates);
    ReceiverLight open = {}, rest = {};
    open.n = n, open.own = region;
    for (std::uint32_t e = 0; e < corners_.size(); ++e) {
        const DirectLight::Emitter& emitter = direct_->emitters()[e];
        if (!direct_->shines_on(emitter, region)) continue;
        for (const PieceId piece : emitter.pieces) {
            if (!face_each_other(outline, n, {e, piece})) continue;
            bool hidden = false;
            const std::vector<Volume> candidates = volumes_before({e, piece}, outline, region, hidden, counts);
            if (hidden) continue;
            if (candidates.empty()) {
                open.sources.push_back({e, piece});
                continue;
            }
            rest.sources.push_back({e, piece, static_cast<std::uint32_t>(rest.candidates.size()),
                                    static_cast<std::uint32_t>(candidates.size())});
            for (const Volume& v : candidates) rest.candidates.push_back(v.piece);
        }
    }
    // Sources without candidates come first: they are evaluated in one batch.
    ReceiverLight light;
    direct_->prepare(outline, open, light, workspace);
    append(rest, light), append(out, light);
    return light;
}

/// The volumes of all candidates of one source. If volumes are merged, they are built for points within `space`.
OrderedLight::SourceVolumes OrderedLight::volumes_of(const ReceiverLight& whole, const ReceiverLight::Source& source,
                                                     const Box& space) const {
    const Occluders& occluders = direct_->occluders();
    SourceVolumes out;
    for (const PieceId p : std::span(whole.candidates).subspan(source.first, source.count))
        out.all.push_back({p, ShadowVolume(occluders.corners(source.piece), direct_->emitters()[source.emitter].plane,
                                           occluders.corners(p), occluders.pieces()[p].plane, occluders.rounding())});
    if (!merges_) return out;
    out.merged.emplace(space, occluders.rounding());
    for (const Volume& v : out.all) out.merged->add(v.shadow);
    return out;
}

/// True if all of a source is hidden from a face. Otherwise appends the blockers that may hide part of it to
/// `candidates`.
bool OrderedLight::hides(const SourceVolumes& volumes, std::span<const Point> face, const ReceiverLight& whole,
                         const ReceiverLight::Source& source, std::vector<PieceId>& candidates, Counts& counts) const {
    const MinimumLists::Limits limits = lists_->limits(source.emitter, whole.own, face, whole.n);
    MergedVolumes::Classes classes;
    if (volumes.merged) volumes.merged->classify(face, classes, counts.plane_tests);
    if (classes.is_hidden) return true;
    std::uint64_t before = 0;
    std::vector<const Volume*> reaching;
    for (std::uint32_t i = 0; i < volumes.all.size(); ++i) {
        const Volume& v = volumes.all[i];
        const std::uint64_t corners = lists_->stands_before(source.emitter, v.piece, limits);
        before |= corners;
        if (corners == 0) continue;
        const bool reaches = volumes.merged
                                 ? std::binary_search(classes.reached.begin(), classes.reached.end(), i)
                                 : v.shadow.in_penumbra(face, counts.plane_tests) != ShadowVolume::Place::outside;
        if (reaches) reaching.push_back(&v);
    }
    for (const Volume* v : reaching) candidates.push_back(v->piece);
    return !volumes.merged && (corners_over(source.emitter, face, whole.n) & ~before) == 0 &&
           std::any_of(reaching.begin(), reaching.end(), [&](const Volume* v) { return v->hides(face, counts); });
}

/// The volumes of each source's candidates, in the order of `whole.sources`. Sources that shafts process get none and
/// are copied to `others`: the sky, point and parallel lights, unblocked sources, and all sources of diffusing panes.
std::vector<OrderedLight::SourceVolumes> OrderedLight::volumes_of(const ReceiverLight& whole, const Box& space,
                                                                  ReceiverLight& others) const {
    std::vector<SourceVolumes> out;
    others.n = whole.n, others.own = whole.own;
    others.behind = whole.behind, others.through = whole.through;
    others.beams = whole.beams, others.candidates = whole.candidates;
    for (const ReceiverLight::Source& s : whole.sources) {
        const bool by_shafts = !whole.behind.empty() || !is_listed(s.emitter) || s.count == 0;
        if (by_shafts) others.sources.push_back(s);
        out.push_back(by_shafts ? SourceVolumes() : volumes_of(whole, s, space));
    }
    return out;
}

void OrderedLight::look(const FaceOutlines& outlines, const ReceiverLight& whole, std::span<ReceiverLight> lights,
                        const StopRequest& stop, DirectLight::Workspace& workspace, Counts& counts) const {
    for (ReceiverLight& light : lights) light.n = whole.n, light.own = whole.own;
    if (whole.is_dark()) return;
    const Occluders& occluders = direct_->occluders();
    Box space;
    for (const auto& face : outlines.faces)
        for (const Point& p : face) space.add(p);
    ReceiverLight others, open;
    const std::vector<SourceVolumes> volumes = volumes_of(whole, space, others);
    for (std::size_t f = 0; f < lights.size() && !stop.requested(); ++f) {
        const std::span<const Point> face = outlines.faces[f];
        open = others;
        std::vector<std::pair<std::size_t, std::vector<PieceId>>> partly;
        std::vector<PieceId> listed;
        for (std::size_t k = 0; k < volumes.size(); ++k) {
            if (volumes[k].all.empty()) continue;
            const ReceiverLight::Source& s = whole.sources[k];
            if (!face_each_other(face, whole.n, {s.emitter, s.piece})) continue;
            std::vector<PieceId> candidates;
            if (hides(volumes[k], face, whole, s, candidates, counts)) continue;
            if (candidates.empty()) {
                open.sources.push_back({s.emitter, s.piece});
                continue;
            }
            partly.emplace_back(k, std::move(candidates));
            const MinimumLists::Limits limits = lists_->limits(s.emitter, whole.own, face, whole.n);
            for (const PieceId p : occluders.pieces().ids())
                if (!occluders.is_distant(p) && lists_->stands_before(s.emitter, p, limits) != 0) listed.push_back(p);
        }
        ReceiverLight& light = lights[f];
        direct_->prepare(face, open, light, workspace);
        for (const auto& [k, pieces] : partly) {
            const ReceiverLight::Source& s = whole.sources[k];
            light.sources.push_back({s.emitter, s.piece, static_cast<std::uint32_t>(light.candidates.size()),
                                     static_cast<std::uint32_t>(pieces.size())});
            light.candidates.insert(light.candidates.end(), pieces.begin(), pieces.end());
        }
        if (listed.empty()) continue;
        std::sort(listed.begin(), listed.end());
        counts.listed += static_cast<std::size_t>(std::unique(listed.begin(), listed.end()) - listed.begin());
        ++counts.faces;
    }
}

WedgeLists OrderedLight::wedge_lists(std::uint32_t emitter, RegionId region) const {
    WedgeLists out;
    const MinimumLists::Limits limits = lists_->limits(emitter, region);
    for (std::size_t k = 0; k < limits.size(); ++k) out.of_corner.push_back(lists_->in_order(emitter, k, limits));
    std::vector<PieceId> all;
    for (const auto& list : out.of_corner) all.insert(all.end(), list.begin(), list.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    out.of_all = std::move(all);
    if (!lists_->has_own_corners(emitter)) out.of_corner.assign(corners_[emitter].size(), out.of_all);
    return out;
}

}  // namespace exitance
