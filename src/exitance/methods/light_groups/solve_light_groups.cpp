#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/core/parallel.hpp"
#include "exitance/core/random.hpp"
#include "exitance/methods/light_groups/light_groups.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reconstruct/radiosity_function.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {
namespace {

/// Rays are as many as fill 8 MB, so that all of them are met again in tens of milliseconds.
constexpr std::size_t rays_in_all = std::size_t(1) << 21;
constexpr std::uint32_t fewest_rays = 16, most_rays = 1024;

/// How far corners lie from where they are evaluated, in elements: light may jump at their borders.
constexpr double inwards = 1e-3;  // Given by the tolerance of places: a thousandth of an element is above it.

/// The places at which a function's values are taken: a little inside, and where the element ends before its frame's
/// corner, where it ends.
struct Corners {
    std::vector<ProbePoint> near_corner, centre;  ///< By value; by leaf.
    std::vector<std::uint32_t> leaf;              ///< By value.
    std::vector<double> reach;                    ///< Of the way from the centre to the corner.

    Corners(const ElementFunction& f, const Scene& scene) {
        std::uint32_t number = 0;
        for (const ElementId e : f.tree.leaves()) {
            const Patch& patch = f.tree.patch(e);
            const Normal n = scene.regions()[f.tree.region(e)].plane.n;
            const Vec2 middle = f.tree.centre(e);
            centre.push_back({patch.at(middle), n});
            for (int i = 0; i < patch.corner_count(); ++i) {
                const Vec2 uv = patch.corner_uv(i);
                const double share = (1 - inwards) * std::min(1.0, f.tree.reach(e, uv));
                near_corner.push_back({patch.at(middle + share * (uv - middle)), n});
                leaf.push_back(number), reach.push_back(share);
            }
            ++number;
        }
    }
};

std::array<float, bands> as_floats(const Spectrum& s) {
    std::array<float, bands> out;
    for (std::size_t i = 0; i < bands; ++i) out[i] = static_cast<float>(s[i]);
    return out;
}

/// A function's values at corners, linear between the centre and where the element ends.
CornerValues values_at(const Corners& corners, const RadiosityFunction& light, Component component,
                       const Spectrum& direct_share) {
    const std::vector<Light> near = light.at(corners.near_corner, component);
    const std::vector<Light> middle = light.at(corners.centre, component);
    std::vector<Light> direct;
    if (max(direct_share) > 0) direct = light.at(corners.near_corner, Component::direct);
    CornerValues out(near.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
        Spectrum value = near[i].irradiance;
        const double reach = corners.reach[i];
        if (reach > 0 && reach < 1 - 2 * inwards) {
            const Spectrum& at_centre = middle[corners.leaf[i]].irradiance;
            value = at_centre + (value - at_centre) * (1 / reach);
        }
        if (!direct.empty()) value += direct_share * direct[i].irradiance;
        for (std::size_t band = 0; band < bands; ++band) out[i][band] = static_cast<float>(value[band]);
    }
    return out;
}

/// Makes the groups' sum what is there: what it lacks goes to those that have light there, by how much they have.
/// Where none has any, each gets its share of all light.
void spread_remainder(const CornerValues& whole, std::vector<LightGroup>& groups, CornerValues LightGroup::*values) {
    std::vector<double> of_all(groups.size(), 0);
    double all = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for (const auto& v : groups[g].*values)
            for (const float x : v) of_all[g] += std::max(0.0, static_cast<double>(x));
        all += of_all[g];
    }
    for (double& share : of_all) share = all > 0 ? share / all : 1 / static_cast<double>(groups.size());
    parallel_for(whole.size(), 4096, [&](std::size_t i) {
        for (std::size_t band = 0; band < bands; ++band) {
            double sum = 0, light = 0;
            for (const LightGroup& g : groups) {
                const double v = static_cast<double>((g.*values)[i][band]);
                sum += v, light += std::max(0.0, v);
            }
            const double lacking = static_cast<double>(whole[i][band]) - sum;
            for (std::size_t g = 0; g < groups.size(); ++g) {
                float& v = (groups[g].*values)[i][band];
                const double share = light > 0 ? std::max(0.0, static_cast<double>(v)) / light : of_all[g];
                v = static_cast<float>(static_cast<double>(v) + share * lacking);
            }
        }
    });
}

