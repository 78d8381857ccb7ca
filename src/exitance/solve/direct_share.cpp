#include "exitance/solve/direct_share.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/met_directions.hpp"

namespace exitance {
namespace {

/// Central second moments, one value per band.
struct Moments {
    Spectrum b, M, both;

    Moments& operator+=(const Moments& o) {
        b += o.b, M += o.M, both += o.both;
        return *this;
    }
};

/// True if rays find the emitters: a large share of the surface emits, and there are no lights without extent or skies.
/// Those are in E_dir but are not hit by rays, so that H M would not be E_dir.
bool emitters_are_large(const Scene& scene) {
    if (scene.has_light_apart()) return false;
    constexpr double min_share = 0.05;
    double all = 0, emitting = 0;
    for (const Region& region : scene.regions()) {
        all += region.area;
        if (scene.materials()[region.material].emits()) emitting += region.area;
    }
    return emitting >= min_share * all;
}

/// Moments of the light that rays from the centre of a leaf meet.
Moments moments_at(const Stage& stage, const GlobalLight& light, const ElementLocator& locator, ElementId e,
                   std::uint64_t key) {
    constexpr std::uint32_t rays = 64;
    const RegionId own = light.tree.region(e);
    const Normal& n = stage.scene.regions()[own].plane.n;
    const ScrambledSobol points(key);
    const std::vector<Point> origin = {light.tree.patch(e).at(light.tree.centre(e))};
    std::vector<Vec3> directions(rays);
    std::vector<RayHit> hits(rays);
    for (std::uint32_t k = 0; k < rays; ++k)
        directions[k] = met_direction(stage.scene, own, n, points(k, 0), points(k, 1));
    stage.tracer.nearest(origin, directions, own, hits);
    Spectrum sum_b, sum_M;
    Moments out;
    for (std::uint32_t k = 0; k < rays; ++k) {
        if (hits[k].surface.is_none() || !hits[k].front) continue;
        const RegionId region = hits[k].region;
        const ElementId hit = locator.find(region, origin[0] + hits[k].distance * directions[k]).element;
        const Spectrum& b = light.reflected[light.numbering.number[hit]];
        const Spectrum& M = stage.scene.material(region).exitance;
        sum_b += b, sum_M += M;
        out += {b * b, M * M, b * M};
    }
    out.b -= sum_b * sum_b / rays, out.M -= sum_M * sum_M / rays, out.both -= sum_b * sum_M / rays;
    return out;
}

}  // namespace

Spectrum find_direct_share(const Stage& stage, const GlobalLight& light, const ElementLocator& locator,
                           std::uint64_t seed) {
    // Emitters must be diffuse, so that a gather of M gives their light.
    if (!emitters_are_large(stage.scene) || stage.scene.has_directed_emission()) return {};
    // One leaf in each of many strata of equal area.
    constexpr std::size_t count = 128;
    std::vector<ElementId> chosen;
    double before = 0;
    for (const ElementId e : light.numbering.leaves) {
        before += light.tree.area(e);
        while (static_cast<double>(chosen.size()) + 0.5 <= count * before / stage.area && chosen.size() < count)
            chosen.push_back(e);
    }
    const Moments sum = parallel_sum<Moments>(chosen.size(), [&](std::size_t k) {
        const std::uint64_t key = hash(seed, static_cast<std::uint64_t>(Stream::rows), k, chosen[k].value);
        return moments_at(stage, light, locator, chosen[k], key);
    });
    constexpr double min_share = 0.75;
    Spectrum c;
    for (std::size_t k = 0; k < bands; ++k)
        if (sum.both[k] < 0 && sum.both[k] * sum.both[k] >= min_share * sum.b[k] * sum.M[k])
            c[k] = -sum.both[k] / sum.M[k];
    return c;
}

}  // namespace exitance
