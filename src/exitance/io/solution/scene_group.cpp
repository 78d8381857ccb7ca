#include <algorithm>

#include "exitance/io/solution/sky_group.hpp"
#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/io/solution/stored_columns.hpp"
#include "exitance/io/solution/stored_scene_check.hpp"
#include "exitance/io/solution/vertex_table.hpp"

namespace exitance {
namespace {

/// Writes lights and views. Few scenes have any; without them the data sets are omitted.
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
            file.fail(group + "/light_kind", "holds " + std::to_string(kind[i]) + ", which is not a kind of light");
        if (!(cone[2 * i] >= 0 && cone[2 * i] < cone[2 * i + 1] && cone[2 * i + 1] <= pi / 2))
            file.fail(group + "/light_cone", "holds cone angles that are not valid for a spotlight");
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
            file.fail(group + "/camera_fov", "holds an angle that is not valid for a camera");
    std::vector<SceneCamera> out;
    for (std::size_t i = 0; i < count && !file.failed(); ++i)
        out.push_back({names[i], eye[i], target[i], up[i], fov[i], width[i]});
    return out;
}

/// Writes columns of a pool, named by their content.
template <class Pool>
class PoolWriter {
  public:
    PoolWriter(Hdf5Writer& file, const std::string& group, const Pool& pool)
        : file_(file), group_(group), pool_(pool) {}

    template <class T, class Get>
    void write(const char* name, const Get& get, const Hdf5Label& label) {
        file_.write(group_ + "/" + name, column<T>(pool_, get), 1, label);
    }

