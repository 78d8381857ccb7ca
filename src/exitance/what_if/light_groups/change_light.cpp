#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/scene/material_name.hpp"
#include "exitance/solve/relaxation.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"
#include "exitance/what_if/light_groups/reflected_light.hpp"

namespace exitance {
namespace {

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
            return Error{ErrorCode::usage, fmt::format("{} is not a dimming factor", factor), name,
                         "a factor is at least 0; 0 turns the light off"};
    }
    for (const auto& [name, rho] : change.reflectance) {
        if (std::find(materials.begin(), materials.end(), name) == materials.end())
            return unknown("material", name, materials);
        for (const double r : rho.value)
            if (!(r >= 0 && r < 1))
                return Error{ErrorCode::usage, fmt::format("{} is not a reflectance", r), name,
                             "a reflectance is at least 0 and below 1"};
    }
    return {};
}

Spectrum spectrum_of(const std::array<float, bands>& v) {
    Spectrum out;
    for (std::size_t band = 0; band < bands; ++band) out[band] = static_cast<double>(v[band]);
    return out;
}

/// Sums the groups' light, each multiplied by its factor.
void add_up(const std::vector<LightGroup>& groups, CornerValues LightGroup::*values, CornerValues& out) {
    parallel_for(out.size(), 4096, [&](std::size_t i) {
        Spectrum sum;
        for (const LightGroup& g : groups)
            if (g.factor > 0) sum += g.factor * spectrum_of((g.*values)[i]);
        for (std::size_t band = 0; band < bands; ++band) out[i][band] = static_cast<float>(sum[band]);
    });
}

/// Change of the sources' reflected radiosity: d of `LightGroups`, W/m^2. `E`: present light; `was` and `is`: old and
/// new reflectances. If the number of bounces is limited, that number is followed with both.
std::vector<Spectrum> change_of_reflected(const KeptOperator& F, const TransportLayout& layout, int bounces,
                                          const Solution& solution, const std::vector<Spectrum>& E,
                                          const std::vector<Spectrum>& was, const std::vector<Spectrum>& is) {
    std::vector<Spectrum> change(E.size());
    if (bounces < 0) {
        // (rho' - rho) E acts as emitted light in b = rho' (D + F b), in place of rho' D.
        for (std::size_t i = 0; i < E.size(); ++i) change[i] = (is[i] - was[i]) * E[i];
        const std::vector<Spectrum> rhs = change;
        solve_radiosity({F, is, rhs, layout.area}, Relaxation::gmres, change,
                        {.residual = calibrated::changed_light_settled, .max_iterations = 200});
        return change;
    }
    std::vector<Spectrum> direct = E;
    const ElementTree& tree = solution.interpolant.tree;
    const ElementLocator locator(solution.indirect.tree, solution.scene.regions().size());
    for (std::size_t i = 0; i < E.size(); ++i) {
        const ElementId e = layout.sources[i];
        direct[i] -= solution.indirect.at(locator.find(tree.region(e), tree.patch(e).at(tree.centre(e))));
    }
    const std::vector<Spectrum> before = reflected_light(F, was, layout.area, direct, bounces);
    const std::vector<Spectrum> after = reflected_light(F, is, layout.area, direct, bounces);
    for (std::size_t i = 0; i < E.size(); ++i) change[i] = after[i] - before[i];
    return change;
}

/// Light that arrives from a change, at the values of `indirect`. If the stored transport yields more or less of the
/// present light than the solution, due to noise of its rays or too large receivers, the result is corrected by the
/// same ratio. `b`: present radiosity of the sources.
std::vector<Spectrum> arriving_change(const KeptOperator& F, const Solution& solution,
                                      const std::vector<Spectrum>& change, const std::vector<Spectrum>& b) {
    constexpr double max_ratio = 2;  // larger ratios are not small corrections
    std::vector<Spectrum> out = F.at_corners(F.at_receivers(change));
    const std::vector<Spectrum> held = F.at_corners(F.at_receivers(b));
    parallel_for(out.size(), 4096, [&](std::size_t i) {
        for (std::size_t band = 0; band < bands; ++band) {
            const double there = static_cast<double>(solution.indirect.values[i][band]);
            if (there > 0 && held[i][band] > 0)
                out[i][band] *= std::clamp(there / held[i][band], 1 / max_ratio, max_ratio);
        }
    });
    return out;
}

