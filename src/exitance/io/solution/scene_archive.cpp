#include "exitance/base/archive.hpp"
#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/scene/sky/sky_picture.hpp"

namespace exitance {
namespace {

template <class Archive, class Things>
void archive_each(Archive& a, Things& things) {
    things.resize(archive_size(a, things.size(), 1));
    for (auto& thing : things) a(thing);
}

}  // namespace

// Serialization of the parts of a scene that are not plain values. Bindings name every member, so that none is
// forgotten.

template <class Archive>
void archive(Archive& a, Material& m) {
    auto& [name, reflectance, exitance, emission, through] = m;
    a(name, reflectance, exitance, emission, through);
}

template <class Archive>
void archive(Archive& a, EmissionProfile::Axis& axis) {
    a(axis.angle, axis.offset, axis.at);
}

template <class Archive>
void archive(Archive& a, EmissionProfile& p) {
    a(p.axes[0], p.axes[1], p.values, p.body, p.size, p.smooth_width);
}

template <class Archive>
void archive(Archive& a, Region& r) {
    auto& [material, plane, area, surfaces, loops, level, behind] = r;
    a(material, plane, area, surfaces, loops, level, behind);
}

template <class Archive>
void archive(Archive& a, PunctualLight& l) {
    a(l.name, l.kind, l.position, l.direction, l.intensity, l.inner_cone, l.outer_cone);
}

template <class Archive>
void archive(Archive& a, Pane& p) {
    a(p.corners, p.n, p.transmissivity, p.index, p.line);
}

template <class Archive>
void archive(Archive& a, DistantLight::Dome& dome) {
    SkyModel& m = dome.model;
    a(m.a, m.b, m.g, m.f0, m.c, m.d, m.e, m.sun, m.intermediate, m.ground, m.blends_ground, m.below, m.scale);
    std::vector<double> picture;
    if (m.picture) picture.assign(m.picture->values().begin(), m.picture->values().end());
    a(picture, dome.irradiance);
    if constexpr (Archive::reads)
        if (picture.size() == SkyPicture::size) m.picture = std::make_shared<const SkyPicture>(std::move(picture));
}

template <class Archive>
void archive(Archive& a, SceneCamera& c) {
    a(c.name, c.eye, c.target, c.up, c.fov, c.width);
}

template <class Archive>
void archive(Archive& a, LuminaireType& t) {
    a(t.name, t.file, t.flux, t.watts, t.curves.c0, t.curves.c90, t.curves.is_per_kilolumen);
}

template <class Archive>
void StoredScene::archive_all(Archive& a, Scene& s) {
    a(s.file_, s.surfaces_, s.corners_, s.emitters_, s.photometric_, s.box_);
    archive_each(a, s.materials_), archive_each(a, s.profiles_), archive_each(a, s.groups_);
    archive_each(a, s.regions_);
    // The facets of a sky are computed on demand and refer to its domes, so they are not stored.
    a(s.lights_, s.distant_.domes, s.distant_.discs, s.panes_, s.cameras_);
    archive_each(a, s.luminaire_types_), a(s.luminaires_);
}

std::string StoredScene::bytes_of(const Scene& scene) {
    ArchiveWriter writer;
    archive_all(writer, const_cast<Scene&>(scene));  // writing does not change the scene
    return writer.take();
}

Result<Scene> StoredScene::from_bytes(std::string_view bytes) {
    ArchiveReader reader(bytes);
    Scene scene;
    archive_all(reader, scene);
    if (!reader.good() || reader.left() != 0)
        return Error{ErrorCode::failure, "was not received completely from the process that read it", "the scene", ""};
    return scene;
}

}  // namespace exitance