  private:
    Hdf5Writer& file_;
    const std::string& group_;
    const Pool& pool_;
};

void write_faces(Hdf5Writer& file, const std::string& group, const Field<SurfaceId, Surface>& faces) {
    PoolWriter face(file, group, faces);
    face.write<std::uint32_t>("face_corner_count", [](const Surface& s) { return s.corner_count; },
                              {"1", "corners of a face"});
    face.write<std::uint32_t>("face_first_corner", [](const Surface& s) { return s.first_corner; },
                              {"1", "row of a face's first corner"});
    face.write<std::uint32_t>("face_material", [](const Surface& s) { return s.material.value; },
                              {"1", "row of a face's material"});
    face.write<std::uint32_t>("face_group", [](const Surface& s) { return s.group.value; },
                              {"1", "row of a face's group"});
    face.write<std::uint32_t>("face_region", [](const Surface& s) { return s.region.value; },
                              {"1", "row of a face's region"});
    face.write<std::int32_t>("face_line", [](const Surface& s) { return s.line; },
                             {"1", "line of a face in the scene's file"});
    if (std::any_of(faces.begin(), faces.end(), [](const Surface& s) { return s.whole > 0; }))
        face.write<std::uint32_t>("face_whole", [](const Surface& s) { return s.whole; },
                                  {"1", "number shared by the parts of a textured face; 0: not a part"});
    face.write<double>("face_area", [](const Surface& s) { return s.area; }, {"m^2", "area of a face"});
}

void write_materials(Hdf5Writer& file, const std::string& group, const Scene& scene) {
    const auto& materials = scene.materials();
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.write_texts(in("material_name"), column<std::string>(materials, [](const Material& m) { return m.name; }),
                     {"1", "names of the materials"});
    file.write(in("material_reflectance"), spectra(materials, [](const Material& m) { return m.reflectance; }), bands,
               {"1", "diffuse reflectance"});
    file.write(in("material_exitance"), spectra(materials, [](const Material& m) { return m.exitance; }), bands,
               {"W/m^2", "emitted exitance"});
    if (scene.has_diffusing_panes())
        file.write(in("material_through"), column<double>(materials, [](const Material& m) { return m.through; }), 1,
                   {"1", "share of what leaves a surface again that leaves by its other side"});
}

/// `vertices`: gets the corners of the borders.
void write_regions(Hdf5Writer& file, const std::string& group, const Scene& scene, VertexTable& vertices) {
    const auto& regions = scene.regions();
    const auto in = [&](const char* name) { return group + "/" + name; };
    std::vector<std::uint32_t> members, loop_corners, loop_vertices;
    std::vector<double> planes;
    for (const Region& r : regions) {
        for (SurfaceId s : r.surfaces) members.push_back(s.value);
        for (const auto& loop : r.loops) {
            loop_corners.push_back(static_cast<std::uint32_t>(loop.size()));
            for (const Point& p : loop) loop_vertices.push_back(vertices.add(p));
        }
        planes.insert(planes.end(), {r.plane.n.x, r.plane.n.y, r.plane.n.z, r.plane.offset});
    }
    PoolWriter region(file, group, regions);
    region.write<std::uint32_t>("region_material", [](const Region& r) { return r.material.value; },
                                {"1", "row of a region's material"});
    region.write<double>("region_area", [](const Region& r) { return r.area; }, {"m^2", "area of a region"});
    region.write<std::uint32_t>("region_face_count", [](const Region& r) { return r.surfaces.size(); },
                                {"1", "faces of a region"});
    region.write<std::uint32_t>("region_loop_count", [](const Region& r) { return r.loops.size(); },
                                {"1", "border loops of a region"});
    if (std::any_of(regions.begin(), regions.end(), [](const Region& r) { return r.level > 0; }))
        region.write<std::uint8_t>("region_level", [](const Region& r) { return r.level; },
                                   {"1", "regions of the same plane that lie under parts of a region, one on another"});
    if (scene.has_diffusing_panes())
        region.write<std::uint32_t>("region_behind", [](const Region& r) { return r.behind.value; },
                                    {"1", "row of the region on a diffusing pane's other side; 4294967295: none"});
    file.write(in("region_plane"), planes, 4, {"1", "plane of a region: unit normal n, and n . x in metres"});
    file.write(in("region_face"), members, 1, {"1", "faces of the regions, one region after the other"});
    file.write(in("loop_corner_count"), loop_corners, 1, {"1", "corners of a border loop"});
    file.write(in("loop_vertex"), loop_vertices, 1,
               {"1", "row of `vertex` of each corner of the border loops, one loop after the other"});
}

/// Reads points that are stored as rows of `vertex`, or, in formats 1 and 2, one by one under a name of their own.
std::vector<Point> read_corners(Hdf5Reader& file, const std::string& group, Columns& in, const char* rows,
                                const char* in_old_formats, const std::vector<Point>& vertices) {
    if (!file.has(group + "/" + rows)) return in.points(in_old_formats);
    std::vector<Point> out;
    for (const std::uint32_t vertex : in.indices(rows, vertices.size())) out.push_back(vertices[vertex]);
    return out;
}

/// Columns of the materials.
struct MaterialColumns {
    std::vector<std::string> name;
    std::vector<double> reflectance, exitance, through;

    MaterialColumns(Hdf5Reader& file, const std::string& group, Columns& in)
        : name(file.read_texts(group + "/material_name")),
          reflectance(in.read<double>("material_reflectance", bands, name.size())),
          exitance(in.read<double>("material_exitance", bands, name.size())),
          through(name.size()) {
        if (file.has(group + "/material_through")) through = in.read<double>("material_through", 1, name.size());
        for (const double share : through)
            if (!file.failed() && !(share >= 0 && share <= 1))
                file.fail(group + "/material_through", "holds a value that is not between 0 and 1");
    }
};

/// Columns of the faces, except their regions.
struct FaceColumns {
    std::vector<std::uint32_t> corner_count, first_corner, material, group;
    std::vector<std::int32_t> line;
    std::vector<double> area;
    std::vector<std::uint32_t> whole;

