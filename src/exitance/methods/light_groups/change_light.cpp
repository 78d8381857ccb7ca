#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "exitance/calibration/numbers.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/methods/light_groups/light_groups.hpp"
#include "exitance/reconstruct/radiosity_function.hpp"
#include "exitance/scene/material_name.hpp"

namespace exitance {
namespace {

/// After how many steps repainting ends in any case.
constexpr int most_steps = 100;

Error unknown(const std::string& what, const std::string& name, std::vector<std::string> known) {
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    return {ErrorCode::usage, fmt::format("there is no {} '{}'", what, name), name,
            fmt::format("there are {}", fmt::join(known, ", "))};
}

Result<void> check(const Scene& scene, const LightGroups& groups, const LightChange& change) {
    std::vector<std::string> names, materials;
    for (const LightGroup& g : groups.groups) names.push_back(g.emitters.name);
    for (const Material& m : scene.materials()) {
        materials.push_back(m.name);
        if (name_in_file(m.name) != m.name) materials.emplace_back(name_in_file(m.name));
    }
    for (const auto& [name, factor] : change.dim) {
        if (std::find(names.begin(), names.end(), name) == names.end()) return unknown("light group", name, names);
        if (!(factor >= 0) || !std::isfinite(factor))
            return Error{ErrorCode::usage, fmt::format("{} is no factor of light", factor), name, "0 turns it off"};
    }
    for (const auto& [name, rho] : change.reflectance) {
        if (std::find(materials.begin(), materials.end(), name) == materials.end())
            return unknown("material", name, materials);
        for (const double r : rho.value)
            if (!(r >= 0 && r < 1))
                return Error{ErrorCode::usage, fmt::format("{} is no reflectance", r), name, "from 0 to below 1"};
    }
    return {};
}

/// Light on the leaves, as rays carry it from one to the other.
class LeafLight {
  public:
    LeafLight(const Solution& solution, const LightGroups& groups) : groups_(groups) {
        const ElementTree& tree = solution.indirect.tree;
        for (const ElementId e : tree.leaves()) material_.push_back(solution.scene.regions()[tree.region(e)].material);
    }

    /// E of every leaf but for direct light, W/m^2, from `indirect` on; direct light is the groups' by their factors.
    std::vector<Spectrum> settle(const std::vector<Spectrum>& direct, const std::vector<Spectrum>& reflectance,
                                 std::vector<Spectrum> indirect) const {
        const std::size_t n = material_.size();
        std::vector<Spectrum> reflected(n);
        for (int step = 0; step < most_steps; ++step) {
            parallel_for(n, 4096, [&](std::size_t i) {
                reflected[i] = reflectance[material_[i].value] * (direct[i] + indirect[i]);
            });
            std::vector<Spectrum> next(n);
            parallel_for(n, 256, [&](std::size_t i) {
                Spectrum sum;
                const std::uint32_t* met = &groups_.met[i * groups_.rays];
                for (std::uint32_t r = 0; r < groups_.rays; ++r)
                    if (met[r] != LightGroups::nothing) sum += reflected[met[r]];
                next[i] = sum * (1.0 / groups_.rays);
            });
            double moved = 0, all = 0;
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t band = 0; band < bands; ++band)
                    moved += std::abs(next[i][band] - indirect[i][band]), all += next[i][band];
            indirect = std::move(next);
            if (moved <= calibrated::changed_light_settled * all) break;
        }
        return indirect;
    }

