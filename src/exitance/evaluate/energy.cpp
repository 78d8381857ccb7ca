#include "exitance/evaluate/energy.hpp"

#include <algorithm>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

/// True if a ray from x meets no front.
bool is_lost(const Stage& stage, const Point& x, const Vec3& w, RegionId region) {
    RayHit hit;
    stage.tracer.nearest(std::span(&x, 1), std::span(&w, 1), region, std::span(&hit, 1), Mirrored::followed);
    return hit.surface.is_none() || !hit.front;
}

/// Share of the light that a piece emits by its profile and that meets no front.
double directed_loss(const Stage& stage, const Piece& piece) {
    constexpr std::uint32_t rays = 1024;
    const RelativeRadiance radiance = stage.scene.relative_radiance(piece.region);
    const Frame frame(radiance.normal());
    const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::shooting), piece.region.value));
    double lost = 0, sent = 0;
    for (std::uint32_t i = 0; i < rays; ++i) {
        const Vec3 w = cosine_direction(frame, points(i, 0), points(i, 1));
        const Point y = piece.patch.at(uniform_in_shape(piece.patch.shape, points(i, 2), points(i, 3)));
        const double p = radiance(w);
        sent += p;
        if (is_lost(stage, y, w, piece.region)) lost += p;
    }
    return sent > 0 ? lost / sent : 0;
}

/// Power of lights without extent that meets no front, such as that of a lamp above a street that shines upwards. Rays
/// are uniform over all directions, or over the cone of a spotlight.
double punctual_loss(const Stage& stage) {
    constexpr std::uint32_t all_rays = 1 << 16, min_rays = 64;  // a single light's share is known to 0.2%
    const std::span<const PunctualLight> lights = stage.scene.lights();
    const LightUnit total = own_unit(stage.scene.is_photometric());
    const std::uint32_t rays =
        lights.empty() ? 0 : std::max(min_rays, all_rays / static_cast<std::uint32_t>(lights.size()));
    const auto loss_of = [&](std::size_t k) {
        const PunctualLight& light = lights[k];
        if (light.is_directional()) return 0.0;  // counts as emitted only if it reaches a face
        const double least = light.kind == PunctualLight::Kind::spot ? std::cos(light.outer_cone) : -1.0;
        const Frame frame(light.direction);
        const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::shooting), ~std::uint64_t(k)));
        double lost = 0, sent = 0;
        for (std::uint32_t i = 0; i < rays; ++i) {
            const double z = 1 - (1 - least) * points(i, 0), r = std::sqrt(std::max(0.0, 1 - z * z));
            const double angle = 2 * pi * points(i, 1);
            const Vec3 w = frame.to_world(r * std::cos(angle), r * std::sin(angle), z);
            const double p = light.share_towards(w);
            sent += p;
            if (p > 0 && is_lost(stage, light.position, w, {})) lost += p;
        }
        return sent > 0 ? lost / sent * total(light.power()) : 0.0;
    };
    std::vector<double> losses(lights.size());
    parallel_for(lights.size(), 1, [&](std::size_t k) { losses[k] = loss_of(k); });
    return std::accumulate(losses.begin(), losses.end(), 0.0);
}

/// Diffuse power that leaves an element or, if `tree` is null, a patch.
struct Leaving {
    RegionId region;
    double power = 0;  ///< Power, W or lm.
    const ElementTree* tree = nullptr;
    ElementId element;
    Patch patch;

    Point place(double s, double t) const {
        if (tree) return tree->patch(element).at(tree->uniform(element, s, t));
        return patch.at(uniform_in_shape(patch.shape, s, t));
    }
};

/// Number of rays: if light may escape at all, the escaping share is known to 1 / (2 sqrt(rays)) = 0.3% of the light
/// leaving surfaces.
constexpr std::uint32_t escape_rays = 1 << 15;

/// Power that meets no front, estimated by rays distributed in proportion to the power that leaves. `each(visit)` must
/// call visit(Leaving) for all surfaces, in the same way every time.
template <class Each>
double escaping(const Stage& stage, const Each& each) {
    double total = 0;
    bool open = false;
    each([&](const Leaving& l) {
        total += l.power;
        open |= l.power > 0 && stage.rooms.lost_share(l.region, l.place(0.5, 0.5)) > 0;
    });
    if (!open) return 0;
    const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::shooting), escape_rays));
    struct Ray {
        Point x;
        Vec3 w;
        RegionId region;
    };
    std::vector<Ray> rays;
    rays.reserve(escape_rays);
    double before = 0;
    each([&](const Leaving& l) {
        before += l.power;
        while (rays.size() < escape_rays) {
            const auto k = static_cast<std::uint32_t>(rays.size());
            if ((k + 0.5) * total > before * escape_rays) break;
            const Frame frame(stage.scene.regions()[l.region].plane.n);
            rays.push_back(
                {l.place(points(k, 0), points(k, 1)), cosine_direction(frame, points(k, 2), points(k, 3)), l.region});
        }
    });
    std::vector<std::uint8_t> lost(rays.size());
    parallel_for(rays.size(), 64,
                 [&](std::size_t k) { lost[k] = is_lost(stage, rays[k].x, rays[k].w, rays[k].region); });
    const auto count = std::count(lost.begin(), lost.end(), std::uint8_t(1));
    return rays.empty() ? 0 : total * static_cast<double>(count) / static_cast<double>(rays.size());
}