    FaceColumns(Hdf5Reader& file, const std::string& in_group, Columns& in, std::size_t materials, std::size_t groups)
        : corner_count(in.read<std::uint32_t>("face_corner_count")),
          first_corner(in.read<std::uint32_t>("face_first_corner", 1, size())),
          material(in.indices("face_material", materials, size())),
          group(in.indices("face_group", groups, size())),
          line(in.read<std::int32_t>("face_line", 1, size())),
          area(in.read<double>("face_area", 1, size())),
          whole(size()) {
        if (file.has(in_group + "/face_whole")) whole = in.read<std::uint32_t>("face_whole", 1, size());
    }

    std::size_t size() const { return corner_count.size(); }

    void check_corners(Hdf5Reader& file, const std::string& in_group, std::size_t corners) const {
        for (std::size_t i = 0; i < size() && !file.failed(); ++i)
            if (corner_count[i] < 3 || corner_count[i] > corners || first_corner[i] > corners - corner_count[i])
                file.fail(in_group + "/face_corner_count",
                          "refers to corners that do not exist, at face " + std::to_string(i));
    }
};

/// Columns of the regions, and the region of each face.
struct RegionColumns {
    std::vector<double> area;
    std::vector<std::uint32_t> of_face, material;
    std::vector<double> plane;
    std::vector<std::uint8_t> level;
    std::vector<std::uint32_t> behind, members, member_count;
    std::vector<Point> loop_points;
    std::vector<std::uint32_t> loop_corners, loop_count;

    RegionColumns(Hdf5Reader& file, const std::string& group, Columns& in, std::size_t faces, std::size_t materials,
                  const std::vector<Point>& vertices)
        : area(in.read<double>("region_area")),
          of_face(in.indices("face_region", size(), faces)),
          material(in.indices("region_material", materials, size())),
          plane(in.read<double>("region_plane", 4, size())),
          level(size()),
          behind(size(), RegionId::none_value) {
        if (file.has(group + "/region_level")) level = in.read<std::uint8_t>("region_level", 1, size());
        if (file.has(group + "/region_behind")) behind = in.read<std::uint32_t>("region_behind", 1, size());
        members = in.indices("region_face", faces);
        member_count = in.counts("region_face_count", 1, members.size(), size());
        loop_points = read_corners(file, group, in, "loop_vertex", "loop_corner", vertices);
        loop_corners = in.counts("loop_corner_count", 3, loop_points.size());
        loop_count = in.counts("region_loop_count", 1, loop_corners.size(), size());
        for (std::size_t i = 0; i < size() && !file.failed(); ++i)
            if (behind[i] != RegionId::none_value && (behind[i] >= size() || behind[behind[i]] != i))
                file.fail(group + "/region_behind", "pairs sides of different panes");
    }

    std::size_t size() const { return area.size(); }

    /// Returns the normal of a region, which is also that of its faces.
    Normal normal(std::uint32_t region) const {
        return {plane[4 * region], plane[4 * region + 1], plane[4 * region + 2]};
    }

    Field<RegionId, Region> regions() const {
        Field<RegionId, Region> out;
        std::size_t member = 0, loop = 0, point = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            Region region = {
                MaterialId(material[i]), {normal(static_cast<std::uint32_t>(i)), plane[4 * i + 3]}, area[i], {}, {}};
            for (std::uint32_t k = 0; k < member_count[i]; ++k) region.surfaces.emplace_back(members[member++]);
            for (std::uint32_t k = 0; k < loop_count[i]; ++k) {
                const auto first = loop_points.begin() + static_cast<std::ptrdiff_t>(point);
                region.loops.emplace_back(first, first + loop_corners[loop]);
                point += loop_corners[loop++];
            }
            region.level = std::min(level[i], max_stacked);
            if (behind[i] != RegionId::none_value) region.behind = RegionId(behind[i]);
            out.add(std::move(region));
        }
        return out;
    }
};

}  // namespace

