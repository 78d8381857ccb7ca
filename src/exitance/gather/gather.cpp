#include "exitance/gather/gather.hpp"

#include <algorithm>
#include <bit>

#include "exitance/form_factors/met_directions.hpp"
#include "exitance/transport/light_portals.hpp"

namespace exitance {

namespace {

/// Reads b at the hits of the last cast and returns the sums for each of the `places`.
std::span<const QuarterSums> quarter_sums(const ReflectedLight& b, std::size_t places, GatherWorkspace& w) {
    w.values.resize(w.fronts.size());
    b.read(w.fronts, w.values);
    for (std::size_t k = 0; k < w.colours.size(); ++k) w.values[k] *= w.colours[k];
    w.sums.assign(places, {});
    for (std::size_t k = 0; k < w.fronts.size(); ++k)
        w.sums[w.share[k] / 4][w.share[k] % 4] += w.counts.empty() ? w.values[k] : w.counts[k] * w.values[k];
    return w.sums;
}

Gathered estimate(QuarterSums quarter, unsigned rays) {
    Gathered out;
    for (Spectrum& q : quarter) {
        q *= 4.0 / rays;
        out.irradiance += q / 4;
    }
    for (const Spectrum& q : quarter) out.quarters += 1.0 / 12 * ((q - out.irradiance) * (q - out.irradiance));
    const Spectrum apart = 1.0 / 4 * (quarter[0] + quarter[1] - quarter[2] - quarter[3]);
    out.halves = apart * apart;
    return out;
}

/// Chooses rays with density cos / pi from places of a plane: points `first`, first + 1, ... of each place's sequence,
/// which is selected by its key and `name`. Writes origins and sorted points to the beginning of `w`.
void choose_evenly(std::span<const GatherPlace> places, unsigned rays, unsigned first, std::uint64_t name,
                   GatherWorkspace& w) {
    for (std::size_t d = 0; d < 2; ++d) w.coordinates[d].resize(rays), w.sorted[d].resize(places.size() * rays);
    // The tracer is fastest with packets of similar directions. A power of two of these points fills every cell of a
    // grid over the unit square equally, so that each cell gives a packet: sixteen points of one place, or fewer of
    // each of several places.
    constexpr std::size_t packet = 16;
    const auto wanted = static_cast<unsigned>(packet / std::bit_floor(std::min(places.size(), packet)));
    const unsigned per_cell = std::min(rays, wanted);
    const int bits = std::bit_width(rays) - std::bit_width(per_cell);
    const std::uint32_t columns = 1u << (bits - bits / 2), rows = 1u << (bits / 2);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const ScrambledSobol points(name == 0 ? places[i].key : hash(places[i].key, name));
        for (int d = 0; d < 2; ++d) points.fill(first, d, w.coordinates[static_cast<std::size_t>(d)]);
        w.filled.assign(columns * rows, 0);
        for (std::uint32_t k = 0; k < rays; ++k) {
            const double a = w.coordinates[0][k], b = w.coordinates[1][k];
            const std::uint32_t cell =
                static_cast<std::uint32_t>(a * columns) * rows + static_cast<std::uint32_t>(b * rows);
            const std::size_t slot = (cell * places.size() + i) * per_cell + w.filled[cell]++;
            EXI_ASSERT(w.filled[cell] <= per_cell);
            w.sorted[0][slot] = a, w.sorted[1][slot] = b;
            w.origins[slot] = places[i].x;
            w.quarter[slot] = static_cast<std::uint32_t>(4 * i + 4 * k / rays);
        }
    }
}

/// Names of the sequences of places that aim: for unaimed and for aimed rays.
constexpr std::uint64_t not_aimed = 1, at_openings = 2;

/// Adds as many aimed rays per place as there are unaimed ones (`even`), and sets the weights of all rays.
void aim_others(std::span<const GatherPlace> places, std::span<const PortalCell> cells, const Normal& n, unsigned even,
                unsigned first, std::vector<double>& counts, GatherWorkspace& w) {
    std::vector<PortalAim> aims(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) aims[i].set(cells, places[i].x, n);
    const std::size_t all = places.size() * even;
    for (std::size_t k = 0; k < all; ++k)
        counts[k] = aims[w.quarter[k] / 4].is_aimed_at(w.directions[k]) ? 0 : PortalAim::share;
    std::size_t slot = all;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const ScrambledSobol points(hash(places[i].key, at_openings));
        for (int d = 0; d < 2; ++d) points.fill(first, d, w.coordinates[static_cast<std::size_t>(d)]);
        for (std::uint32_t k = 0; k < even; ++k, ++slot) {
            const PortalAim::Ray ray = aims[i].aimed(w.coordinates[0][k], w.coordinates[1][k]);
            w.origins[slot] = places[i].x, w.directions[slot] = ray.direction;
            w.quarter[slot] = static_cast<std::uint32_t>(4 * i + 4 * k / even);
            counts[slot] = PortalAim::share * ray.weight;
        }
    }
}