  private:
    const LightGroups& groups_;
    std::vector<MaterialId> material_;
};

Spectrum spectrum_of(const std::array<float, bands>& v) {
    Spectrum out;
    for (std::size_t band = 0; band < bands; ++band) out[band] = static_cast<double>(v[band]);
    return out;
}

/// The groups' sum, dimmed.
void add_up(const std::vector<LightGroup>& groups, CornerValues LightGroup::*values, CornerValues& out) {
    parallel_for(out.size(), 4096, [&](std::size_t i) {
        Spectrum sum;
        for (const LightGroup& g : groups)
            if (g.factor > 0) sum += g.factor * spectrum_of((g.*values)[i]);
        for (std::size_t band = 0; band < bands; ++band) out[i][band] = static_cast<float>(sum[band]);
    });
}

/// Corners of leaves that lie at one place of one region are one node.
void number_nodes(const ElementFunction& f, double scene_size, LightGroups& groups) {
    const double grid = 1e-6 * scene_size;  // Given by single precision, in which other programs hold corners.
    std::map<std::array<std::int64_t, 4>, std::uint32_t> nodes;
    for (const ElementId e : f.tree.leaves()) {
        const Patch& patch = f.tree.patch(e);
        for (int i = 0; i < patch.corner_count(); ++i) {
            const Point p = patch.corner(i);
            const std::array<std::int64_t, 4> place{f.tree.region(e).value, std::llround(p.x / grid),
                                                    std::llround(p.y / grid), std::llround(p.z / grid)};
            groups.node.push_back(nodes.emplace(place, static_cast<std::uint32_t>(nodes.size())).first->second);
        }
    }
    groups.node_count = nodes.size();
}

/// By corner: the mean of the leaves' values at its node.
std::vector<Spectrum> averaged_at_corners(const ElementFunction& f, const std::vector<Spectrum>& of_leaf,
                                          const LightGroups& groups) {
    std::vector<Spectrum> sum(groups.node_count);
    std::vector<double> weight(groups.node_count, 0);
    std::size_t leaf = 0, corner = 0;
    for (const ElementId e : f.tree.leaves()) {
        for (int i = 0; i < f.tree.patch(e).corner_count(); ++i, ++corner)
            sum[groups.node[corner]] += of_leaf[leaf], weight[groups.node[corner]] += 1;
        ++leaf;
    }
    std::vector<Spectrum> out(groups.node.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = sum[groups.node[i]] * (1 / weight[groups.node[i]]);
    return out;
}

/// How light on the leaves follows the new reflectances: v becomes growth v + added. Where there was none nothing can
/// grow.
struct Repainted {
    std::vector<Spectrum> growth, added;
};
Repainted repainted_leaves(const Solution& solution, const LightGroups& groups,
                           const std::vector<Spectrum>& reflectance) {
    const LeafLight light(solution, groups);
    const std::size_t n = groups.rays > 0 ? groups.met.size() / groups.rays : 0;
    std::vector<Spectrum> direct(n), held(n);
    for (const LightGroup& g : groups.groups)
        for (std::size_t i = 0; i < n; ++i) direct[i] += g.factor * spectrum_of(g.direct[i]);
    for (std::size_t i = 0; i < n; ++i) held[i] = solution.direct_share * direct[i];
    const std::vector<Spectrum> before = light.settle(direct, groups.reflectance, std::vector<Spectrum>(n));
    const std::vector<Spectrum> after = light.settle(direct, reflectance, before);
    Repainted out{std::vector<Spectrum>(n, Spectrum(1)), std::vector<Spectrum>(n)};
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t band = 0; band < bands; ++band) {
            const double was = before[i][band] + held[i][band];
            if (was > 0)
                out.growth[i][band] = (after[i][band] + held[i][band]) / was;
            else
                out.added[i][band] = after[i][band];
        }
    return out;
}

/// What the elements of `indirect` hold is multiplied; what is exported changes by as much light as that.
void repaint(Solution& solution, LightGroups& groups, const std::vector<Spectrum>& reflectance) {
    if (groups.node.empty()) number_nodes(solution.indirect, solution.scene.size(), groups);
    const Repainted fresh = repainted_leaves(solution, groups, reflectance);
    const std::vector<Spectrum> growth = averaged_at_corners(solution.indirect, fresh.growth, groups);
    const std::vector<Spectrum> added = averaged_at_corners(solution.indirect, fresh.added, groups);
    ElementFunction change{solution.indirect.tree, solution.indirect.first_value, solution.indirect.values};
    parallel_for(growth.size(), 4096, [&](std::size_t i) {
        for (std::size_t band = 0; band < bands; ++band) {
            const float old = solution.indirect.values[i][band];
            const float fresh = static_cast<float>(static_cast<double>(old) * growth[i][band] + added[i][band]);
            solution.indirect.values[i][band] = fresh, change.values[i][band] = fresh - old;
        }
    });
    const ElementLocator locator(change.tree, solution.scene.regions().size());
    const ElementTree& tree = solution.interpolant.tree;
    const std::vector<ElementId> leaves = tree.leaves();
    parallel_for(leaves.size(), 256, [&](std::size_t k) {
        const ElementId e = leaves[k];
        const Patch& patch = tree.patch(e);
        for (int i = 0; i < patch.corner_count(); ++i) {
            const Spectrum more = change.at(locator.find(tree.region(e), patch.corner(i)));
            auto& value =
                solution.interpolant.values[solution.interpolant.first_value[e] + static_cast<std::uint32_t>(i)];
            for (std::size_t band = 0; band < bands; ++band)
                value[band] = std::max(0.0F, value[band] + static_cast<float>(more[band]));
        }
    });
}

/// Emission of the scene, by the factors; `reflectance` a material.
void relight(Scene& scene, const LightGroups& groups, const std::vector<Spectrum>& reflectance) {
    std::vector<double> factor(scene.materials().size(), 1);
    std::vector<PunctualLight> lights = scene.lights();
    DistantLight distant = scene.distant();
    double of_distant = 1;
    for (const LightGroup& g : groups.groups) {
        for (const MaterialId m : g.emitters.materials) factor[m.value] = g.factor;
        for (const std::uint32_t i : g.emitters.lights) lights[i].intensity = g.factor * groups.intensity[i];
        if (g.emitters.is_distant) of_distant = g.factor;
    }
    for (const MaterialId m : scene.materials().ids()) {
        const Spectrum exitance = factor[m.value] * groups.exitance[m.value];
        const Material& now = scene.materials()[m];
        if (now.exitance.value != exitance.value || now.reflectance.value != reflectance[m.value].value)
            scene.relight(m, reflectance[m.value], exitance);
    }
    scene.put_lights(std::move(lights));
    std::size_t part = 0;
    for (auto& dome : distant.domes) dome.irradiance = of_distant * groups.distant[part++];
    for (auto& disc : distant.discs) disc.irradiance = of_distant * groups.distant[part++];
    scene.put_under(std::move(distant));
}

std::optional<double> error_of(const LightGroups& groups) {
    double off = 0, light = 0;
    for (const LightGroup& g : groups.groups) {
        if (g.factor > 0 && !g.error) return std::nullopt;
        off += g.factor * g.reflected * g.error.value_or(0), light += g.factor * g.reflected;
    }
    return light > 0 ? std::optional(off / light) : std::nullopt;
}

}  // namespace

