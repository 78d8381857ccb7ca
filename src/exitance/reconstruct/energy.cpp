#include "exitance/reconstruct/energy.hpp"

#include <numeric>

#include "exitance/core/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"

namespace exitance {
namespace {

double sum(const Spectrum& s) {
    return std::accumulate(s.value.begin(), s.value.end(), 0.0);
}

/// The share of what a piece emits by its profile that meets no front.
double directed_loss(const Stage& stage, const Piece& piece) {
    constexpr std::uint32_t rays = 1024;
    const RelativeRadiance radiance = stage.scene.relative_radiance(piece.region);
    const Frame frame(radiance.normal());
    const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::shooting), piece.region.value));
    double lost = 0, sent = 0;
    for (std::uint32_t i = 0; i < rays; ++i) {
        const Vec3 w = cosine_direction(frame, points(i, 0), points(i, 1));
        const Point y = piece.patch.at(uniform_in_shape(piece.patch.shape, points(i, 2), points(i, 3)));
        RayHit hit;
        stage.tracer.nearest(std::span(&y, 1), std::span(&w, 1), piece.region, std::span(&hit, 1));
        const double p = radiance(w);
        sent += p;
        if (hit.surface.is_none() || !hit.front) lost += p;
    }
    return sent > 0 ? lost / sent : 0;
}

}  // namespace

EnergyBalance energy_balance(const Solution& solution, const DirectProjection& direct, const Stage& stage) {
    const LightRooms& rooms = stage.rooms;
    const Scene& scene = solution.scene;
    EnergyBalance out;
    for (const Region& region : scene.regions())
        out.emitted += region.area * sum(scene.materials()[region.material].exitance);
    for (const PunctualLight& light : scene.lights()) out.emitted += sum(light.power());
    // Parallel light and that of the sky come from outside: what meets a surface counts as emitted.
    for (ElementId e : direct.tree.leaves()) out.emitted += direct.tree.area(e) * sum(direct.fit[e].parallel);
    const auto arrive = [&](RegionId region, const Point& centre, double area, const Spectrum& E) {
        const Spectrum& rho = scene.material(region).reflectance;
        out.absorbed += area * sum((Spectrum(1.0) - rho) * E);
        const double lost = rooms.lost_share(region, centre);
        if (lost > 0) out.escaped += lost * area * sum(rho * E);
    };
    const auto leave = [&](RegionId region, const Point& centre, double area) {
        const Spectrum& M = scene.material(region).exitance;
        if (max(M) > 0 && !scene.material(region).is_directed())
            out.escaped += rooms.lost_share(region, centre) * area * sum(M);
    };
    for (const Piece& piece : stage.pieces)
        if (scene.material(piece.region).is_directed())
            out.escaped +=
                directed_loss(stage, piece) * piece.patch.area() * sum(scene.material(piece.region).exitance);
    if (const SixNodeMesh& mesh = solution.discontinuity; !mesh.empty()) {
        for (std::uint32_t t = 0; t < mesh.size(); ++t) {
            // A quadratic polynomial has the mean of its values at the middles of a triangle's edges.
            const auto& n = mesh.nodes[t];
            const Spectrum E = (1.0 / 3) * (mesh.value(n[3]) + mesh.value(n[4]) + mesh.value(n[5]));
            arrive(mesh.region[t], mesh.centre(t), mesh.area(t), E);
            leave(mesh.region[t], mesh.centre(t), mesh.area(t));
        }
    } else {
        const auto centre = [](const ElementTree& tree, ElementId e) { return tree.patch(e).at(tree.centre(e)); };
        for (ElementId e : direct.tree.leaves()) {
            leave(direct.tree.region(e), centre(direct.tree, e), direct.tree.area(e));
            if (!solution.direct_in_elements)
                arrive(direct.tree.region(e), centre(direct.tree, e), direct.tree.area(e),
                       (Spectrum(1.0) - solution.direct_share) * direct.fit[e].mean);
        }
        // A linear or bilinear function has its mean at the centre of its element.
        const ElementTree& tree = solution.indirect.tree;
        for (ElementId e : tree.leaves())
            arrive(tree.region(e), centre(tree, e), tree.area(e), solution.indirect.at({e, tree.centre(e)}));
    }
    out.defect = out.emitted > 0 ? std::abs(out.emitted - out.absorbed - out.escaped) / out.emitted : 0;
    return out;
}

double mean_direct_light(const Stage& stage, const DirectProjection& direct) {
    double flux = 0;
    for (ElementId e : direct.tree.leaves()) flux += direct.tree.area(e) * mean(direct.fit[e].mean);
    return flux / stage.area;
}

EnergyBalance energy_of_interpolant(const Solution& solution, const Stage& stage) {
    const Scene& scene = solution.scene;
    const ElementTree& tree = solution.interpolant.tree;
    EnergyBalance out;
    for (const Region& region : scene.regions())
        out.emitted += region.area * sum(scene.materials()[region.material].exitance);
    for (const PunctualLight& light : scene.lights()) out.emitted += sum(light.power());
    for (const ElementId e : tree.leaves()) {
        const Material& material = scene.material(tree.region(e));
        const Spectrum E = solution.interpolant.at({e, tree.centre(e)});
        const double lost = stage.rooms.lost_share(tree.region(e), tree.patch(e).at(tree.centre(e)));
        out.absorbed += tree.area(e) * sum((Spectrum(1.0) - material.reflectance) * E);
        out.escaped += lost * tree.area(e) * sum(material.exitance + material.reflectance * E);
    }
    out.defect = out.emitted > 0 ? std::abs(out.emitted - out.absorbed - out.escaped) / out.emitted : 0;
    return out;
}

EnergyBalance energy_balance(const Solution& solution, const Stage& stage) {
    DirectProjection none;
    for (const Piece& piece : stage.pieces) none.tree.add_root(piece.region, piece.patch);
    none.fit.resize(none.tree.size());
    return energy_balance(solution, none, stage);
}

}  // namespace exitance