/// Calls visit(area, E, place) for the direct light of all layers; the power in `place` is not set.
template <class Visit>
void visit_layers(const Solution& solution, const Visit& visit) {
    const Spectrum share = Spectrum(1.0) - solution.direct_share;
    for (std::size_t i = 0; i < solution.layers->triangle_count(); ++i) {
        const QuadraticTriangle t = solution.layers->triangle(solution.scene, i, share);
        const Point& a = t.corners[0];
        const Patch patch{a, t.corners[1] - a, t.corners[2] - a, Patch::Shape::triangle};
        // The mean of a quadratic polynomial is that of its values at the middles of the edges.
        visit(patch.area(), (t.values[3] + t.values[4] + t.values[5]) / 3, Leaving{t.region, 0, nullptr, {}, patch});
    }
}

/// Calls visit(area, E, place) for all arriving light; the power in `place` is not set.
template <class Visit>
void for_arriving(const Solution& solution, const DirectProjection& direct, const Visit& visit) {
    if (const SixNodeMesh& mesh = solution.discontinuity; !mesh.empty()) {
        for (std::uint32_t t = 0; t < mesh.size(); ++t) {
            const auto& n = mesh.nodes[t];
            const Spectrum E = mesh.mean(t);
            const Point &a = mesh.points[n[0]], &b = mesh.points[n[1]], &c = mesh.points[n[2]];
            visit(mesh.area(t), E, Leaving{mesh.region[t], 0, nullptr, {}, {a, b - a, c - a, Patch::Shape::triangle}});
        }
        return;
    }
    const auto of = [](const ElementTree& tree, ElementId e) { return Leaving{tree.region(e), 0, &tree, e, {}}; };
    if (solution.layers)
        visit_layers(solution, visit);
    else if (!solution.direct_in_elements)
        for (ElementId e : direct.tree.leaves())
            visit(direct.tree.area(e), (Spectrum(1.0) - solution.direct_share) * direct.fit[e].mean,
                  of(direct.tree, e));
    // The mean of a linear or bilinear function over an element is its value at the centre.
    const ElementTree& tree = solution.indirect.tree;
    for (ElementId e : tree.leaves()) visit(tree.area(e), solution.indirect.at({e, tree.centre(e)}), of(tree, e));
}

/// Power of the light from outside (sky, sun, parallel light) that reaches the surfaces of a tree, W or lm. Estimated
/// at places at equal steps of the area, since elements may be of any size.
double arriving_from_outside(const Stage& stage, const ElementTree& tree, const LightUnit& total) {
    if (!stage.scene.has_light_from_outside()) return 0;
    constexpr std::size_t places = 1 << 13;             // a border of shadow then changes the sum by about 1 / 2^13
    constexpr LightAccuracy accuracy{.relative = 0.1};  // derived from 2^13 places, whose mean then has 0.1% noise
    const std::vector<ElementId> leaves = tree.leaves();
    std::vector<double> area_up_to;
    double area = 0;
    for (const ElementId e : leaves) area_up_to.push_back(area += tree.area(e));
    const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::shooting), places));
    std::vector<double> arriving(places);
    parallel_ranges(places, 16, [&](std::size_t begin, std::size_t end) {
        PlaceLight::Workspace workspace;
        for (std::size_t k = begin; k < end; ++k) {
            const double at = (static_cast<double>(k) + 0.5) / places * area;
            const auto i = std::lower_bound(area_up_to.begin(), area_up_to.end(), at) - area_up_to.begin();
            const ElementId e = leaves[std::min(static_cast<std::size_t>(i), leaves.size() - 1)];
            const auto index = static_cast<std::uint32_t>(k);
            const Point x = tree.patch(e).at(tree.uniform(e, points(index, 0), points(index, 1)));
            const RegionId own = tree.region(e);
            const Normal& n = stage.scene.regions()[own].plane.n;
            arriving[k] = total(stage.place_light.at(x, n, own, accuracy, workspace).parallel);
        }
    });
    return area / places * std::accumulate(arriving.begin(), arriving.end(), 0.0);
}

}  // namespace

