#include <algorithm>
#include <cmath>

#include "exitance/scene/scene_builder.hpp"

namespace exitance {

/// Adds the regions with their planes. Points off the plane by more than rounding are projected to it.
void SceneBuilder::add_regions(Scene& scene, const std::vector<JoinedFaces>& joined) {
    scene.regions_.reserve(joined.size());
    for (const JoinedFaces& set : joined) {
        Region region;
        region.material = MaterialId(mesh_.material[set.faces[0]]);
        const RegionId id(scene.regions_.size());
        Vec3 area;
        double mean = 0, farthest = 0;
        std::size_t count = 0;
        const Point& origin = in_.points[set.loops[0][0]];
        for (const auto& loop : set.loops) {
            std::vector<Point>& corners = region.loops.emplace_back();
            for (std::uint32_t c : loop) corners.push_back(in_.points[c]);
            area += area_vector(corners);
        }
        const Normal n = normalized(area);
        for (const auto& loop : region.loops)
            for (const Point& p : loop) mean += dot(n, p - origin), ++count;
        mean /= static_cast<double>(count);
        region.plane = {n, dot(n, origin) + mean};
        region.area = norm(area);
        for (std::uint32_t f : set.faces)
            for (std::uint32_t c : mesh_.outline(f))
                farthest = std::max(farthest, std::abs(dot(n, in_.points[c] - origin) - mean));
        const auto into_plane = [&](Point& p) { p -= (dot(n, p - origin) - mean) * n; };
        if (farthest > tol_.place)
            for (auto& loop : region.loops) std::for_each(loop.begin(), loop.end(), into_plane);
        for (std::uint32_t f : set.faces) {
            region.surfaces.push_back(SurfaceId(f));
            Surface& surface = scene.surfaces_[SurfaceId(f)];
            surface.region = id;
            surface.normal = n;
            auto outline = std::span(scene.corners_).subspan(surface.first_corner, surface.corner_count);
            if (farthest <= tol_.place) continue;
            std::for_each(outline.begin(), outline.end(), into_plane);
            surface.area = norm(area_vector(outline));
        }
        scene.regions_.add(std::move(region));
    }
}

Scene SceneBuilder::make() {
    mesh_.points = in_.points;
    Scene scene;
    scene.file_ = in_.file;
    scene.box_ = box_;
    scene.surfaces_.resize(mesh_.size());
    scene.corners_.reserve(mesh_.corners.size());
    for (std::uint32_t c : mesh_.corners) scene.corners_.push_back(in_.points[c]);
    for (std::uint32_t f = 0; f < mesh_.size(); ++f) {
        const SceneDescription::Face& face = in_.faces[origin_[f]];
        Surface& surface = scene.surfaces_[SurfaceId(f)];
        surface.first_corner = mesh_.first[f];
        surface.corner_count = mesh_.first[f + 1] - mesh_.first[f];
        surface.material = MaterialId(face.material);
        surface.group = GroupId(face.group);
        surface.line = face.line, surface.whole = face.whole;
        surface.area = norm(mesh_.area_vector[f]);
        if (in_.materials[face.material].emits()) scene.emitters_.push_back(SurfaceId(f));
    }
    add_regions(scene, join_coplanar(mesh_, tol_));
    for (Material& m : in_.materials) scene.materials_.add(std::move(m));
    for (EmissionProfile& p : in_.profiles) {
        p.find_smooth_width();
        scene.profiles_.add(std::move(p));
    }
    for (const std::string& g : in_.groups) scene.groups_.add(g);
    for (PunctualLight& light : in_.lights)
        if (max(light.intensity) > 0) scene.lights_.push_back(std::move(light));
    scene.distant_ = std::move(in_.distant);
    scene.panes_ = convex_panes(in_.panes);
    scene.cameras_ = std::move(in_.cameras);
    scene.luminaire_types_ = std::move(in_.luminaire_types), scene.luminaires_ = std::move(in_.luminaires);
    scene.photometric_ = in_.photometric;
    return scene;
}

void Scene::relight(MaterialId m, const Spectrum& reflectance, const Spectrum& exitance) {
    materials_[m].reflectance = reflectance, materials_[m].exitance = exitance;
    emitters_.clear();
    for (const SurfaceId s : surfaces_.ids())
        if (material(s).emits()) emitters_.push_back(s);
}

}  // namespace exitance
