#include "exitance/what_if/daylight/daylight_transport.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/met_directions.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_sweeps = 200;
constexpr double max_change = 2e-4;  ///< Relative RMS change of the last sweep.

/// Returns the scene under a sky and a ground of radiance 1, which replace all patches, with grey glass.
Scene under_patches(Scene scene) {
    DistantLight light;
    SkyModel below = uniform_sky();
    below.below = true;
    light.domes = {{uniform_sky(), Spectrum(pi)}, {below, Spectrum(pi)}};
    scene.put_under(std::move(light));
    // This transport carries luminous light, one number instead of bands: rays must pass glass with its luminous
    // transmittance.
    scene.set_transmissivities([](const Pane& pane) {
        return is_grey(pane.transmissivity)
                   ? pane.transmissivity
                   : transmissivity_of(Spectrum(luminous_sum(pane.transmission(1))), pane.index);
    });
    return scene;
}

/// Adds places that rays have reached to the counts of earlier ones. Sorts `numbers`.
void add_ends(std::vector<std::uint32_t>& numbers, std::vector<RayCounts::End>& ends) {
    std::sort(numbers.begin(), numbers.end());
    std::vector<RayCounts::End> merged;
    merged.reserve(ends.size() + numbers.size());
    auto earlier = ends.begin();
    for (const std::uint32_t number : numbers) {
        while (earlier != ends.end() && earlier->number <= number) merged.push_back(*earlier++);
        if (merged.empty() || merged.back().number != number) merged.push_back({number, 0});
        ++merged.back().count;
    }
    merged.insert(merged.end(), earlier, ends.end());
    merged.shrink_to_fit();
    ends = std::move(merged);
}

/// Sends the light of all replicates, of `size` values each, to all processes.
void exchange_replicates(std::size_t size, ElementLight& light) {
    constexpr std::size_t together = std::size_t(1) << 20;  // values of a replicate that are sent in one round
    for (std::vector<float>& replicate : light.reflected) replicate.resize(size);
    for (std::size_t first = 0; first < size; first += together)
        exchange_values(
            daylight_replicates, 1,
            [&](std::size_t k) {
                return std::span(light.reflected[k]).subspan(first, std::min(together, size - first));
            },
            "replicates");
}

}  // namespace

SkyColumns SkyColumns::of_patches(std::size_t patches) {
    SkyColumns out;
    out.unit_patches_ = patches;
    return out;
}

void SkyColumns::add_light(std::span<const RayCounts::End> patches, std::span<const RayCounts::End> finer,
                           std::uint32_t rays, std::span<float> out) const {
    const double each = pi / std::max<double>(1, rays);
    if (unit_patches_ > 0)
        for (const auto& [patch, count] : patches) out[patch] += static_cast<float>(each * count);
    for (std::size_t c = 0; c < columns_.size(); ++c)
        for (const auto& [patch, count] : columns_[c].is_finer ? finer : patches)
            out[c] += static_cast<float>(each * columns_[c].luminances[patch] * count);
}

void SkyColumns::add_light(const RayCounts& ends, std::span<float> out) const {
    add_light(ends.patches, ends.finer, ends.rays, out);
}

void SkyColumns::add_light(const RayCounts::Through& ends, std::uint32_t rays, std::span<float> out) const {
    add_light(ends.patches, {}, rays, out);
}

void ElementLight::gather(std::size_t replicate, const RayCounts& ends, std::span<float> out) const {
    const float* const rows = reflected[replicate].data();
    std::fill(out.begin(), out.end(), 0.0f);
    for (const auto& [leaf, count] : ends.leaves) {
        const float share = static_cast<float>(count) / static_cast<float>(ends.rays);
        const float* const from = rows + leaf * columns;
        for (std::size_t k = 0; k < columns; ++k) out[k] += share * from[k];
    }
}

void ElementLight::add(std::size_t replicate, std::span<const RayCounts::End> ends, std::uint32_t rays, float sign,
                       std::span<float> out) const {
    const float* const rows = reflected[replicate].data();
    for (const auto& [leaf, count] : ends) {
        const float share = sign * static_cast<float>(count) / static_cast<float>(rays);
        const float* const from = rows + leaf * columns;
        for (std::size_t k = 0; k < columns; ++k) out[k] += share * from[k];
    }
}