/// The scene with nothing but a group's light.
Scene alone(const Scene& scene, const EmitterGroup& group) {
    Scene out = scene;
    for (const MaterialId m : scene.materials().ids()) {
        const bool own = std::find(group.materials.begin(), group.materials.end(), m) != group.materials.end();
        if (!own && scene.materials()[m].emits()) out.relight(m, scene.materials()[m].reflectance, Spectrum());
    }
    std::vector<PunctualLight> lights;
    for (const std::uint32_t i : group.lights) lights.push_back(scene.lights()[i]);
    out.put_lights(std::move(lights));
    if (!group.is_distant) out.put_under({});
    return out;
}

/// Which leaves the rays of every leaf meet: from places and in directions that are spread evenly, by the cosine.
void trace_leaves(const Solution& solution, LightGroups& out) {
    const ElementTree& tree = solution.indirect.tree;
    const Scene& scene = solution.scene;
    const std::vector<ElementId> leaves = tree.leaves();
    if (leaves.empty()) return;
    const std::size_t wanted = rays_in_all / leaves.size();
    out.rays = static_cast<std::uint32_t>(std::clamp<std::size_t>(wanted, fewest_rays, most_rays));
    out.met.assign(leaves.size() * out.rays, LightGroups::nothing);
    const RayTracer tracer(scene);
    const ElementLocator locator(tree, scene.regions().size());
    parallel_for(leaves.size(), 8, [&](std::size_t leaf) {
        const ElementId e = leaves[leaf];
        const RegionId region = tree.region(e);
        const Frame frame(scene.regions()[region].plane.n);
        const ScrambledSobol points(hash(leaf, std::uint64_t(0x6c67)));
        std::vector<Point> origins(out.rays);
        std::vector<Vec3> directions(out.rays);
        std::vector<RayHit> hits(out.rays);
        for (std::uint32_t r = 0; r < out.rays; ++r) {
            origins[r] = tree.patch(e).at(tree.uniform(e, points(r, 0), points(r, 1)));
            const double u = points(r, 2), sine = std::sqrt(u), angle = 2 * pi * points(r, 3);
            directions[r] = frame.to_world(sine * std::cos(angle), sine * std::sin(angle), std::sqrt(1 - u));
        }
        tracer.nearest(origins, directions, region, hits);
        for (std::uint32_t r = 0; r < out.rays; ++r)
            if (hits[r].front)
                out.met[leaf * out.rays + r] =
                    locator.find_leaf(hits[r].region, origins[r] + hits[r].distance * directions[r]).leaf;
    });
}

/// RMS over the leaves of what they reflect of light that the solution's elements miss of a group's own, at their
/// centres, W/m^2.
double missed_light(const Solution& solution, const Corners& corners, const CornerValues& values,
                    const RadiosityFunction& own) {
    const ElementTree& tree = solution.indirect.tree;
    ElementFunction held{tree, solution.indirect.first_value, values};
    const std::vector<Light> right = own.at(corners.centre, Component::indirect);
    std::vector<Light> direct;
    if (max(solution.direct_share) > 0) direct = own.at(corners.centre, Component::direct);
    double sum = 0, area = 0;
    std::size_t number = 0;
    for (const ElementId e : tree.leaves()) {
        Spectrum off = held.at({e, tree.centre(e)}) - right[number].irradiance;
        if (!direct.empty()) off -= solution.direct_share * direct[number].irradiance;
        const Spectrum reflected = solution.scene.material(tree.region(e)).reflectance * off;
        for (std::size_t band = 0; band < bands; ++band)
            sum += tree.area(e) * reflected[band] * reflected[band] / static_cast<double>(bands);
        area += tree.area(e);
        ++number;
    }
    return area > 0 ? std::sqrt(sum / area) : 0;
}