/// Adds the light that arrives from a change of reflectances to both functions of a solution, whose lights have been
/// dimmed already. Returns the RMS of the change of reflected light relative to the mean reflected light, with the new
/// reflectances.
double repaint(Solution& solution, LightGroups& groups, const std::vector<Spectrum>& reflectance,
               const std::vector<double>& factor) {
    if (groups.transport.empty()) return 0;
    if (groups.layout.empty()) groups.layout = make_layout(solution, groups.transport.receiver);
    const TransportLayout& layout = groups.layout;
    const KeptOperator F(groups.transport, layout, solution.interpolant.tree.size());
    const std::size_t n = layout.sources.size();
    std::vector<Spectrum> was(n), is(n), b(n);
    const std::vector<Spectrum> E = source_means(layout, solution.interpolant.values);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t m = layout.material[i].value;
        was[i] = groups.reflectance[m], is[i] = reflectance[m];
        b[i] = was[i] * E[i] + solution.direct_share * (factor[m] * groups.exitance[m]);
    }
    const std::vector<Spectrum> change = change_of_reflected(F, layout, solution.bounces, solution, E, was, is);
    const std::vector<Spectrum> arrives = arriving_change(F, solution, change, b);
    parallel_for(arrives.size(), 4096, [&](std::size_t i) {
        for (std::size_t band = 0; band < bands; ++band)
            solution.indirect.values[i][band] += static_cast<float>(arrives[i][band]);
    });
    parallel_for(solution.interpolant.values.size(), 4096, [&](std::size_t i) {
        const Spectrum more = layout.interpolant_at[i].of(arrives);
        for (std::size_t band = 0; band < bands; ++band) {
            float& value = solution.interpolant.values[i][band];
            value = std::max(0.0F, value + static_cast<float>(more[band]));
        }
    });
    const std::vector<Spectrum> fresh = source_means(layout, solution.interpolant.values);
    double squares = 0, light = 0, area = 0;
    for (std::size_t i = 0; i < n; ++i) {
        squares += layout.area[i] * squared(is[i] * (fresh[i] - E[i])) / static_cast<double>(bands);
        light += layout.area[i] * mean(is[i] * fresh[i]), area += layout.area[i];
    }
    return light > 0 ? std::sqrt(squares * area) / light : 0;
}

/// Dimming factor of every material that emits; 1 for others.
std::vector<double> factors_of_materials(const LightGroups& groups) {
    std::vector<double> factor(groups.exitance.size(), 1);
    for (const LightGroup& g : groups.groups)
        for (const MaterialId m : g.emitters.materials) factor[m.value] = g.factor;
    return factor;
}

std::vector<std::pair<std::string, double>> factors_of_groups(const LightGroups& groups) {
    std::vector<std::pair<std::string, double>> out;
    for (const LightGroup& g : groups.groups) out.emplace_back(g.emitters.name, g.factor);
    return out;
}

/// Sets the emission of the scene according to the factors, and the reflectance of every material.
void relight(Scene& scene, const LightGroups& groups, const std::vector<Spectrum>& reflectance) {
    const std::vector<double> factor = factors_of_materials(groups);
    std::vector<PunctualLight> lights = scene.lights();
    DistantLight distant = scene.distant();
    double of_distant = 1;
    for (const LightGroup& g : groups.groups) {
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
    const double repaint_share = repainted ? repaint(solution, groups, reflectance, factors_of_materials(groups)) : 0.0;
    relight(solution.scene, groups, reflectance);
    const bool dimmed =
        std::any_of(groups.groups.begin(), groups.groups.end(), [](const LightGroup& g) { return g.factor != 1; });
    SolveStatistics& s = solution.statistics;
    if (repainted || dimmed) {
        s.relative_error_estimate = error_of(groups);
        if (repainted && s.relative_error_estimate)
            *s.relative_error_estimate = std::hypot(*s.relative_error_estimate, groups.transport.error * repaint_share);
        s.relative_error_bound.reset(), s.error_p99.reset(), s.relative_error_estimate_interpolant.reset();
        s.relative_error_estimate_worst_room.reset(), s.rooms.clear();
        s.relative_error_estimate_worst_body.reset(), s.bodies.clear();
    }
    if (solution.layers) solution.layers = solution.layers->dimmed(factors_of_groups(groups));
    solution.links = {}, solution.discontinuity = {}, solution.own_form = {}, solution.delivers_own_form = false;
    return {};
}

}  // namespace exitance
