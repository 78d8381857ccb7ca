#include "exitance/methods/light/next_light.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/basis/element_rule.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solve/relaxation.hpp"

namespace exitance {
namespace {

/// Mean of b1 - b over every leaf of the method, by leaf number, W/m^2. `delivered`: b1, without its direct light if
/// `before` lacks the same direct light.
std::vector<Spectrum> mean_change(const Stage& stage, const GlobalLight& light,
                                  std::span<const ElementFunction> delivered, const ElementFunction& before) {
    const std::size_t regions = stage.scene.regions().size();
    const ElementLocator at_delivered(delivered[0].tree, regions), at_before(before.tree, regions);
    std::vector<Spectrum> out(light.numbering.leaves.size());
    shared_ranges(
        out.size(), 64,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const ElementId e = light.numbering.leaves[i];
                const RegionId region = light.tree.region(e);
                for (const auto& [uv, weight] : element_rule(light.tree, e, RuleOrder::finer)) {
                    const Point x = light.tree.patch(e).at(uv);
                    Spectrum change = delivered[0].at(at_delivered.find(region, x));
                    if (delivered.size() > 1) change += delivered[1].at({e, uv});
                    out[i] += weight * (change - before.at(at_before.find(region, x)));
                }
            }
        },
        [&](std::size_t i) -> Spectrum& { return out[i]; }, {"refine"});
    return out;
}

/// Solves for ((I - rho F)^-1 - I) r on the leaves of the method.
std::vector<Spectrum> late_response(const RefinementInput& in, const std::vector<Spectrum>& r) {
    const GlobalLight& light = in.light;
    const Scene& scene = in.stage.scene;
    const ElementLocator locator(light.tree, scene.regions().size());
    const RayRows F(in.stage, {light.tree, light.numbering, locator},
                    {in.rays, in.seed, Dealing::by_element, RowsHeld::by_owner});
    std::vector<Spectrum> out = r;
    solve_radiosity(
        {F, leaf_reflectances(scene, light.tree, light.numbering), r, leaf_areas(light.tree, light.numbering)},
        Relaxation::gmres, out, {.residual = calibrated::refined_residual, .max_iterations = 200});
    for (std::size_t i = 0; i < out.size(); ++i) out[i] -= r[i];
    return out;
}

/// Adds constants on the method's leaves to a function, evaluated at the centres of the function's own leaves.
void add_constants(ElementFunction& f, const GlobalLight& light, const std::vector<Spectrum>& constants,
                   std::size_t regions) {
    const ElementLocator locator(light.tree, regions);
    for (ElementId leaf : f.tree.leaves()) {
        const Point x = f.tree.patch(leaf).at(f.tree.centre(leaf));
        const Spectrum& more = constants[light.numbering.number[locator.find(f.tree.region(leaf), x).element]];
        for (std::size_t i = 0; i < static_cast<std::size_t>(f.tree.patch(leaf).corner_count()); ++i)
            for (std::size_t k = 0; k < bands; ++k) f.values[f.first_value[leaf] + i][k] += static_cast<float>(more[k]);
    }
}

/// Returns `a` - b for two functions on the same leaves, or -b if `a` is null.
ElementFunction less(const ElementFunction* a, ElementFunction b) {
    if (a) EXI_CHECK(a->values.size() == b.values.size());
    for (std::size_t i = 0; i < b.values.size(); ++i)
        for (std::size_t k = 0; k < bands; ++k) b.values[i][k] = (a ? a->values[i][k] : 0) - b.values[i][k];
    return b;
}

}  // namespace

NextLight next_light(const RefinementInput& in, NextLight before) {
    EXI_CHECK(in.light.on_projection);
    const Scene& scene = in.stage.scene;
    NextLight out{delivered_functions(scene, in.indirect, in.direct, Spectrum(1.0) - in.c, in.c)};
    // The method's light includes direct light; later steps have the same direct light in a separate part.
    const bool is_first = before.parts.size() == 1;
    const std::vector<Spectrum> r =
        mean_change(in.stage, in.light, std::span(out.parts).first(is_first ? 2 : 1), before.parts[0]);
    add_constants(out.parts[0], in.light, late_response(in, r), scene.regions().size());
    out.rest.push_back(less(is_first ? &out.parts[1] : nullptr, std::move(before.parts[0])));
    return out;
}

ReadNextLight::ReadNextLight(const NextLight& next, std::size_t region_count) {
    for (const ElementFunction& f : next.parts) parts_.emplace_back(f, region_count);
    for (const ElementFunction& f : next.rest) rest_.emplace_back(f, region_count);
    for (const QuickFunction& f : parts_) whole_.add(f);
    for (const QuickFunction& f : rest_) change_.add(parts_[0]), change_.add(f);
}

bool ReadNextLight::stands_alone() const {
    const auto alone = [](const QuickFunction& f) { return f.stands_alone(); };
    return std::all_of(parts_.begin(), parts_.end(), alone) && std::all_of(rest_.begin(), rest_.end(), alone);
}

void ReadNextLight::Sum::read(std::span<const RayEnd> hits, std::span<Spectrum> values) const {
    constexpr std::size_t batch_size = 64;
    std::array<Spectrum, batch_size> more;
    parts_[0]->read(hits, values);
    for (std::size_t p = 1; p < parts_.size(); ++p)
        for (std::size_t first = 0; first < hits.size(); first += batch_size) {
            const std::size_t count = std::min(batch_size, hits.size() - first);
            parts_[p]->read(hits.subspan(first, count), std::span(more).first(count));
            for (std::size_t i = 0; i < count; ++i) values[first + i] += more[i];
        }
}

}  // namespace exitance