void StoredScene::write(Hdf5Writer& file, const std::string& group, const Scene& scene) {
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.make_group(group);
    file.set_attribute(group, "file", std::string_view(scene.file_));
    file.set_attribute(group, "photometric", static_cast<std::int64_t>(scene.photometric_));
    VertexTable vertices;
    file.write(in("corner_vertex"),
               column<std::uint32_t>(scene.corners_, [&](const Point& p) { return vertices.add(p); }), 1,
               {"1", "row of `vertex` of each corner of the faces, one face after the other"});
    write_faces(file, group, scene.surfaces_);
    write_materials(file, group, scene);
    file.write_texts(in("group_name"), {scene.groups_.begin(), scene.groups_.end()}, {"1", "names of the groups"});
    write_regions(file, group, scene, vertices);
    file.write(in("vertex"), flat(vertices.points()), 3, {"m", "corners of faces and of borders, each once"});
    file.write(in("emitter"), column<std::uint32_t>(scene.emitters_, [](SurfaceId s) { return s.value; }), 1,
               {"1", "faces that emit"});
    file.write(in("box"), flat({scene.box_.lo, scene.box_.hi}), 3, {"m", "lower and upper corner of the scene's box"});
    write_emission(file, group, scene.materials_, scene.profiles_);
    write_lights(file, group, scene.lights_);
    write_sky(file, group, scene.distant_);
    write_panes(file, group, scene.panes_);
    write_cameras(file, group, scene.cameras_);
    write_luminaires(file, group, scene.luminaire_types_, scene.luminaires_);
}

Scene StoredScene::read(Hdf5Reader& file, const std::string& group) {
    Columns in(file, group);
    Scene scene;
    scene.file_ = file.text_attribute(group, "file").value_or("");
    scene.photometric_ = file.integer_attribute(group, "photometric").value_or(0) != 0;
    const std::vector<Point> vertices = file.has(group + "/vertex") ? in.points("vertex") : std::vector<Point>();
    scene.corners_ = read_corners(file, group, in, "corner_vertex", "corner", vertices);
    const MaterialColumns materials(file, group, in);
    const std::vector<std::string> group_names = file.read_texts(group + "/group_name");
    const FaceColumns faces(file, group, in, materials.name.size(), group_names.size());
    const RegionColumns regions(file, group, in, faces.size(), materials.name.size(), vertices);
    const auto emitters = in.indices("emitter", faces.size());
    const auto box = in.points("box", 2);
    scene.profiles_ = read_profiles(file, group);
    const std::vector<DirectedEmission> emission =
        read_emission(file, group, materials.name.size(), scene.profiles_.size());
    scene.lights_ = read_lights(file, group);
    scene.distant_ = read_sky(file, group);
    scene.panes_ = read_panes(file, group);
    scene.cameras_ = read_cameras(file, group);
    scene.luminaire_types_ = read_luminaire_types(file, group);
    scene.luminaires_ = read_luminaires(file, group, scene.luminaire_types_.size(), group_names.size());
    faces.check_corners(file, group, scene.corners_.size());
    if (file.failed()) return {};

    for (std::size_t i = 0; i < materials.name.size(); ++i)
        scene.materials_.add({materials.name[i], spectrum(materials.reflectance, i), spectrum(materials.exitance, i),
                              emission[i], materials.through[i]});
    for (const std::string& name : group_names) scene.groups_.add(name);
    for (std::size_t i = 0; i < faces.size(); ++i)
        scene.surfaces_.add({faces.first_corner[i], faces.corner_count[i], MaterialId(faces.material[i]),
                             GroupId(faces.group[i]), RegionId(regions.of_face[i]), faces.line[i],
                             regions.normal(regions.of_face[i]), faces.area[i], faces.whole[i]});
    scene.regions_ = regions.regions();
    for (std::uint32_t s : emitters) scene.emitters_.emplace_back(s);
    scene.box_.lo = box[0], scene.box_.hi = box[1];
    if (const std::optional<std::string> wrong = find_nonsense(scene))
        return file.fail(group + "/vertex", "and related data sets do not form a valid scene: " + *wrong), Scene();
    return scene;
}

}  // namespace exitance