/// Mean over the leaves of what they reflect of a group's light, W/m^2 and band.
double mean_reflected(const Solution& solution, const LightGroup& group) {
    const ElementTree& tree = solution.indirect.tree;
    double sum = 0, area = 0;
    std::size_t corner = 0, number = 0;
    for (const ElementId e : tree.leaves()) {
        const int count = tree.patch(e).corner_count();
        Spectrum light;
        for (int i = 0; i < count; ++i, ++corner)
            for (std::size_t band = 0; band < bands; ++band)
                light[band] += static_cast<double>(group.indirect[corner][band]) / count;
        for (std::size_t band = 0; band < bands; ++band)
            light[band] += (1 - solution.direct_share[band]) * static_cast<double>(group.direct[number][band]);
        sum += tree.area(e) * mean(solution.scene.material(tree.region(e)).reflectance * light);
        area += tree.area(e);
        ++number;
    }
    return area > 0 ? sum / area : 0;
}

}  // namespace

std::size_t LightGroups::light_bytes() const {
    std::size_t values = 0;
    for (const LightGroup& g : groups) values += g.indirect.size() + g.interpolant.size();
    return values * sizeof(CornerValues::value_type);
}

std::size_t LightGroups::repaint_bytes() const {
    std::size_t bytes = met.size() * sizeof(std::uint32_t);
    for (const LightGroup& g : groups) bytes += g.direct.size() * sizeof(CornerValues::value_type);
    return bytes;
}

Result<LightGroups> solve_light_groups(const Solution& solution, const SolveOptions& options, Progress& progress,
                                       const StopRequest& stop) {
    const Scene& scene = solution.scene;
    LightGroups out;
    const std::vector<EmitterGroup> found = find_emitter_groups(scene);
    for (const Material& m : scene.materials())
        out.reflectance.push_back(m.reflectance), out.exitance.push_back(m.exitance);
    for (const PunctualLight& light : scene.lights()) out.intensity.push_back(light.intensity);
    for (const auto& dome : scene.distant().domes) out.distant.push_back(dome.irradiance);
    for (const auto& disc : scene.distant().discs) out.distant.push_back(disc.irradiance);
    const Corners of_indirect(solution.indirect, scene), of_interpolant(solution.interpolant, scene);
    std::vector<double> missed;
    for (const EmitterGroup& emitters : found) {
        progress.phase("group " + emitters.name);
        const Scene lit = alone(scene, emitters);
        const Result<Solution> own = solve_scene(lit, options, progress, stop);
        if (!own) return own.error();
        if (stop.requested()) return Error{ErrorCode::limit, "was stopped before all light groups were solved", "", ""};
        LightGroup& group = out.groups.emplace_back();
        group.emitters = emitters, group.error = own->statistics.relative_error_estimate;
        const RadiosityFunction light(*own);
        group.indirect = values_at(of_indirect, light, Component::indirect, solution.direct_share);
        missed.push_back(missed_light(solution, of_indirect, group.indirect, light));
        group.interpolant = values_at(of_interpolant, light, Component::total, Spectrum());
        for (const Light& l : light.at(of_indirect.centre, Component::direct))
            group.direct.push_back(as_floats(l.irradiance));
    }
    spread_remainder(solution.indirect.values, out.groups, &LightGroup::indirect);
    spread_remainder(solution.interpolant.values, out.groups, &LightGroup::interpolant);
    for (std::size_t g = 0; g < out.groups.size(); ++g) {
        LightGroup& group = out.groups[g];
        group.reflected = mean_reflected(solution, group);
        if (group.error && group.reflected > 0) group.error = std::hypot(*group.error, missed[g] / group.reflected);
    }
    progress.phase("rays for repainting");
    trace_leaves(solution, out);
    return out;
}

}  // namespace exitance
