#include "exitance/methods/shooting_setup.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/solve/shot_progress.hpp"

namespace exitance {

std::size_t column_memory_bytes(const SolveOptions& options) {
    constexpr std::size_t max_bytes = std::size_t{1} << 30;
    return options.memory_limit_bytes ? std::min(max_bytes, *options.memory_limit_bytes / 4) : max_bytes;
}

ShootingSetup::ShootingSetup(const MethodInput& input, const DirectProjection& first)
    : tree(first.tree),
      patches(tree.leaves()),
      patch_area(patches.size()),
      unshot(patches.size()),
      sent(patches.size()),
      numbering(tree),
      patch_of(patches.size()),
      reflectance(leaf_reflectances(input.stage.scene, tree, numbering)),
      irradiance(patches.size()),
      area(leaf_areas(tree, numbering)),
      input_(input),
      transfer_(input.stage, tree,
                static_cast<unsigned>(input.options.visibility_samples.value_or(default_visibility_samples)),
                input.options.seed),
      passed_(input.stage.scene, tree, numbering.leaves),
      columns_(patches.size()) {
    direct.resize(patches.size());
    if (!shoots_direct_light()) direct = leaf_means(first, numbering);
    for (std::size_t p = 0; p < patches.size(); ++p) {
        patch_of[p] = static_cast<std::uint32_t>(p);
        patch_area[p] = area[p];
        unshot[p] = shoots_direct_light() ? input.stage.scene.material(tree.region(patches[p])).exitance
                                          : reflectance[p] * direct[p];
        sent[p] = unshot[p];
    }
    first_power_ = unshot_power(unshot, patch_area);
}

std::span<const float> ShootingSetup::column(std::size_t patch) {
    std::vector<float>& kept = columns_[patch];
    if (kept.size() == numbering.leaves.size()) return kept;
    const std::size_t bytes = 4 * numbering.leaves.size();
    std::vector<float>& out = kept_bytes_ + bytes <= column_memory_bytes(input_.options) ? kept : fresh_;
    if (&out == &kept) kept_bytes_ += bytes;
    out.resize(numbering.leaves.size());
    transfer_.column(numbering.leaves, patches[patch], out);
    passed_.meet(std::span(out));
    return out;
}

SolveReport ShootingSetup::run() {
    const ShootingProblem problem{patch_of, area, patch_area, reflectance,
                                  [&](std::size_t patch) { return column(patch); }};
    ShotProgress* const watcher = find_shot_progress(input_.progress);
    std::function<void(std::size_t, double)> shot;
    if (watcher) shot = [&](std::size_t patch, double left) { watcher->shot(tree.outline(patches[patch]), left); };
    const ShootingOptions options{.overshooting = input_.options.overshooting,
                                  .unshot = input_.knobs.residual,
                                  .reference = first_power_,
                                  .max_shots = input_.options.max_iterations.value_or(1'000'000),
                                  .request = &input_.stop,
                                  .progress = &input_.progress,
                                  .shot = shot};
    const SolveReport report = shoot(problem, options, unshot, irradiance);
    // The light that a patch has sent is its reflected (and emitted) light minus its unshot light.
    for (std::size_t p = 0; p < patches.size(); ++p) sent[p] = Spectrum();
    for (std::size_t i = 0; i < irradiance.size(); ++i)
        sent[patch_of[i]] += (area[i] / patch_area[patch_of[i]]) * (reflectance[i] * (direct[i] + irradiance[i]));
    for (std::size_t p = 0; p < patches.size(); ++p) {
        if (shoots_direct_light()) sent[p] += input_.stage.scene.material(tree.region(patches[p])).exitance;
        sent[p] -= unshot[p];
    }
    return report;
}

void ShootingSetup::split(const std::vector<ElementId>& leaves) {
    Field<ElementId, std::uint32_t> patch_by_element(tree.size());
    Field<ElementId, Spectrum> old_irradiance(tree.size()), old_direct(tree.size());
    for (std::size_t i = 0; i < numbering.leaves.size(); ++i) {
        patch_by_element[numbering.leaves[i]] = patch_of[i];
        old_irradiance[numbering.leaves[i]] = irradiance[i];
        old_direct[numbering.leaves[i]] = direct[i];
    }
    const std::size_t old_size = tree.size();
    for (ElementId e : leaves) refine_element(tree, e);
    transfer_.update_places();
    numbering = LeafNumbering(tree);
    passed_ = PassedLight(input_.stage.scene, tree, numbering.leaves);
    const std::size_t n = numbering.leaves.size();
    reflectance = leaf_reflectances(input_.stage.scene, tree, numbering);
    area = leaf_areas(tree, numbering);
    patch_of.resize(n);
    irradiance.assign(n, {});
    direct.assign(n, {});
    parallel_ranges(n, 8, [&](std::size_t begin, std::size_t end) {
        PatchTransfer::Workspace workspace;
        PlaceLight::Workspace exact;
        for (std::size_t i = begin; i < end; ++i) {
            const ElementId e = numbering.leaves[i];
            if (e.value < old_size) {
                patch_of[i] = patch_by_element[e];
                irradiance[i] = old_irradiance[e];
                direct[i] = old_direct[e];
                continue;
            }
            const ElementId parent = tree.parent(e);
            patch_of[i] = patch_by_element[parent];
            if (input_.stop.requested()) {  // after a stop within a sweep, the other leaves keep their parents' light
                irradiance[i] = old_irradiance[parent], direct[i] = old_direct[parent];
                continue;
            }
            if (!shoots_direct_light()) direct[i] = mean_direct_light(e, exact);
            irradiance[i] = light_of_patches(i, workspace);
        }
        transfer_.count(workspace);
    });
    for (std::vector<float>& kept : columns_) kept.clear(), kept.shrink_to_fit();
    kept_bytes_ = 0;
}

/// Irradiance of a leaf by the light that all patches have sent.
Spectrum ShootingSetup::light_of_patches(std::size_t leaf, PatchTransfer::Workspace& workspace) const {
    return passed_.met_at(leaf, [&](std::size_t i) {
        Spectrum sum;
        for (std::size_t p = 0; p < patches.size(); ++p)
            if (max(sent[p]) > 0) sum += transfer_.form_factor(numbering.leaves[i], patches[p], workspace) * sent[p];
        return sum;
    });
}

Spectrum ShootingSetup::mean_direct_light(ElementId e, PlaceLight::Workspace& workspace) const {
    const LightAccuracy accuracy{.relative = 0.5 * input_.options.error_target()};
    const RegionId region = tree.region(e);
    const Normal& n = input_.stage.scene.regions()[region].plane.n;
    Spectrum mean;
    for (const WeightedPlace& place : element_rule(tree, e, RuleOrder::nodes))
        mean += place.weight *
                input_.stage.place_light.at(tree.patch(e).at(place.uv), n, region, accuracy, workspace).irradiance;
    return mean;
}

void ShootingSetup::update_patches() {
    std::vector<Spectrum> now(patches.size());
    for (std::size_t i = 0; i < irradiance.size(); ++i)
        now[patch_of[i]] += (area[i] / patch_area[patch_of[i]]) * (reflectance[i] * (direct[i] + irradiance[i]));
    for (std::size_t p = 0; p < patches.size(); ++p) {
        if (shoots_direct_light()) now[p] += input_.stage.scene.material(tree.region(patches[p])).exitance;
        unshot[p] = now[p] - sent[p];
    }
}

GlobalLight ShootingSetup::finish(const SolveReport& report) {
    GlobalLight out{.tree = std::move(tree), .numbering = std::move(numbering)};
    out.reflected.resize(irradiance.size());
    for (std::size_t i = 0; i < irradiance.size(); ++i) out.reflected[i] = reflectance[i] * (direct[i] + irradiance[i]);
    out.direct = std::move(direct);
    out.indirect = std::move(irradiance);
    if (shoots_direct_light()) out.delivery = MethodDelivery::all_light;
    out.report = report;
    out.work.rays = transfer_.rays();
    out.work.form_factors = transfer_.form_factors();
    out.work.link_memory_bytes = kept_bytes_;
    return out;
}

}  // namespace exitance