EnergyBalance energy_balance(const Solution& solution, const DirectProjection& direct, const Stage& stage) {
    const Scene& scene = solution.scene;
    const LightUnit total = own_unit(scene.is_photometric());
    EnergyBalance out;
    for (const Region& region : scene.regions())
        out.emitted += region.area * total(scene.materials()[region.material].exitance);
    for (const PunctualLight& light : scene.lights()) out.emitted += total(light.power());
    // Parallel light and light of the sky come from outside: the light that reaches surfaces counts as emitted.
    for (ElementId e : direct.tree.leaves()) out.emitted += direct.tree.area(e) * total(direct.fit[e].parallel);
    for_arriving(solution, direct, [&](double area, const Spectrum& E, const Leaving& at) {
        out.absorbed += area * total((Spectrum(1.0) - scene.material(at.region).reflectance) * E);
    });
    out.escaped = escaping(stage, [&](const auto& visit) {
        for (const auto& [region, patch] : stage.pieces) {
            const Material& material = scene.material(region);
            if (material.emits() && !material.is_directed())
                visit(Leaving{region, patch.area() * total(material.exitance), nullptr, {}, patch});
        }
        for_arriving(solution, direct, [&](double area, const Spectrum& E, Leaving at) {
            at.power = area * total(scene.material(at.region).reflectance * E);
            visit(at);
        });
    });
    for (const Piece& piece : stage.pieces)
        if (scene.material(piece.region).is_directed())
            out.escaped +=
                directed_loss(stage, piece) * piece.patch.area() * total(scene.material(piece.region).exitance);
    out.escaped += punctual_loss(stage);
    out.defect = out.emitted > 0 ? std::abs(out.emitted - out.absorbed - out.escaped) / out.emitted : 0;
    return out;
}

DirectMeans mean_direct_light(const Stage& stage, const DirectProjection& direct) {
    DirectMeans out;
    for (ElementId e : direct.tree.leaves()) {
        const double share = direct.tree.area(e) / stage.area;
        out.arriving += share * mean(direct.fit[e].mean);
        out.reflected += share * mean(stage.scene.material(direct.tree.region(e)).reflectance * direct.fit[e].mean);
    }
    return out;
}

EnergyBalance energy_of_interpolant(const Solution& solution, const Stage& stage) {
    const Scene& scene = solution.scene;
    const ElementTree& tree = solution.interpolant.tree;
    const LightUnit total = own_unit(scene.is_photometric());
    EnergyBalance out;
    for (const Region& region : scene.regions())
        out.emitted += region.area * total(scene.materials()[region.material].exitance);
    for (const PunctualLight& light : scene.lights()) out.emitted += total(light.power());
    out.emitted += arriving_from_outside(stage, tree, total);
    const auto arriving = [&](ElementId e) { return solution.interpolant.at({e, tree.centre(e)}); };
    for (const ElementId e : tree.leaves())
        out.absorbed +=
            tree.area(e) * total((Spectrum(1.0) - scene.material(tree.region(e)).reflectance) * arriving(e));
    out.escaped = escaping(stage, [&](const auto& visit) {
        for (const ElementId e : tree.leaves()) {
            const Material& material = scene.material(tree.region(e));
            visit(Leaving{tree.region(e),
                          tree.area(e) * total(material.exitance + material.reflectance * arriving(e)),
                          &tree,
                          e,
                          {}});
        }
    });
    out.escaped += punctual_loss(stage);
    out.defect = out.emitted > 0 ? std::abs(out.emitted - out.absorbed - out.escaped) / out.emitted : 0;
    return out;
}

EnergyBalance energy_balance(const Solution& solution, const Stage& stage) {
    DirectProjection none;
    for (const Piece& piece : stage.pieces) none.tree.add_root(piece.region, piece.patch);
    none.fit.resize(none.tree.size());
    return energy_balance(solution, none, stage);
}

bool shines_on_backs(const Stage& stage) {
    constexpr std::uint32_t rays = 64;
    const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::shooting), rays));
    const auto meets_back = [&](const Point& x, const Vec3& w, RegionId own) {
        RayHit hit;
        stage.tracer.nearest(std::span(&x, 1), std::span(&w, 1), own, std::span(&hit, 1), Mirrored::followed);
        return !hit.surface.is_none() && !hit.front;
    };
    for (const Piece& piece : stage.pieces) {
        if (!stage.scene.material(piece.region).emits()) continue;
        const Frame frame(stage.scene.regions()[piece.region].plane.n);
        for (std::uint32_t i = 0; i < rays; ++i) {
            const Point y = piece.patch.at(uniform_in_shape(piece.patch.shape, points(i, 2), points(i, 3)));
            if (meets_back(y, cosine_direction(frame, points(i, 0), points(i, 1)), piece.region)) return true;
        }
    }
    for (const PunctualLight& light : stage.scene.lights()) {
        if (light.is_directional()) continue;  // directional light counts as emitted only if it reaches a face
        for (const double side : {1.0, -1.0})
            for (std::uint32_t i = 0; i < rays; ++i)
                if (meets_back(light.position, cosine_direction(Frame({0, 0, side}), points(i, 0), points(i, 1)), {}))
                    return true;
    }
    return false;
}

}  // namespace exitance