/// Casts `rays` rays from each of the places of a plane, starting at point `first` of their sequences, and finds the
/// fronts that they hit. Half of them are aimed at openings if that reduces the noise and if each quarter has an aimed
/// ray.
void cast_together(const Stage& stage, std::span<const GatherPlace> places, const Normal& n, RegionId own,
                   unsigned rays, unsigned first, const BrightPlaces* bright, GatherWorkspace& w) {
    constexpr unsigned min_aimed = 4;
    std::span<const PortalCell> cells;
    if (rays >= 2 * min_aimed && bright && !own.is_none())
        cells = worth_aiming(stage, own, bright->of_room(stage.rooms.at(own, places[0].x)), places[0].x, n);
    else if (rays >= 2 * min_aimed)
        cells = portals_worth_aiming(stage, own, places[0].x, n);
    std::vector<PortalCell> parts;
    cells = cut_near_cells(cells, places[0].x, PortalAim::max_targets, parts);
    const std::size_t all = places.size() * rays;
    w.origins.resize(all), w.directions.resize(all), w.hits.resize(all), w.quarter.resize(all);
    const unsigned even = cells.empty() ? rays : rays / 2, from = cells.empty() ? first : first / 2;
    choose_evenly(places, even, from, cells.empty() ? 0 : not_aimed, w);
    met_directions(stage.scene, own, n, w.sorted[0], w.sorted[1], std::span(w.directions).first(places.size() * even));
    std::vector<double> counts(cells.empty() ? 0 : all);
    if (!cells.empty()) aim_others(places, cells, n, even, from, counts, w);
    stage.tracer.nearest(w.origins, w.directions, own, w.hits, Mirrored::followed);
    w.fronts.clear(), w.share.clear(), w.counts.clear(), w.colours.clear();
    for (std::size_t k = 0; k < all; ++k) {
        const RayHit& hit = w.hits[k];
        if (hit.surface.is_none() || !hit.front || (!cells.empty() && counts[k] == 0)) continue;
        w.fronts.push_back({place_of(stage.scene, hit, w.origins[k], w.directions[k]), hit.region});
        w.share.push_back(w.quarter[k]);
        if (!cells.empty()) w.counts.push_back(counts[k]);
        if (!stage.glass.empty()) w.colours.push_back(stage.glass.of(hit, w.origins[k], w.directions[k]));
    }
}

}  // namespace

void cast_gather(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays, std::uint64_t key,
                 const BrightPlaces* bright, GatherWorkspace& workspace) {
    const GatherPlace place{x, key};
    cast_together(stage, std::span(&place, 1), n, own, rays, 0, bright, workspace);
}

Gathered read_gather(const ReflectedLight& b, GatherWorkspace& w) {
    return estimate(quarter_sums(b, 1, w)[0], static_cast<unsigned>(w.hits.size()));
}

void GrowingGather::add(const QuarterSums& fresh, unsigned more) {
    // The previous rays become the first two quarters, the new ones the others.
    if (rays_ == 0)
        quarter_ = fresh;
    else
        quarter_ = {quarter_[0] + quarter_[1], quarter_[2] + quarter_[3], fresh[0] + fresh[1], fresh[2] + fresh[3]};
    rays_ += more;
}

void grow_together(const Stage& stage, std::span<const GatherPlace> places, const Normal& n, RegionId own,
                   unsigned rays, const ReflectedLight& b, std::span<GrowingGather* const> growing,
                   GatherWorkspace& w) {
    if (places.empty()) return;
    for (unsigned before = growing[0]->rays(); before < rays; before = growing[0]->rays()) {
        const unsigned more = before == 0 ? rays : before;
        cast_together(stage, places, n, own, more, before, b.bright_places(), w);
        const std::span<const QuarterSums> fresh = quarter_sums(b, places.size(), w);
        for (std::size_t i = 0; i < places.size(); ++i) growing[i]->add(fresh[i], more);
    }
}

Gathered GrowingGather::gathered() const {
    return estimate(quarter_, rays_);
}

Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const ReflectedLight& b, GatherWorkspace& workspace) {
    cast_gather(stage, x, n, own, rays, key, b.bright_places(), workspace);
    return read_gather(b, workspace);
}

Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const RadiosityAt& b, GatherWorkspace& workspace) {
    return gather_reflected(stage, x, n, own, rays, key, PointwiseLight(b), workspace);
}

}  // namespace exitance