Result<void> change_light(Solution& solution, LightGroups& groups, const LightChange& change) {
    if (const Result<void> sound = check(solution.scene, groups, change); !sound) return sound;
    for (const auto& [name, factor] : change.dim)
        for (LightGroup& g : groups.groups)
            if (g.emitters.name == name) g.factor = factor;
    std::vector<Spectrum> reflectance;
    bool repainted = false;
    for (const Material& m : solution.scene.materials()) reflectance.push_back(m.reflectance);
    for (const auto& [name, rho] : change.reflectance)
        for (const MaterialId m : solution.scene.materials().ids())
            if (solution.scene.materials()[m].name == name || name_in_file(solution.scene.materials()[m].name) == name)
                reflectance[m.value] = rho;
    for (std::size_t m = 0; m < reflectance.size(); ++m)
        repainted |= reflectance[m].value != groups.reflectance[m].value;
    add_up(groups.groups, &LightGroup::indirect, solution.indirect.values);
    add_up(groups.groups, &LightGroup::interpolant, solution.interpolant.values);
    if (repainted) repaint(solution, groups, reflectance);
    relight(solution.scene, groups, reflectance);
    const bool dimmed =
        std::any_of(groups.groups.begin(), groups.groups.end(), [](const LightGroup& g) { return g.factor != 1; });
    SolveStatistics& s = solution.statistics;
    if (repainted || dimmed) {
        s.relative_error_estimate = repainted ? std::nullopt : error_of(groups);
        s.relative_error_bound.reset(), s.error_p99.reset(), s.relative_error_estimate_interpolant.reset();
        s.relative_error_estimate_worst_room.reset(), s.rooms.clear();
    }
    solution.links = {}, solution.discontinuity = {}, solution.cells = {};
    return {};
}

}  // namespace exitance
