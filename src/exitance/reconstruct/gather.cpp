#include "exitance/reconstruct/gather.hpp"

#include <bit>

namespace exitance {

namespace {

std::array<Spectrum, 4> quarter_sums(const ReflectedLight& b, GatherWorkspace& w) {
    w.values.resize(w.fronts.size());
    b.read(w.fronts, w.values);
    std::array<Spectrum, 4> quarter{};
    for (std::size_t k = 0; k < w.fronts.size(); ++k) quarter[w.share[k]] += w.values[k];
    return quarter;
}

Gathered estimate(std::array<Spectrum, 4> quarter, unsigned rays) {
    Gathered out;
    for (Spectrum& q : quarter) {
        q *= 4.0 / rays;
        out.irradiance += 0.25 * q;
    }
    for (const Spectrum& q : quarter) out.quarters += 1.0 / 12 * ((q - out.irradiance) * (q - out.irradiance));
    const Spectrum apart = 0.25 * (quarter[0] + quarter[1] - quarter[2] - quarter[3]);
    out.halves = apart * apart;
    return out;
}

}  // namespace

void cast_gather(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays, std::uint64_t key,
                 GatherWorkspace& w, unsigned first) {
    const Frame frame(n);
    const ScrambledSobol points(key);
    w.origins.resize(1), w.directions.resize(rays), w.hits.resize(rays), w.quarter.resize(rays);
    for (std::size_t d = 0; d < 2; ++d) {
        w.coordinates[d].resize(rays), w.sorted[d].resize(rays);
        points.fill(first, static_cast<int>(d), w.coordinates[d]);
    }
    w.origins[0] = x;
    // The tracer is fastest with packets of like directions. A power of two of these points fills every cell of a
    // grid over the unit square alike, sixteen points a cell: so a packet is a cell.
    const unsigned bits = rays > 16 ? static_cast<unsigned>(std::bit_width(rays)) - 5 : 0;
    const std::uint32_t columns = 1u << (bits - bits / 2), rows = 1u << (bits / 2), per_cell = rays / (columns * rows);
    w.filled.assign(columns * rows, 0);
    for (std::uint32_t k = 0; k < rays; ++k) {
        const double a = w.coordinates[0][k], b = w.coordinates[1][k];
        const std::uint32_t cell =
            static_cast<std::uint32_t>(a * columns) * rows + static_cast<std::uint32_t>(b * rows);
        const std::uint32_t place = cell * per_cell + w.filled[cell]++;
        EXI_ASSERT(w.filled[cell] <= per_cell);
        w.sorted[0][place] = a, w.sorted[1][place] = b;
        w.quarter[place] = static_cast<std::uint8_t>(4 * k / rays);
    }
    cosine_directions(frame, w.sorted[0], w.sorted[1], w.directions);
    stage.tracer.nearest(w.origins, w.directions, own, w.hits);
    w.fronts.clear(), w.share.clear();
    for (std::uint32_t k = 0; k < rays; ++k) {
        const RayHit& hit = w.hits[k];
        if (hit.surface.is_none() || !hit.front) continue;
        w.fronts.push_back({hit.region, x + hit.distance * w.directions[k]});
        w.share.push_back(w.quarter[k]);
    }
}

Gathered read_gather(const ReflectedLight& b, GatherWorkspace& w) {
    return estimate(quarter_sums(b, w), static_cast<unsigned>(w.hits.size()));
}

void GrowingGather::grow(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                         std::uint64_t key, const ReflectedLight& b, GatherWorkspace& w) {
    while (rays_ < rays) {
        const unsigned more = rays_ == 0 ? rays : rays_;
        cast_gather(stage, x, n, own, more, key, w, rays_);
        const std::array<Spectrum, 4> fresh = quarter_sums(b, w);
        // What there was becomes the first two quarters, what is new the others.
        if (rays_ == 0)
            quarter_ = fresh;
        else
            quarter_ = {quarter_[0] + quarter_[1], quarter_[2] + quarter_[3], fresh[0] + fresh[1], fresh[2] + fresh[3]};
        rays_ += more;
    }
}

Gathered GrowingGather::gathered() const {
    return estimate(quarter_, rays_);
}

Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const ReflectedLight& b, GatherWorkspace& workspace) {
    cast_gather(stage, x, n, own, rays, key, workspace);
    return read_gather(b, workspace);
}

Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const RadiosityAt& b, GatherWorkspace& workspace) {
    return gather_reflected(stage, x, n, own, rays, key, PointwiseLight(b), workspace);
}

}  // namespace exitance
