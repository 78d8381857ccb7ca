#include "exitance/what_if/light_groups/group_errors.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/error/batch_mean.hpp"
#include "exitance/error/residual_samples.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/solve/relaxation.hpp"

namespace exitance {
namespace {

constexpr std::size_t points = 1280;  ///< Number of points; as many as a certificate starts with.

/// A point, and two estimates of every group's residual there.
struct Residual {
    ElementTree::Place place;
    std::uint32_t source = 0;  ///< Index of the source element that contains the point.
    std::vector<Spectrum> r1, r2;
};

/// Light of all groups at ray hits.
class GroupsLight {
  public:
    GroupsLight(const Solution& solution, const LightGroups& groups, const std::vector<std::vector<DirectFit>>& direct,
                const std::vector<std::vector<Spectrum>>& older)
        : solution_(solution),
          groups_(groups),
          direct_(direct),
          older_(older),
          indirect_(solution.indirect.tree, solution.scene.regions().size()),
          sources_(solution.interpolant.tree, solution.scene.regions().size()),
          group_of_(solution.scene.materials().size(), TransportLayout::none) {
        for (std::uint32_t g = 0; g < groups.groups.size(); ++g)
            for (const MaterialId m : groups.groups[g].emitters.materials) group_of_[m.value] = g;
    }

    std::uint32_t source_at(RegionId region, const Point& y) const {
        const ElementId leaf = sources_.find(region, y).element;
        if (leaf.is_none()) return TransportLayout::none;
        const std::uint32_t number = groups_.layout.number[leaf];
        return number != TransportLayout::none ? number
                                               : groups_.layout.number[solution_.interpolant.tree.parent(leaf)];
    }

    /// Returns the projected direct light of a group at a point of a source, W/m^2.
    Spectrum direct_at(std::size_t g, std::uint32_t source, const Point& y) const {
        const Patch& patch = solution_.interpolant.tree.patch(groups_.layout.sources[source]);
        return Between{0, corner_weights(patch, patch.coordinates(y))}.of(direct_[g][source].corners);
    }

    /// Adds the reflected light of a front, and the share of its exitance that elements contain. `weight`: of the ray
    /// that hit it.
    void add(const RayEnd& hit, double weight, std::vector<Spectrum>& sums) const {
        const std::uint32_t source = source_at(hit.region, hit.x);
        const ElementTree::Place place = indirect_.find(hit.region, hit.x);
        if (source == TransportLayout::none || place.element.is_none()) return;
        const Material& material = solution_.scene.material(hit.region);
        const std::uint32_t own = group_of_[solution_.scene.regions()[hit.region].material.value];
        if (own != TransportLayout::none) sums[own] += weight * solution_.direct_share * material.exitance;
        if (!(max(material.reflectance) > 0)) return;
        const Patch& below = solution_.indirect.tree.patch(place.element);
        const Between at{solution_.indirect.first_value[place.element], corner_weights(below, place.uv)};
        const Spectrum apart = solution_.direct_in_elements ? Spectrum() : Spectrum(1) - solution_.direct_share;
        for (std::size_t g = 0; g < sums.size(); ++g) {
            if (!older_.empty()) {
                sums[g] += weight * older_[g][source];
                continue;
            }
            Spectrum E = at.of(groups_.groups[g].indirect);
            if (!solution_.direct_in_elements) E += apart * direct_at(g, source, hit.x);
            sums[g] += weight * material.reflectance * E;
        }
    }

