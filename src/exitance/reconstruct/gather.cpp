#include "exitance/reconstruct/gather.hpp"

namespace exitance {

Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays, std::uint64_t key,
                          const RadiosityAt& b, GatherWorkspace& w) {
    const Frame frame(n);
    const ScrambledSobol points(key);
    w.origins.assign(rays, x), w.directions.resize(rays), w.hits.resize(rays);
    for (std::uint32_t k = 0; k < rays; ++k) w.directions[k] = cosine_direction(frame, points(k, 0), points(k, 1));
    stage.tracer.nearest(w.origins, w.directions, own, w.hits);

    std::array<Spectrum, 4> quarter{};
    for (std::uint32_t k = 0; k < rays; ++k) {
        const RayHit& hit = w.hits[k];
        if (hit.surface.is_none() || !hit.front) continue;
        quarter[4 * k / rays] += b(stage.scene.surfaces()[hit.surface].region, x + hit.distance * w.directions[k]);
    }
    Gathered out;
    for (Spectrum& q : quarter) {
        q *= 4.0 / rays;
        out.irradiance += 0.25 * q;
    }
    for (const Spectrum& q : quarter) out.variance += 0.5 / 12 * ((q - out.irradiance) * (q - out.irradiance));
    return out;
}

}  // namespace exitance
