#include "exitance/transport/ray_rows.hpp"

#include <bit>

#include "exitance/core/parallel.hpp"
#include "exitance/core/trace.hpp"
#include "exitance/transport/hemisphere.hpp"

namespace exitance {

unsigned RayBudget::rays(double area, double mean_area) const {
    const double wanted = average * std::sqrt(area / mean_area);
    const double clamped = std::clamp(wanted, static_cast<double>(least), static_cast<double>(most));
    return std::bit_floor(static_cast<unsigned>(clamped * std::numbers::sqrt2));  // to the nearer power of two
}

RayRows::RayRows(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                 const ElementLocator& locator, RayBudget budget, std::uint64_t seed) {
    const std::size_t n = numbering.leaves.size();
    const double mean_area = stage.area / static_cast<double>(n);
    first_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i)
        first_[i + 1] = first_[i] + budget.rays(tree.area(numbering.leaves[i]), mean_area);
    hits_.assign(first_[n], missed);

    parallel_ranges(n, 16,
                    [&](std::size_t begin, std::size_t end) {
                        std::vector<Point> origins;
                        std::vector<Vec3> directions;
                        std::vector<RayHit> found;
                        std::vector<LeafFinder::Query> queries;
                        std::vector<std::size_t> of_ray;
                        for (std::size_t i = begin; i < end; ++i) {
                            const ElementId e = numbering.leaves[i];
                            const Patch& patch = tree.patch(e);
                            const Frame frame(stage.scene.regions()[tree.region(e)].plane.n);
                            const std::size_t count = first_[i + 1] - first_[i];
                            const ScrambledSobol points(hash(seed, static_cast<std::uint64_t>(Stream::rows), i));
                            origins.resize(count), directions.resize(count), found.resize(count);
                            for (std::uint32_t k = 0; k < count; ++k) {
                                origins[k] = patch.at(tree.uniform(e, points(k, 2), points(k, 3)));
                                directions[k] = cosine_direction(frame, points(k, 0), points(k, 1));
                            }
                            stage.tracer.nearest(origins, directions, tree.region(e), found);
                            queries.clear(), of_ray.clear();
                            for (std::size_t k = 0; k < count; ++k) {
                                if (found[k].surface.is_none() || !found[k].front) continue;
                                const RegionId hit = stage.scene.surfaces()[found[k].surface].region;
                                queries.push_back(locator.root_of(hit, origins[k] + found[k].distance * directions[k]));
                                of_ray.push_back(first_[i] + k);
                            }
                            locator.leaves().find(queries);
                            for (std::size_t k = 0; k < queries.size(); ++k) hits_[of_ray[k]] = queries[k].leaf;
                            note_touched("rays", count);
                        }
                    },
                    {"cast rows", [&](std::size_t i) { return tree.region(numbering.leaves[i]).value; }});
}

Spectrum RayRows::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    Spectrum sum;
    for (std::size_t k = first_[receiver]; k < first_[receiver + 1]; ++k)
        if (hits_[k] != missed) sum += radiosity[hits_[k]];
    return sum / static_cast<double>(first_[receiver + 1] - first_[receiver]);
}

void RayRows::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    parallel_for(size(), 64, [&](std::size_t i) { irradiance[i] = gather_at(i, radiosity); });
}

}  // namespace exitance