  private:
    const Solution& solution_;
    const LightGroups& groups_;
    const std::vector<std::vector<DirectFit>>& direct_;
    const std::vector<std::vector<Spectrum>>& older_;
    ElementLocator indirect_, sources_;
    std::vector<std::uint32_t> group_of_;  ///< Per emitting material: its group.
};

/// Returns one point in each of `points` strata of equal area.
std::vector<Residual> stratified(const Stage& stage, const ElementTree& tree, std::uint64_t seed) {
    std::vector<ElementId> leaves;
    double area = 0;
    for (const ElementId e : tree.leaves())
        if (!stage.is_unlit(tree.region(e))) leaves.push_back(e), area += tree.area(e);
    const ScrambledSobol random(hash(seed, static_cast<std::uint64_t>(Stream::certificate), std::uint64_t(0x6c67)));
    std::vector<Residual> out(leaves.empty() ? 0 : points);
    double before = 0;
    std::size_t leaf = 0;
    for (std::uint32_t k = 0; k < out.size(); ++k) {
        const double wanted = area * (k + random(k, 0)) / points;
        while (leaf + 1 < leaves.size() && before + tree.area(leaves[leaf]) <= wanted)
            before += tree.area(leaves[leaf]), ++leaf;
        out[k].place = {leaves[leaf], tree.uniform(leaves[leaf], random(k, 1), random(k, 2))};
    }
    return out;
}

void measure(const Stage& stage, const Solution& solution, const LightGroups& groups, const GroupsLight& light,
             unsigned rays, std::uint64_t seed, std::vector<Residual>& all, const StopRequest& stop) {
    const ElementTree& tree = solution.indirect.tree;
    const std::size_t count = groups.groups.size();
    parallel_ranges(all.size(), 8, [&](std::size_t begin, std::size_t end) {
        GatherWorkspace workspace;
        for (std::size_t k = begin; k < end && !stop.requested(); ++k) {
            Residual& residual = all[k];
            const auto [e, uv] = residual.place;
            const RegionId region = tree.region(e);
            const Point x = tree.patch(e).at(uv);
            const Spectrum& rho = stage.scene.material(region).reflectance;
            const Between at{solution.indirect.first_value[e], corner_weights(tree.patch(e), uv)};
            residual.source = light.source_at(region, x);
            for (std::uint64_t which = 1; which <= 2; ++which) {
                std::vector<Spectrum>& r = which == 1 ? residual.r1 : residual.r2;
                r.assign(count, Spectrum());
                if (residual.source == TransportLayout::none) continue;
                const std::uint64_t key =
                    hash(seed, static_cast<std::uint64_t>(Stream::certificate), std::uint64_t(0x6c67), k, which);
                cast_gather(stage, x, stage.scene.regions()[region].plane.n, region, rays, key, nullptr, workspace);
                for (std::size_t i = 0; i < workspace.fronts.size(); ++i)
                    light.add(workspace.fronts[i], workspace.counts.empty() ? 1 : workspace.counts[i], r);
                for (std::size_t g = 0; g < count; ++g) {
                    Spectrum arrives = r[g] / static_cast<double>(rays);
                    if (solution.direct_in_elements) arrives += light.direct_at(g, residual.source, x);
                    r[g] = rho * (arrives - at.of(groups.groups[g].indirect));
                }
            }
        }
    });
}

/// Light on the sources that results from a group's mean residuals per region after reflection.
std::vector<Spectrum> late_response(const Solution& solution, const LightGroups& groups, const KeptOperator& F,
                                    std::span<const Spectrum> rho, const std::vector<Residual>& all, std::size_t g) {
    std::vector<Spectrum> of_region(solution.scene.regions().size());
    std::vector<double> count(of_region.size());
    for (const Residual& r : all) {
        const RegionId region = solution.indirect.tree.region(r.place.element);
        of_region[region.value] += 0.5 * (r.r1[g] + r.r2[g]), count[region.value] += 1;
    }
    const TransportLayout& layout = groups.layout;
    std::vector<Spectrum> rhs(layout.sources.size());
    for (std::size_t i = 0; i < rhs.size(); ++i) {
        const std::uint32_t region = solution.interpolant.tree.region(layout.sources[i]).value;
        rhs[i] = of_region[region] / (count[region] + 4);  // means of few points are mostly noise
    }
    std::vector<Spectrum> out = rhs;
    solve_radiosity({F, rho, rhs, layout.area}, Relaxation::gmres, out,
                    {.residual = calibrated::refined_residual, .max_iterations = 200});
    for (std::size_t i = 0; i < out.size(); ++i) out[i] -= rhs[i];
    return out;
}

/// Mean square of a group's error, (W/m^2)^2.
BatchMean squared_error(const std::vector<Residual>& all, const std::vector<Spectrum>& late, std::size_t g) {
    std::array<double, batches> squares{};
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Spectrum& smooth = late[all[k].source];
        squares[k % batches] +=
            mean((all[k].r1[g] + smooth) * (all[k].r2[g] + smooth)) * batches / static_cast<double>(all.size());
    }
    return BatchMean(squares);
}

/// Factor by which rays have to be increased so that no group's estimate is noise. The noise of a square falls with the
/// power 3/2 of the number of rays.
double missing_rays(const std::vector<BatchMean>& squares, const std::vector<LightGroup>& groups, double error) {
    // relative standard error of an error, derived from that of its square: a ninth
    constexpr double max_uncertainty = 1.0 / 3;
    double factor = 1;
    for (std::size_t g = 0; g < squares.size(); ++g) {
        const double square = std::max(squares[g].mean, std::pow(error * groups[g].reflected, 2));
        if (square > 0)
            factor = std::max(
                factor, std::pow(squares[g].standard_error / (max_uncertainty * max_uncertainty * square), 2.0 / 3));
    }
    return factor;
}

}  // namespace

void estimate_group_errors(const Stage& stage, const Solution& solution,
                           const std::vector<std::vector<DirectFit>>& direct,
                           const std::vector<std::vector<Spectrum>>& older, double error, std::uint64_t seed,
                           LightGroups& groups, const StopRequest& stop) {
    const GroupsLight light(solution, groups, direct, older);
    const KeptOperator F(groups.transport, groups.layout, solution.interpolant.tree.size());
    std::vector<Spectrum> rho;
    for (const MaterialId m : groups.layout.material) rho.push_back(groups.reflectance[m.value]);
    // Start with the number of rays of a certificate; then use as many as the noisiest group needs, up to a limit.
    unsigned rays = certificate_rays(rays_to_resolve(error, points));
    constexpr double max_increase = 8;
    std::vector<BatchMean> squares;
    for (int look = 0; look < 2; ++look) {
        std::vector<Residual> all = stratified(stage, solution.indirect.tree, seed);
        measure(stage, solution, groups, light, rays, seed, all, stop);
        if (stop.requested() || all.empty()) return;
        std::erase_if(all, [](const Residual& r) { return r.source == TransportLayout::none; });
        squares.clear();
        for (std::size_t g = 0; g < groups.groups.size(); ++g)
            squares.push_back(squared_error(all, late_response(solution, groups, F, rho, all, g), g));
        const double more = std::min(max_increase, missing_rays(squares, groups.groups, error));
        if (more < 2) break;
        rays = certificate_rays(more * rays);
    }
    for (std::size_t g = 0; g < squares.size(); ++g)
        // the reported error is at least its own standard error
        if (groups.groups[g].reflected > 0)
            groups.groups[g].error =
                std::sqrt(std::max(squares[g].mean, squares[g].standard_error)) / groups.groups[g].reflected;
}

}  // namespace exitance
