#include "exitance/transport/direct_light.hpp"

#include <algorithm>

namespace exitance {
namespace {

/// Can the emitter's front and the receiver's upper side meet at all? Cheap; errs to yes.
bool may_see(const Receiver& at, const DirectLight::Emitter& emitter, double rounding) {
    return emitter.plane.signed_distance(at.x) > 0 && dot(at.n, emitter.centre - at.x) > -emitter.radius - rounding;
}

}  // namespace

DirectLight::DirectLight(const Scene& scene, const Occluders& occluders) : occluders_(&occluders) {
    for (RegionId r : scene.regions().ids()) {
        if (!scene.material(r).emits()) continue;
        const Region& region = scene.regions()[r];
        Emitter emitter{r, scene.material(r).exitance, region.plane, {}, 0, occluders.pieces(r)};
        Box box;
        for (PieceId p : emitter.pieces)
            for (const Point& corner : occluders.corners(p)) box.add(corner);
        emitter.centre = box.centre();
        for (PieceId p : emitter.pieces)
            for (const Point& corner : occluders.corners(p))
                emitter.radius = std::max(emitter.radius, norm(corner - emitter.centre));
        emitters_.push_back(emitter);
    }
}

double DirectLight::form_factor(const Receiver& at, const Emitter& emitter, Workspace& scratch) const {
    if (emitter.region == at.own || !may_see(at, emitter, occluders_->rounding())) return 0;
    double sum = 0;
    for (PieceId piece : emitter.pieces) sum += visible_form_factor(*occluders_, at, piece, scratch);
    return sum;
}

Spectrum DirectLight::irradiance(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const {
    const Receiver at{x, n, own};
    Spectrum sum;
    for (const Emitter& emitter : emitters_) {
        const double f = form_factor(at, emitter, scratch);
        if (f > 0) sum += f * emitter.exitance;
    }
    return sum;
}

}  // namespace exitance
