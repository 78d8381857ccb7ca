#include "exitance/scene.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/api/inside.hpp"
#include "exitance/api/sky.hpp"
#include "exitance/scene/emitter_groups.hpp"

namespace exitance::api {
namespace {

/// The error of arrays that do not fit together; none if they do.
std::optional<Error> find_misfit(const SceneDescription& d) {
    const std::size_t faces = d.corner_counts.size();
    std::size_t corners = 0;
    for (std::size_t f = 0; f < faces; ++f) {
        if (d.corner_counts[f] < 3)
            return usage(fmt::format("has {} corners", d.corner_counts[f]), fmt::format("face {}", f),
                         "a face needs at least 3");
        corners += d.corner_counts[f];
    }
    if (corners != d.corners.size())
        return usage(fmt::format("has {} entries, but the faces have {} corners", d.corners.size(), corners),
                     "corners");
    for (std::size_t c = 0; c < d.corners.size(); ++c)
        if (d.corners[c] >= d.vertices.size())
            return usage(fmt::format("is {}, but there are {} vertices", d.corners[c], d.vertices.size()),
                         fmt::format("corner {}", c), "indices start at 0");
    std::size_t first = 0;
    for (std::size_t f = 0; f < faces; first += d.corner_counts[f++])
        for (std::size_t c = first; c < first + d.corner_counts[f]; ++c) {
            const Vec3& v = d.vertices[d.corners[c]];
            if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
                return usage(fmt::format("has vertex {} at ({}, {}, {})", d.corners[c], v.x, v.y, v.z),
                             fmt::format("face {}", f), "coordinates are finite numbers, in metres");
        }
    if (d.material.size() != faces)
        return usage(fmt::format("has {} entries for {} faces", d.material.size(), faces), "material");
    if (!d.group.empty() && d.group.size() != faces)
        return usage(fmt::format("has {} entries for {} faces", d.group.size(), faces), "group");
    const std::size_t groups = std::max<std::size_t>(1, d.groups.size());
    for (std::size_t f = 0; f < faces; ++f) {
        if (d.material[f] >= d.materials.size())
            return usage(fmt::format("has material {}, but there are {}", d.material[f], d.materials.size()),
                         fmt::format("face {}", f));
        if (!d.group.empty() && d.group[f] >= groups)
            return usage(fmt::format("is in group {}, but there are {}", d.group[f], groups),
                         fmt::format("face {}", f));
    }
    return std::nullopt;
}

exitance::SceneDescription to_engine(const SceneDescription& d) {
    exitance::SceneDescription out;
    out.photometric = d.photometric;
    for (const Vec3& v : d.vertices) out.points.push_back(api::to_engine(v));
    for (const Material& m : d.materials)
        out.materials.push_back({m.name, api::to_engine(m.reflectance), api::to_engine(m.exitance)});
    out.groups = d.groups;
    if (out.groups.empty()) out.groups.emplace_back();
    const std::uint32_t* corner = d.corners.data();
    for (std::size_t f = 0; f < d.corner_counts.size(); ++f) {
        exitance::SceneDescription::Face face;
        face.corners.assign(corner, corner + d.corner_counts[f]);
        corner += d.corner_counts[f];
        face.material = d.material[f];
        face.group = d.group.empty() ? 0 : d.group[f];
        out.faces.push_back(std::move(face));
    }
    return out;
}

}  // namespace

Result<Scene> make_scene(const SceneDescription& description) {
    return take_turn<Scene>([&]() -> Result<Scene> {
        if (const std::optional<Error> misfit = find_misfit(description)) return *misfit;
        exitance::SceneDescription in = to_engine(description);
        const Result<std::optional<ChosenSky>> sky = read_sky(description.sky, description.epw);
        if (!sky) return sky.error();
        if (*sky) {
            in.photometric = (*sky)->photometric.value_or(in.photometric);
            in.distant = in.photometric ? (*sky)->in_lumens : (*sky)->in_watts;
        }
        if (description.light_groups) part_emitters_by_group(in);
        CheckedScene checked = exitance::make_scene(std::move(in));
        if (!checked.scene) return to_api(checked.scene.error());
        SceneData data{std::make_shared<const exitance::Scene>(std::move(*checked.scene)),
                       {},
                       checked.findings,
                       {},
                       description.light_groups};
        for (const exitance::Finding& finding : checked.findings) data.findings.push_back(to_api(finding));
        return Scene(std::make_shared<const SceneData>(std::move(data)));
    });
}

std::size_t Scene::size() const {
    return data_->scene->surfaces().size();
}

Face Scene::face(std::size_t index) const {
    const SurfaceId id(index);
    const Surface& surface = data_->scene->surfaces()[id];
    Face out{{},
             to_api(surface.normal),
             surface.area,
             surface.material.value,
             surface.group.is_none() ? 0 : surface.group.value};
    for (const Point& p : data_->scene->outline(id)) out.outline.push_back(to_api(p));
    return out;
}

std::vector<Material> Scene::materials() const {
    std::vector<Material> out;
    for (const exitance::Material& m : data_->scene->materials())
        out.push_back({m.name, to_api(m.reflectance), to_api(m.exitance)});
    return out;
}

std::vector<std::string> Scene::groups() const {
    return {data_->scene->groups().begin(), data_->scene->groups().end()};
}

double Scene::area() const {
    double sum = 0;
    for (const Surface& surface : data_->scene->surfaces()) sum += surface.area;
    return sum;
}

Vec3 Scene::lowest() const {
    return size() > 0 ? to_api(data_->scene->box().lo) : Vec3();
}

Vec3 Scene::highest() const {
    return size() > 0 ? to_api(data_->scene->box().hi) : Vec3();
}

bool Scene::has_light() const {
    return data_->scene->has_light();
}

bool Scene::has_light_groups() const {
    return data_->light_groups;
}

bool Scene::is_photometric() const {
    return data_->scene->is_photometric();
}

const std::vector<Finding>& Scene::findings() const {
    return data_->findings;
}

}  // namespace exitance::api