struct DaylightTransport::Elements {
    Elements(const Stage& stage, double count)
        : tree(stage.make_elements({.edge = edge_for_elements(stage.pieces, static_cast<std::size_t>(count))})),
          numbering(tree),
          locator(tree, stage.scene.regions().size()) {}

    ElementTree tree;
    LeafNumbering numbering;
    ElementLocator locator;
};

void DaylightTransport::Deleter::operator()(Elements* elements) const {
    delete elements;
}

/// Arrays for casting, kept from row to row.
struct DaylightTransport::Found {
    std::vector<Point> origins;
    std::vector<Vec3> directions;
    std::vector<RayHit> hits;
    std::vector<std::uint32_t> leaves, patches, finer;
    struct Numbers {
        std::vector<std::uint32_t> leaves, patches;
    };
    std::vector<Numbers> through;  ///< Hits per set of crossed panes, in the order of RayCounts.
};

DaylightTransport::DaylightTransport(Scene scene, const SkyPatches& patches, const SkyPatches* finer,
                                     std::uint64_t seed, PaneGroups groups)
    : scene_(under_patches(std::move(scene))),
      stage_(scene_),
      patches_(patches),
      finer_(finer),
      groups_(std::move(groups)) {
    for (std::size_t k = 0; k < daylight_replicates; ++k) seeds_[k] = hash(seed, k);
    stage_.set_rooms(find_light_rooms(stage_, seed, StopRequest()));
}

void DaylightTransport::make_elements(double count) {
    elements_.reset(new Elements(stage_, count));
    forget_rows();
}

std::size_t DaylightTransport::leaves() const {
    return elements_->numbering.leaves.size();
}

std::optional<std::size_t> DaylightTransport::leaf_at(RegionId region, const Point& x) const {
    const std::uint32_t leaf = elements_->locator.find_leaf(region, x).leaf;
    if (leaf == ElementLocator::no_leaf) return std::nullopt;
    return leaf;
}

SurfacePoint DaylightTransport::leaf_centre(std::size_t leaf) const {
    const ElementTree& tree = elements_->tree;
    const ElementId e = elements_->numbering.leaves[leaf];
    const RegionId region = tree.region(e);
    return {tree.patch(e).at(tree.centre(e)), scene_.regions()[region].plane.n, region};
}

void DaylightTransport::forget_rows() {
    for (std::vector<RayCounts>& rows : rows_) rows = {};
}

/// Returns the groups whose panes a ray crossed before its hit, or before it left the scene.
PaneGroups::Mask DaylightTransport::crossed(const RayHit& hit, const Point& origin, const Vec3& direction) const {
    PaneGroups::Mask out = 0;
    Point from = origin;
    if (hit.mirror >= 0) {
        const Pane& pane = scene_.panes()[static_cast<std::size_t>(hit.mirror)];
        from += (dot(pane.n, pane.corners[0] - origin) / dot(pane.n, direction)) * direction;
        out = groups_.crossed(origin, from, hit.mirror);
    }
    if (hit.surface.is_none())
        return out | groups_.crossed_outwards(from, arriving(scene_, hit, direction), hit.mirror);
    return out | groups_.crossed(from, place_of(scene_, hit, origin, direction), hit.mirror);
}

