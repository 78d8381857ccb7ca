#include "exitance/transport/narrow_places.hpp"

#include <array>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/met_directions.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t samples = 4;  ///< Points per leaf.

/// True if a front lies before the leaf at one of some sample points, nearer than `widths` times the leaf's width but
/// farther than `touching`, metres.
bool is_narrow(const Stage& stage, const ElementTree& tree, ElementId e, double touching, double widths) {
    const RegionId region = tree.region(e);
    const Normal& n = stage.scene.regions()[region].plane.n;
    const ScrambledSobol places(hash(static_cast<std::uint64_t>(Stream::mesh), e.value));
    std::array<Point, samples> x;
    std::array<Vec3, samples> up;
    std::array<RayHit, samples> hits;
    for (std::uint32_t k = 0; k < samples; ++k) {
        x[k] = tree.patch(e).at(tree.uniform(e, places(k, 0), places(k, 1)));
        up[k] = n;
    }
    stage.tracer.nearest(x, up, region, hits);
    const double near = widths * std::sqrt(tree.area(e));
    return std::any_of(hits.begin(), hits.end(),
                       [&](const RayHit& hit) { return hit.front && hit.distance > touching && hit.distance < near; });
}

}  // namespace

bool is_narrow_leaf(const Stage& stage, const ElementTree& tree, ElementId e) {
    return is_narrow(stage, tree, e, coplanar_share * stage.scene.size(), 1);
}

Field<ElementId, std::uint8_t> find_narrow_leaves(const Stage& stage, const ElementTree& tree) {
    Field<ElementId, std::uint8_t> out(tree.size());
    const std::vector<ElementId> leaves = tree.leaves();
    shared_ranges(
        leaves.size(), 256,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (!stage.is_unlit(tree.region(leaves[i])))
                    out[leaves[i]] = is_narrow_leaf(stage, tree, leaves[i]) ? 1 : 0;
        },
        [&](std::size_t i) -> std::uint8_t& { return out[leaves[i]]; }, {"narrow places"});
    return out;
}

namespace {

/// Squared contrast that a wave of length `h` keeps between planes at the distance `d`.
double kept_squared(double d, double h) {
    constexpr double faded = 1;  // times h; derived from x K1(x) at this distance, 0.006
    if (d > faded * h) return 0;
    const double x = 2 * pi * d / h;
    if (!(x > 0)) return 1;
    const double kept = x * std::cyl_bessel_k(1, x);
    return kept * kept;
}

double unsmoothed_share(const Stage& stage, const ElementTree& tree, ElementId e) {
    constexpr std::uint32_t rays = 8;
    const RegionId region = tree.region(e);
    const Normal& n = stage.scene.regions()[region].plane.n;
    const ScrambledSobol random(hash(static_cast<std::uint64_t>(Stream::mesh), e.value));
    std::array<Point, rays> x;
    std::array<Vec3, rays> direction;
    std::array<RayHit, rays> hits;
    for (std::uint32_t k = 0; k < rays; ++k) {
        x[k] = tree.patch(e).at(tree.uniform(e, random(k, 0), random(k, 1)));
        direction[k] = met_direction(stage.scene, region, n, random(k, 2), random(k, 3));
    }
    stage.tracer.nearest(x, direction, region, hits);
    const double width = std::sqrt(tree.area(e));
    double sum = 0;
    for (const RayHit& hit : hits)
        if (!hit.surface.is_none() && hit.front) sum += kept_squared(hit.distance, width);
    return sum / rays;
}

}  // namespace

std::vector<float> unsmoothed_shares(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves,
                                     const StopRequest& stop, PhasePart part) {
    std::vector<float> out(leaves.size());
    constexpr std::size_t grain = 256;
    LoopProgress progress(std::move(part), own_count(leaves.size(), grain));
    shared_ranges(
        leaves.size(), grain,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end && !stop.requested(); ++i) {
                out[i] = static_cast<float>(unsmoothed_share(stage, tree, leaves[i]));
                progress.add_one();
            }
        },
        [&](std::size_t i) -> float& { return out[i]; }, {"narrow places"});
    return out;
}

double share_of_light_in_gaps(const Stage& stage, const DirectProjection& direct) {
    constexpr std::size_t min_samples = 4096;
    // gap height as a share of the element's size; with 1, elements as large as a wall would make a whole room a gap
    constexpr double half = 0.5;
    const double touching = coplanar_share * stage.scene.size();
    const std::vector<ElementId> leaves = direct.tree.leaves();
    const std::size_t step = leaves.size() / min_samples + 1;
    std::vector<std::uint8_t> narrow((leaves.size() + step - 1) / step);
    shared_ranges(
        narrow.size(), 256,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                narrow[i] = is_narrow(stage, direct.tree, leaves[i * step], touching, half) ? 1 : 0;
        },
        [&](std::size_t i) -> std::uint8_t& { return narrow[i]; }, {"narrow places"});
    double in_gaps = 0, all = 0;
    for (std::size_t i = 0; i < narrow.size(); ++i) {
        const ElementId e = leaves[i * step];
        const Spectrum& rho = stage.scene.material(direct.tree.region(e)).reflectance;
        const double light = stage.counted_area(direct.tree, e) * mean(rho * direct.fit[e].mean);
        all += light, in_gaps += narrow[i] ? light : 0;
    }
    return all > 0 ? in_gaps / all : 0;
}

}  // namespace exitance
