#include "exitance/gather/lost_light.hpp"

#include <algorithm>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t search_rays = 1 << 14, leaving_rays = 1 << 15, back_rays = 1 << 15;
constexpr std::size_t batch = 64;

/// Rays with the surfaces that they hit first.
struct Rays {
    std::vector<RayEnd> origins;
    std::vector<Vec3> directions;
    std::vector<RayHit> hits;
    std::vector<std::size_t> sender;  ///< Leaf number or index of the region from which each ray starts.

    void trace(const Stage& stage) {
        hits.resize(origins.size());
        parallel_ranges(origins.size(), batch, [&](std::size_t first, std::size_t last) {
            const std::size_t n = last - first;
            stage.tracer.nearest(std::span(origins).subspan(first, n), std::span(directions).subspan(first, n),
                                 std::span(hits).subspan(first, n), Mirrored::followed);
        });
    }
};

/// Rays that leave elements as their diffuse light does, in proportion to `power`.
Rays leaving(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering, std::span<const double> power,
             std::uint32_t count, std::uint64_t key) {
    const double total = std::accumulate(power.begin(), power.end(), 0.0);
    const ScrambledSobol points(key);
    RandomStream random(key, Stream::shooting);
    double place = random.uniform();  // sent power before the next ray, in units of the power per ray
    Rays out;
    double before = 0;
    for (std::size_t i = 0; i < power.size(); ++i) {
        before += power[i];
        const ElementId e = numbering.leaves[i];
        const Frame frame(stage.scene.regions()[tree.region(e)].plane.n);
        while (out.origins.size() < count) {
            const auto k = static_cast<std::uint32_t>(out.origins.size());
            if (place * total > before * count) break;
            place = k + 1 + random.uniform();
            out.origins.push_back({tree.patch(e).at(tree.uniform(e, points(k, 2), points(k, 3))), tree.region(e)});
            out.directions.push_back(cosine_direction(frame, points(k, 0), points(k, 1)));
            out.sender.push_back(i);
        }
    }
    out.trace(stage);
    return out;
}

}  // namespace

/// Regions whose backs take so much light that it is measured by rays from these backs.
class LostLight::Backs {
  public:
    /// Counts the hits of `rays` on backs.
    Backs(const Scene& scene, const Rays& rays) : hits_(scene.regions().size(), 0u) {
        for (const RayHit& hit : rays.hits)
            if (!hit.surface.is_none() && !hit.front && !hit.is_glass) ++hits_[hit.region];
        for (RegionId region : hits_.ids())
            if (takes(region)) taking_.push_back(region), all_ += hits_[region];
    }

    bool takes(RegionId region) const {
        // The light that other backs take is measured by the leaving rays that hit them.
        constexpr std::uint32_t min_hits = 8;
        return hits_[region] >= min_hits;
    }
    std::span<const RegionId> taking() const { return taking_; }
    std::uint32_t rays_of(RegionId region) const {
        return static_cast<std::uint32_t>(back_rays * static_cast<double>(hits_[region]) / all_) + 1;
    }

  private:
    Field<RegionId, std::uint32_t> hits_;
    std::vector<RegionId> taking_;
    double all_ = 0;
};

LostLight::LostLight(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                     std::span<const double> power, std::uint64_t seed) {
    EXI_CHECK(power.size() == numbering.leaves.size());
    const double total = std::accumulate(power.begin(), power.end(), 0.0);
    if (!(total > 0)) return;
    const std::uint64_t key = hash(seed, static_cast<std::uint64_t>(Stream::shooting));
    const Backs backs(stage.scene, leaving(stage, tree, numbering, power, search_rays, hash(key, 0u)));
    add_rays_from(stage, backs, key);

    const Rays rays = leaving(stage, tree, numbering, power, leaving_rays, hash(key, 1u));
    for (std::size_t k = 0; k < rays.hits.size(); ++k) {
        const RayHit& hit = rays.hits[k];
        const bool arrives = !hit.surface.is_none() && hit.front;
        const bool counted = !hit.surface.is_none() && !hit.is_glass && backs.takes(hit.region);
        if (arrives || counted) continue;
        const std::size_t i = rays.sender[k];
        ends_.push_back(rays.origins[k]);
        areas_.push_back(tree.area(numbering.leaves[i]) * total / (power[i] * static_cast<double>(rays.hits.size())));
    }
}

/// Adds the light that the chosen backs take: rays from these backs find the fronts that send it.
void LostLight::add_rays_from(const Stage& stage, const Backs& backs, std::uint64_t key) {
    std::vector<std::vector<const Patch*>> patches(backs.taking().size());
    Field<RegionId, std::uint32_t> index(stage.scene.regions().size(), 0u);
    for (std::size_t r = 0; r < backs.taking().size(); ++r) index[backs.taking()[r]] = static_cast<std::uint32_t>(r);
    for (const Piece& piece : stage.pieces)
        if (backs.takes(piece.region)) patches[index[piece.region]].push_back(&piece.patch);

    // Rays that start on a region leave by its front. These start in free space, behind the region by this share of the
    // scene's size. Derived from the height by which the tracer lifts rays off faces: twice that.
    constexpr double behind = 0x1p-19;
    Rays rays;
    for (std::size_t r = 0; r < patches.size(); ++r) {
        const RegionId region = backs.taking()[r];
        const Normal& n = stage.scene.regions()[region].plane.n;
        const Frame frame(-n);
        const ScrambledSobol points(hash(key, 2u + region.value));
        double area = 0;
        for (const Patch* patch : patches[r]) area += patch->area();
        const std::uint32_t count = backs.rays_of(region);
        double before = 0;
        std::uint32_t k = 0;
        for (const Patch* patch : patches[r]) {
            before += patch->area();
            for (; k < count && (k + 0.5) * area <= before * count; ++k) {
                const Point x = patch->at(uniform_in_shape(patch->shape, points(k, 2), points(k, 3)));
                rays.origins.push_back({x - behind * stage.scene.size() * n, RegionId()});
                rays.directions.push_back(cosine_direction(frame, points(k, 0), points(k, 1)));
                rays.sender.push_back(r);
            }
        }
    }
    rays.trace(stage);
    for (std::size_t k = 0; k < rays.hits.size(); ++k) {
        const RayHit& hit = rays.hits[k];
        if (hit.surface.is_none() || !hit.front) continue;
        const RegionId region = backs.taking()[rays.sender[k]];
        ends_.push_back({place_of(stage.scene, hit, rays.origins[k].x, rays.directions[k]), hit.region});
        areas_.push_back(stage.scene.regions()[region].area / backs.rays_of(region));
    }
}

}  // namespace exitance
