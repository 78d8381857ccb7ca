#include <algorithm>
#include <cmath>

#include "exitance/io/solution/sky_group.hpp"
#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/io/solution/stored_columns.hpp"
#include "exitance/io/solution/stored_scene_check.hpp"

namespace exitance {
namespace {

/// Lights and views, which few scenes have: without them the file has no sets for them.
void write_lights(Hdf5Writer& file, const std::string& group, const std::vector<PunctualLight>& lights) {
    if (lights.empty()) return;
    const auto in = [&](const char* name) { return group + "/" + name; };
    std::vector<double> cones;
    for (const PunctualLight& l : lights) cones.insert(cones.end(), {l.inner_cone, l.outer_cone});
    file.write_texts(in("light_name"), column<std::string>(lights, [](const PunctualLight& l) { return l.name; }),
                     {"1", "names of the lights without extent"});
    file.write(in("light_kind"),
               column<std::uint8_t>(lights, [](const PunctualLight& l) { return static_cast<std::uint8_t>(l.kind); }),
               1, {"1", "kind of a light: 0 point, 1 spot, 2 parallel"});
    file.write(in("light_position"), flat(column<Point>(lights, [](const PunctualLight& l) { return l.position; })), 3,
               {"m", "place of a light"});
    file.write(in("light_direction"), flat(column<Normal>(lights, [](const PunctualLight& l) { return l.direction; })),
               3, {"1", "direction in which a light goes"});
    file.write(in("light_intensity"), spectra(lights, [](const PunctualLight& l) { return l.intensity; }), bands,
               {"W/sr", "intensity of a light; of parallel light the irradiance across it, W/m^2"});
    file.write(in("light_cone"), cones, 2, {"rad", "half the angles of a spot's inner and outer cone"});
}

void write_cameras(Hdf5Writer& file, const std::string& group, const std::vector<SceneCamera>& cameras) {
    if (cameras.empty()) return;
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.write_texts(in("camera_name"), column<std::string>(cameras, [](const SceneCamera& c) { return c.name; }),
                     {"1", "names of the views that came with the scene"});
    file.write(in("camera_eye"), flat(column<Point>(cameras, [](const SceneCamera& c) { return c.eye; })), 3,
               {"m", "where a camera stands"});
    file.write(in("camera_target"), flat(column<Point>(cameras, [](const SceneCamera& c) { return c.target; })), 3,
               {"m", "where a camera looks"});
    file.write(in("camera_up"), flat(column<Vec3>(cameras, [](const SceneCamera& c) { return c.up; })), 3,
               {"1", "what is upright in a camera's picture"});
    file.write(in("camera_fov"), column<double>(cameras, [](const SceneCamera& c) { return c.fov; }), 1,
               {"degree", "angle from the left to the right edge of a camera's picture"});
    file.write(in("camera_width"), column<double>(cameras, [](const SceneCamera& c) { return c.width; }), 1,
               {"m", "width of an orthographic camera's picture; 0: perspective"});
}

std::vector<PunctualLight> read_lights(Hdf5Reader& file, const std::string& group) {
    if (!file.has(group + "/light_name")) return {};
    Columns in(file, group);
    const std::vector<std::string> names = file.read_texts(group + "/light_name");
    const std::size_t count = names.size();
    const auto kind = in.read<std::uint8_t>("light_kind", 1, count);
    const auto position = in.points("light_position", count);
    const auto direction = in.normals("light_direction", count);
    const auto intensity = in.read<double>("light_intensity", bands, count);
    const auto cone = in.read<double>("light_cone", 2, count);
    for (std::size_t i = 0; i < count && !file.failed(); ++i) {
        if (kind[i] > static_cast<std::uint8_t>(PunctualLight::Kind::directional))
            file.fail(group + "/light_kind", "holds " + std::to_string(kind[i]) + ", which is no kind of light");
        if (!(cone[2 * i] >= 0 && cone[2 * i] < cone[2 * i + 1] && cone[2 * i + 1] <= pi / 2))
            file.fail(group + "/light_cone", "holds cones that no spot has");
    }
    std::vector<PunctualLight> out;
    for (std::size_t i = 0; i < count && !file.failed(); ++i)
        out.push_back({names[i], static_cast<PunctualLight::Kind>(kind[i]), position[i], direction[i],
                       spectrum(intensity, i), cone[2 * i], cone[2 * i + 1]});
    return out;
}

std::vector<SceneCamera> read_cameras(Hdf5Reader& file, const std::string& group) {
    if (!file.has(group + "/camera_name")) return {};
    Columns in(file, group);
    const std::vector<std::string> names = file.read_texts(group + "/camera_name");
    const std::size_t count = names.size();
    const auto eye = in.points("camera_eye", count), target = in.points("camera_target", count);
    const auto up = in.normals("camera_up", count);
    const auto fov = in.read<double>("camera_fov", 1, count), width = in.read<double>("camera_width", 1, count);
    for (std::size_t i = 0; i < count && !file.failed(); ++i)
        if (!(fov[i] > 0 && fov[i] < 180 && width[i] >= 0))
            file.fail(group + "/camera_fov", "holds an angle that no camera has");
    std::vector<SceneCamera> out;
    for (std::size_t i = 0; i < count && !file.failed(); ++i)
        out.push_back({names[i], eye[i], target[i], up[i], fov[i], width[i]});
    return out;
}

}  // namespace

void StoredScene::write(Hdf5Writer& file, const std::string& group, const Scene& scene) {
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.make_group(group);
    file.set_attribute(group, "file", std::string_view(scene.file_));
    file.set_attribute(group, "photometric", static_cast<std::int64_t>(scene.photometric_));
    file.write(in("corner"), flat(scene.corners_), 3, {"m", "corners of the faces, one face after the other"});

    const auto& faces = scene.surfaces_;
    const auto face = [&]<class T>(const char* name, T, auto get, Hdf5Label label) {
        file.write(in(name), column<T>(faces, get), 1, label);
    };
    face("face_corner_count", std::uint32_t(), [](const Surface& s) { return s.corner_count; },
         {"1", "corners of a face"});
    face("face_first_corner", std::uint32_t(), [](const Surface& s) { return s.first_corner; },
         {"1", "row of a face's first corner"});
    face("face_material", std::uint32_t(), [](const Surface& s) { return s.material.value; },
         {"1", "row of a face's material"});
    face("face_group", std::uint32_t(), [](const Surface& s) { return s.group.value; }, {"1", "row of a face's group"});
    face("face_region", std::uint32_t(), [](const Surface& s) { return s.region.value; },
         {"1", "row of a face's region"});
    face("face_line", std::int32_t(), [](const Surface& s) { return s.line; },
         {"1", "line of a face in the scene's file"});
    face("face_area", double(), [](const Surface& s) { return s.area; }, {"m^2", "area of a face"});
    file.write(in("face_normal"), flat(column<Normal>(faces, [](const Surface& s) { return s.normal; })), 3,
               {"1", "unit normal of a face, towards its front"});

    const auto& materials = scene.materials_;
    file.write_texts(in("material_name"), column<std::string>(materials, [](const Material& m) { return m.name; }),
                     {"1", "names of the materials"});
    file.write(in("material_reflectance"), spectra(materials, [](const Material& m) { return m.reflectance; }), bands,
               {"1", "diffuse reflectance"});
    file.write(in("material_exitance"), spectra(materials, [](const Material& m) { return m.exitance; }), bands,
               {"W/m^2", "emitted exitance"});
    if (scene.has_diffusing_panes())
        file.write(in("material_through"), column<double>(materials, [](const Material& m) { return m.through; }), 1,
                   {"1", "share of what leaves a surface again that leaves by its other side"});
    file.write_texts(in("group_name"), {scene.groups_.begin(), scene.groups_.end()}, {"1", "names of the groups"});

    const auto& regions = scene.regions_;
    std::vector<std::uint32_t> members, loop_corners;
    std::vector<Point> loop_points;
    std::vector<double> planes;
    for (const Region& r : regions) {
        for (SurfaceId s : r.surfaces) members.push_back(s.value);
        for (const auto& loop : r.loops) {
            loop_corners.push_back(static_cast<std::uint32_t>(loop.size()));
            loop_points.insert(loop_points.end(), loop.begin(), loop.end());
        }
        planes.insert(planes.end(), {r.plane.n.x, r.plane.n.y, r.plane.n.z, r.plane.offset});
    }
    const auto region = [&]<class T>(const char* name, T, auto get, Hdf5Label label) {
        file.write(in(name), column<T>(regions, get), 1, label);
    };
    region("region_material", std::uint32_t(), [](const Region& r) { return r.material.value; },
           {"1", "row of a region's material"});
    region("region_area", double(), [](const Region& r) { return r.area; }, {"m^2", "area of a region"});
    region("region_face_count", std::uint32_t(), [](const Region& r) { return r.surfaces.size(); },
           {"1", "faces of a region"});
    region("region_loop_count", std::uint32_t(), [](const Region& r) { return r.loops.size(); },
           {"1", "border loops of a region"});
    if (std::any_of(regions.begin(), regions.end(), [](const Region& r) { return r.level > 0; }))
        region("region_level", std::uint8_t(), [](const Region& r) { return r.level; },
               {"1", "regions of the same plane that lie under parts of a region, one on another"});
    if (scene.has_diffusing_panes())
        region("region_behind", std::uint32_t(), [](const Region& r) { return r.behind.value; },
               {"1", "row of the region on a diffusing pane's other side; 4294967295: none"});
    file.write(in("region_plane"), planes, 4, {"1", "plane of a region: unit normal n, and n . x in metres"});
    file.write(in("region_face"), members, 1, {"1", "faces of the regions, one region after the other"});
    file.write(in("loop_corner_count"), loop_corners, 1, {"1", "corners of a border loop"});
    file.write(in("loop_corner"), flat(loop_points), 3, {"m", "corners of the border loops, one loop after the other"});
    file.write(in("emitter"), column<std::uint32_t>(scene.emitters_, [](SurfaceId s) { return s.value; }), 1,
               {"1", "faces that emit"});
    file.write(in("box"), flat({scene.box_.lo, scene.box_.hi}), 3, {"m", "lower and upper corner of the scene's box"});
    write_emission(file, group, scene.materials_, scene.profiles_);
    write_lights(file, group, scene.lights_);
    write_sky(file, group, scene.distant_);
    write_panes(file, group, scene.panes_);
    write_cameras(file, group, scene.cameras_);
}

Scene StoredScene::read(Hdf5Reader& file, const std::string& group) {
    Columns in(file, group);
    Scene scene;
    scene.file_ = file.text_attribute(group, "file").value_or("");
    scene.photometric_ = file.integer_attribute(group, "photometric").value_or(0) != 0;
    scene.corners_ = in.points("corner");

    const std::vector<std::string> material_names = file.read_texts(group + "/material_name");
    const std::size_t material_count = material_names.size();
    const auto reflectance = in.read<double>("material_reflectance", bands, material_count);
    const auto exitance = in.read<double>("material_exitance", bands, material_count);
    const std::vector<std::string> group_names = file.read_texts(group + "/group_name");

    const auto corner_count = in.read<std::uint32_t>("face_corner_count");
    const std::size_t face_count = corner_count.size();
    const auto first_corner = in.read<std::uint32_t>("face_first_corner", 1, face_count);
    const auto material = in.indices("face_material", material_count, face_count);
    const auto group_of = in.indices("face_group", group_names.size(), face_count);
    const auto line = in.read<std::int32_t>("face_line", 1, face_count);
    const auto area = in.read<double>("face_area", 1, face_count);
    const auto normal = in.normals("face_normal", face_count);

    const auto region_area = in.read<double>("region_area");
    const std::size_t region_count = region_area.size();
    const auto region_of = in.indices("face_region", region_count, face_count);
    const auto region_material = in.indices("region_material", material_count, region_count);
    const auto plane = in.read<double>("region_plane", 4, region_count);
    std::vector<std::uint8_t> level(region_count);
    if (file.has(group + "/region_level")) level = in.read<std::uint8_t>("region_level", 1, region_count);
    std::vector<double> through(material_count);
    if (file.has(group + "/material_through")) through = in.read<double>("material_through", 1, material_count);
    std::vector<std::uint32_t> behind(region_count, RegionId::none_value);
    if (file.has(group + "/region_behind")) behind = in.read<std::uint32_t>("region_behind", 1, region_count);
    const auto members = in.indices("region_face", face_count);
    const auto member_count = in.counts("region_face_count", 1, members.size(), region_count);
    const auto loop_points = in.points("loop_corner");
    const auto loop_corners = in.counts("loop_corner_count", 3, loop_points.size());
    const auto loop_count = in.counts("region_loop_count", 1, loop_corners.size(), region_count);
    const auto emitters = in.indices("emitter", face_count);
    const auto box = in.points("box", 2);
    scene.profiles_ = read_profiles(file, group);
    const std::vector<DirectedEmission> emission = read_emission(file, group, material_count, scene.profiles_.size());
    scene.lights_ = read_lights(file, group);
    scene.distant_ = read_sky(file, group);
    scene.panes_ = read_panes(file, group);
    scene.cameras_ = read_cameras(file, group);
    for (std::size_t i = 0; i < face_count && !file.failed(); ++i)
        if (corner_count[i] < 3 || corner_count[i] > scene.corners_.size() ||
            first_corner[i] > scene.corners_.size() - corner_count[i])
            file.fail(group + "/face_corner_count", "names corners that are not there, at face " + std::to_string(i));
    for (std::size_t i = 0; i < material_count && !file.failed(); ++i)
        if (!(through[i] >= 0 && through[i] <= 1)) file.fail(group + "/material_through", "holds what is no share");
    for (std::size_t i = 0; i < region_count && !file.failed(); ++i)
        if (behind[i] != RegionId::none_value && (behind[i] >= region_count || behind[behind[i]] != i))
            file.fail(group + "/region_behind", "holds sides that do not belong together");
    if (file.failed()) return {};

    for (std::size_t i = 0; i < material_count; ++i)
        scene.materials_.add(
            {material_names[i], spectrum(reflectance, i), spectrum(exitance, i), emission[i], through[i]});
    for (const std::string& name : group_names) scene.groups_.add(name);
    for (std::size_t i = 0; i < face_count; ++i)
        scene.surfaces_.add({first_corner[i], corner_count[i], MaterialId(material[i]), GroupId(group_of[i]),
                             RegionId(region_of[i]), line[i], normal[i], area[i]});
    std::size_t member = 0, loop = 0, point = 0;
    for (std::size_t i = 0; i < region_count; ++i) {
        Region region = {MaterialId(region_material[i]),
                         {{plane[4 * i], plane[4 * i + 1], plane[4 * i + 2]}, plane[4 * i + 3]},
                         region_area[i],
                         {},
                         {}};
        for (std::uint32_t k = 0; k < member_count[i]; ++k) region.surfaces.emplace_back(members[member++]);
        for (std::uint32_t k = 0; k < loop_count[i]; ++k) {
            const auto first = loop_points.begin() + static_cast<std::ptrdiff_t>(point);
            region.loops.emplace_back(first, first + loop_corners[loop]);
            point += loop_corners[loop++];
        }
        region.level = std::min(level[i], most_stacked);
        if (behind[i] != RegionId::none_value) region.behind = RegionId(behind[i]);
        scene.regions_.add(std::move(region));
    }
    for (std::uint32_t s : emitters) scene.emitters_.emplace_back(s);
    scene.box_.lo = box[0], scene.box_.hi = box[1];
    if (const std::optional<std::string> wrong = find_nonsense(scene))
        return file.fail(group + "/corner", "and the sets beside it make no scene: " + *wrong), Scene();
    return scene;
}

}  // namespace exitance