/// Casts the rays from `ends.rays` to `until` of a sequence. `sides`: the region if rays leave a diffusing pane from
/// both sides, otherwise none. `place`: their origin for two numbers in [0, 1).
template <class Place>
void DaylightTransport::cast(std::uint32_t until, std::uint64_t key, RegionId own, RegionId sides, const Normal& n,
                             const Place& place, Found& found, RayCounts& ends) const {
    if (ends.rays >= until) return;
    const ScrambledSobol points(key);
    found.origins.clear(), found.directions.clear();
    found.leaves.clear(), found.patches.clear(), found.finer.clear();
    for (std::uint32_t k = ends.rays; k < until; ++k) {
        found.origins.push_back(place(points(k, 2), points(k, 3)));
        found.directions.push_back(met_direction(scene_, sides, n, points(k, 0), points(k, 1)));
    }
    found.hits.resize(found.origins.size());
    stage_.tracer.nearest(found.origins, found.directions, own, found.hits, Mirrored::followed);
    const std::size_t sets = groups_.count() > 0 ? groups_.count() + 2 : 0;
    found.through.resize(sets), ends.through.resize(sets);
    for (auto& [leaves, patches] : found.through) leaves.clear(), patches.clear();
    const auto add_crossing = [&](std::size_t k, auto member, std::uint32_t number) {
        const PaneGroups::Mask groups = crossed(found.hits[k], found.origins[k], found.directions[k]);
        for (std::size_t g = 0; g < groups_.count(); ++g)
            if (groups >> g & 1) (found.through[g].*member).push_back(number);
        if (groups != 0) (found.through[any_group()].*member).push_back(number);
        if (std::popcount(groups) > 1) (found.through[two_groups()].*member).push_back(number);
    };
    for (std::size_t k = 0; k < found.hits.size(); ++k) {
        const RayHit& hit = found.hits[k];
        if (hit.surface.is_none()) {
            const Vec3 towards = normalized(arriving(scene_, hit, found.directions[k]));
            found.patches.push_back(static_cast<std::uint32_t>(patches_.of(towards)));
            if (finer_) found.finer.push_back(static_cast<std::uint32_t>(finer_->of(towards)));
            if (sets > 0) add_crossing(k, &Found::Numbers::patches, found.patches.back());
        } else if (hit.front) {
            const std::uint32_t leaf =
                elements_->locator.find_leaf(hit.region, place_of(scene_, hit, found.origins[k], found.directions[k]))
                    .leaf;
            if (leaf == ElementLocator::no_leaf) continue;
            found.leaves.push_back(leaf);
            if (sets > 0) add_crossing(k, &Found::Numbers::leaves, leaf);
        }
    }
    for (std::size_t g = 0; g < sets; ++g)
        add_ends(found.through[g].leaves, ends.through[g].leaves),
            add_ends(found.through[g].patches, ends.through[g].patches);
    add_ends(found.leaves, ends.leaves), add_ends(found.patches, ends.patches), add_ends(found.finer, ends.finer);
    ends.rays = until;
}

void DaylightTransport::cast_rows(double rays_an_element) {
    const ElementTree& tree = elements_->tree;
    const LeafNumbering& numbering = elements_->numbering;
    const std::vector<double> area = leaf_areas(tree, numbering);
    double all = 0;
    for (const double a : area) all += a;
    const double mean = all / static_cast<double>(area.size());
    // A replicate has few rays of its own; more than its share would make small elements expensive.
    const RayBudget budget{.average = rays_an_element / static_cast<double>(daylight_replicates), .min = 2};
    do_own_share([&] {
        for (std::size_t replicate = own_process(); replicate < daylight_replicates; replicate += processes()) {
            std::vector<RayCounts>& rows = rows_[replicate];
            rows.resize(area.size());
            parallel_ranges(area.size(), 16, [&](std::size_t begin, std::size_t end) {
                Found found;
                for (std::size_t i = begin; i < end; ++i) {
                    const ElementId e = numbering.leaves[i];
                    const Patch& patch = tree.patch(e);
                    const std::uint64_t key = hash(seeds_[replicate], static_cast<std::uint64_t>(Stream::rows), i);
                    cast(
                        budget.rays(area[i], mean), key, tree.region(e), tree.region(e),
                        scene_.regions()[tree.region(e)].plane.n,
                        [&](double u, double v) { return patch.at(tree.uniform(e, u, v)); }, found, rows[i]);
                }
            });
        }
    });
}

/// Iterates over the reflected light rho E of one replicate. gather(leaf, light, out) computes the irradiance of a leaf
/// by `light`.
template <class Gather>
std::vector<float> DaylightTransport::iterate(std::size_t columns, const Gather& gather) const {
    const std::size_t n = leaves(), m = columns;
    ElementLight light;
    light.columns = m;
    std::vector<float>& reflected = light.reflected[0];
    std::vector<float> rho(n), fresh(n * m);
    for (std::size_t i = 0; i < n; ++i) {
        const RegionId region = elements_->tree.region(elements_->numbering.leaves[i]);
        rho[i] = static_cast<float>(luminous_sum(scene_.material(region).reflectance));
    }
    reflected.assign(n * m, 0);
    for (std::size_t sweep = 1; sweep <= max_sweeps; ++sweep) {
        parallel_for(n, 16, [&](std::size_t i) {
            const std::span<float> out(&fresh[i * m], m);
            std::fill(out.begin(), out.end(), 0.0f);
            if (rho[i] == 0) return;
            gather(i, std::as_const(light), out);
            for (float& v : out) v *= rho[i];
        });
        struct Norms {
            double change = 0, size = 0;
            Norms& operator+=(const Norms& o) { return change += o.change, size += o.size, *this; }
        };
        const Norms norms = parallel_sum<Norms>(n * m, [&](std::size_t k) {
            const double change = double(fresh[k]) - double(reflected[k]);
            return Norms{change * change, double(fresh[k]) * double(fresh[k])};
        });
        reflected.swap(fresh);
        if (norms.change <= max_change * max_change * norms.size) break;
    }
    return std::move(reflected);
}

ElementLight DaylightTransport::solve(const SkyColumns& columns) const {
    ElementLight out;
    out.columns = columns.count();
    do_own_share([&] {
        for (std::size_t k = own_process(); k < daylight_replicates; k += processes())
            out.reflected[k] = iterate(out.columns, [&](std::size_t i, const ElementLight& light, std::span<float> to) {
                const RayCounts& row = rows_[k][i];
                light.gather(0, row, to), columns.add_light(row, to);
            });
    });
    exchange_replicates(leaves() * out.columns, out);
    return out;
}

/// Iterates over the reflected light of all replicates in this process. gather(replicate, row, light, out) computes the
/// irradiance of a leaf, whose rays are in `row`.
template <class Gather>
ElementLight DaylightTransport::iterate_all(const SkyColumns& columns, const Gather& gather) const {
    ElementLight out;
    out.columns = columns.count();
    for (std::size_t k = 0; k < daylight_replicates; ++k)
        out.reflected[k] = iterate(out.columns, [&](std::size_t i, const ElementLight& light, std::span<float> to) {
            gather(k, rows_[k][i], light, to);
        });
    return out;
}

ElementLight DaylightTransport::solve_through(const SkyColumns& columns, const ElementLight& total,
                                              std::size_t group) const {
    return iterate_all(columns, [&](std::size_t k, const RayCounts& row, const ElementLight& light, auto to) {
        const RayCounts::Through& through = row.through[group];
        light.gather(0, row, to), light.add(0, through.leaves, row.rays, -1, to);
        total.add(k, through.leaves, row.rays, 1, to), columns.add_light(through, row.rays, to);
    });
}

ElementLight DaylightTransport::solve_twice(const SkyColumns& columns, const ElementLight& total,
                                            const ElementLight& any) const {
    return iterate_all(columns, [&](std::size_t k, const RayCounts& row, const ElementLight& light, auto to) {
        const RayCounts::Through &one = row.through[any_group()], &two = row.through[two_groups()];
        light.gather(0, row, to), light.add(0, one.leaves, row.rays, -1, to);
        any.add(k, one.leaves, row.rays, 1, to), any.add(k, two.leaves, row.rays, -1, to);
        total.add(k, two.leaves, row.rays, 1, to), columns.add_light(two, row.rays, to);
    });
}

void DaylightTransport::cast_sensor(const SurfacePoint& sensor, std::size_t number, unsigned rays,
                                    SensorRays& out) const {
    Found found;
    for (std::size_t k = 0; k < daylight_replicates; ++k)
        cast(
            std::max<unsigned>(1, rays / daylight_replicates),
            hash(seeds_[k], static_cast<std::uint64_t>(Stream::gather), number), sensor.region, RegionId(), sensor.n,
            [&](double, double) { return sensor.x; }, found, out[k]);
}

}  // namespace exitance
