#include "exitance/io/scenes/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/photometry/placed_luminaire.hpp"
#include "exitance/io/scenes/cityjson.hpp"
#include "exitance/io/scenes/gltf/gltf.hpp"
#include "exitance/io/scenes/honeybee/honeybee.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/io/scenes/obj/obj.hpp"
#include "exitance/io/scenes/ply.hpp"
#include "exitance/io/scenes/radiance/radiance.hpp"
#include "exitance/io/scenes/stl.hpp"
#include "exitance/io/scenes/view3d.hpp"
#include "exitance/scene/emitter_groups.hpp"
#include "exitance/scene/findings.hpp"
#include "exitance/scene/scene_builder.hpp"

namespace exitance {
namespace {

LoadedScene refused(ErrorCode code, const std::string& path, std::string message, std::string hint) {
    return {{Error{code, message, path, hint}, {{Finding::Kind::error, path, 0, message, hint}}}};
}

/// Makes the error for a scene that consists of panes only, naming the materials that made its faces panes.
Finding only_glass(const ReadScene& read) {
    const std::vector<std::string>& by = read.glazed_by;
    const std::size_t count = read.description.panes.size();
    return {Finding::Kind::error, read.description.file, 0,
            fmt::format("{} pane{} of clear glass{}{}: a scene needs at least one opaque face",
                        count == 1 ? "the only face is a" : fmt::format("all {} faces are", count),
                        count == 1 ? "" : "s", by.empty() ? "" : " by " + by.front(),
                        by.size() > 1 ? fmt::format(" and {} more", by.size() - 1) : ""),
            "make a material opaque (in MTL: 'd 1'), or add faces that light does not pass straight"};
}

/// Combines the findings of the reader and of the scene's checks. A file with errors is still checked completely, but
/// without warnings about light, since unreadable parts may contain the emitters.
CheckedScene checked(ReadScene read, const SceneLines& lines, bool turn_bodies) {
    if (read.description.faces.empty() && !read.description.panes.empty() && !has_errors(read.findings))
        read.findings.push_back(only_glass(read));
    const bool broken = has_errors(read.findings);
    if (broken && read.description.faces.empty()) {
        sort_findings(read.findings);
        Error first = error_of(read.findings);
        return {std::move(first), std::move(read.findings)};
    }
    CheckedScene out = SceneBuilder(std::move(read.description), turn_bodies).build();
    for (Finding& finding : out.findings) lines.place(finding);
    if (!out.scene && has_errors(out.findings)) sort_findings(out.findings), out.scene = error_of(out.findings);
    if (broken) std::erase_if(out.findings, [](const Finding& f) { return f.kind == Finding::Kind::warning; });
    out.findings.insert(out.findings.begin(), read.findings.begin(), read.findings.end());
    sort_findings(out.findings);
    if (broken) out.scene = error_of(out.findings);
    return out;
}

/// Turns repairs into errors.
void refuse_repairs(CheckedScene& scene) {
    for (Finding& finding : scene.findings)
        if (finding.kind == Finding::Kind::repair) finding.kind = Finding::Kind::error;
    sort_findings(scene.findings);
    if (has_errors(scene.findings)) scene.scene = error_of(scene.findings);
}

/// Detects binary glTF under other file names by its first bytes.
bool looks_like_gltf(const std::string& path) {
    char magic[4] = {};
    std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
    return std::string_view(magic, sizeof magic) == "glTF";
}

/// Detects by its first bytes whether a file is something else that was downloaded in place of a scene, and returns its
/// name; nullptr for other files.
const char* stand_in_for_scene(const std::string& path) {
    constexpr std::size_t looked_at = 256;  // bytes; derived from pages of GitHub, which begin with blank lines
    std::string begin(looked_at, ' ');
    std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.erase(0, std::min(begin.find_first_not_of(" \t\r\n"), begin.size()));
    for (char& c : begin) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (begin.starts_with("<!doctype html") || begin.starts_with("<html")) return "a web page";
    if (begin.starts_with("version https://git-lfs")) return "a pointer of Git LFS";
    return nullptr;
}

using Reader = ReadScene (*)(const std::string& path);

ReadScene read_view3d_scene(const std::string& path) {
    return read_view3d(path);
}

/// Reads textured scenes with the default number of parts; read_files() passes the requested one.
ReadScene read_obj_scene(const std::string& path) {
    return read_obj(path);
}
ReadScene read_gltf_scene(const std::string& path) {
    return read_gltf(path);
}

/// Reads dynamic objects in their first state; read_files() passes the chosen ones.
ReadScene read_honeybee_scene(const std::string& path) {
    return read_honeybee(path);
}

/// Reads the highest level of detail; read_files() calls read_cityjson() with the requested one.
ReadScene read_city(const std::string& path) {
    return read_cityjson(path, "");
}

Reader reader_of(const std::string& path) {
    const std::string end = ending(path);
    if (end == ".obj") return read_obj_scene;
    if (end == ".rad") return read_radiance;
    if (end == ".vs3") return read_view3d_scene;
    if (end == ".stl") return read_stl;
    if (end == ".ply") return read_ply;
    if (is_honeybee_file(path)) return read_honeybee_scene;
    if (end == ".json") return read_city;
    if (end == ".gltf" || end == ".glb" || looks_like_gltf(path)) return read_gltf_scene;
    return nullptr;
}

template <class T>
void append(std::vector<T>& all, std::vector<T>& more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Appends the description of one scene to another.
void append(SceneDescription& all, SceneDescription more) {
    const auto size = [](const auto& pool) { return static_cast<std::uint32_t>(pool.size()); };
    const std::uint32_t points = size(all.points), materials = size(all.materials), groups = size(all.groups),
                        profiles = size(all.profiles);
    std::uint32_t wholes = 0;
    for (const SceneDescription::Face& face : all.faces) wholes = std::max(wholes, face.whole);
    for (SceneDescription::Face& face : more.faces) {
        for (std::uint32_t& corner : face.corners) corner += points;
        face.material += materials, face.group += groups;
        if (face.whole > 0) face.whole += wholes;
    }
    for (Material& material : more.materials)
        if (!material.emission.profile.is_none())
            material.emission.profile = ProfileId(material.emission.profile.value + profiles);
    append(all.points, more.points), append(all.materials, more.materials);
    append(all.profiles, more.profiles), append(all.groups, more.groups), append(all.faces, more.faces);
    append(all.lights, more.lights), all.distant.append(more.distant), append(all.panes, more.panes),
        append(all.cameras, more.cameras);
}

int last_line(const SceneDescription& description) {
    int last = 0;
    for (const SceneDescription::Face& face : description.faces) last = std::max(last, face.line);
    return last;
}

/// True for glTF, which defines metres and Y up, and for Honeybee models, which name their unit and have Z up.
bool says_units(Reader reader) {
    return reader == Reader(read_gltf_scene) || reader == Reader(read_honeybee_scene);
}

/// Converts a file without defined units to metres and Z up. Radiances and emission profiles do not depend on the unit
/// of length and are unchanged.
void convert_units(ReadScene& read, const LoadOptions& options) {
    SceneDescription& d = read.description;
    const double scale = options.metres_per_unit.value_or(1);
    const bool turns = options.y_is_up.value_or(false);
    const auto turned = [&](const Vec3& v) { return turns ? Vec3{v.x, -v.z, v.y} : v; };
    const auto place = [&](Point& p) { p = scale * turned(p); };
    std::for_each(d.points.begin(), d.points.end(), place);
    place(read.origin);
    for (Pane& pane : d.panes) {
        std::for_each(pane.corners.begin(), pane.corners.end(), place);
        pane.n = turned(pane.n);
    }
    for (PunctualLight& light : d.lights) place(light.position), light.direction = turned(light.direction);
    for (SceneCamera& camera : d.cameras) {
        place(camera.eye), place(camera.target);
        camera.up = turned(camera.up), camera.width *= scale;
    }
}

/// Returns an error if --length-unit, --up or --lod cannot be used with these files.
std::optional<Error> refuse_options(std::span<const std::string> paths, const LoadOptions& options) {
    const auto all = [&](const auto& is) {
        return std::all_of(paths.begin(), paths.end(), [&](const std::string& p) { return is(reader_of(p)); });
    };
    const char* const given = options.metres_per_unit ? "--length-unit" : "--up";
    if ((options.metres_per_unit || options.y_is_up) && all(says_units))
        return Error{ErrorCode::usage, "these files define their unit and axis themselves", given,
                     "leave the option out; scale or turn a node in the file if it is wrong"};
    const bool has_radiance = !all([](Reader r) { return r != Reader(read_radiance); });
    if (options.y_is_up.value_or(false) && has_radiance)
        return Error{ErrorCode::usage, "Radiance's files have Z up: their skies and suns say where up is", "--up",
                     "turn the geometry with !xform -rx 90"};
    if (!options.lod.empty() && all([](Reader r) { return r != Reader(read_city); }))
        return Error{ErrorCode::usage, "none of the files is CityJSON, which alone has levels of detail", "--lod",
                     "leave the option out"};
    return std::nullopt;
}

/// Reads all files into one scene, except files of unknown formats.
ReadScene read_files(std::span<const std::string> paths, const LoadOptions& options) {
    std::vector<std::string> radiance;
    for (const std::string& path : paths)
        if (reader_of(path) == Reader(read_radiance)) radiance.push_back(path);
    ReadScene all;
    bool is_first = true;
    for (const std::string& path : paths) {
        const Reader read = reader_of(path);
        if (!read || (read == Reader(read_radiance) && path != radiance.front())) continue;
        ReadScene one = read == Reader(read_radiance)         ? read_radiance(radiance, options)
                        : read == Reader(read_city)           ? read_cityjson(path, options.lod)
                        : read == Reader(read_obj_scene)      ? read_obj(path, options.texture_parts)
                        : read == Reader(read_gltf_scene)     ? read_gltf(path, options.texture_parts)
                        : read == Reader(read_honeybee_scene) ? read_honeybee(path, options.honeybee_states)
                                                              : read(path);
        if (!says_units(read)) convert_units(one, options);
        if (one.lines.empty() && paths.size() > 1) one.lines.add(path, last_line(one.description));
        if (is_first) {
            all = std::move(one);
        } else {
            const int before = all.lines.append(one.lines);
            for (SceneDescription::Face& face : one.description.faces)
                if (face.line > 0) face.line += before;
            for (Pane& pane : one.description.panes)
                if (pane.line > 0) pane.line += before;
            all.reflectance_deviation.resize(all.description.materials.size());
            append(all.reflectance_deviation, one.reflectance_deviation);
            append(all.description, std::move(one.description)), append(all.findings, one.findings);
            append(all.luminaires, one.luminaires), append(all.darkening, one.darkening);
            append(all.glazed_by, one.glazed_by), append(all.pane_labels, one.pane_labels);
        }
        is_first = false;
    }
    return all;
}

/// Replaces the distant light of the files by the requested sky. A sky in lumens makes the scene one in lumens.
void give_sky(const ChosenSky& sky, ReadScene& read) {
    SceneDescription& description = read.description;
    if (!description.distant.empty())
        read.findings.push_back({Finding::Kind::warning, description.file, 0,
                                 "the scene has a sky or a sun of its own: --sky replaces it",
                                 "leave out --sky to have the scene's own"});
    const bool photometric = sky.photometric.value_or(description.photometric);
    description.distant = photometric ? sky.in_lumens : sky.in_watts;
    if (!photometric || description.photometric) return;
    if (emits_light(description))
        read.findings.push_back({Finding::Kind::warning, description.file, 0,
                                 "the sky is in lumens: the scene's own light is taken as lumens, too",
                                 "leave out efficacy_direct and efficacy_diffuse to have both in watts"});
    description.photometric = true;
}

/// Adds the luminaires of the scene files and those of the table.
void add_luminaires(ReadScene& read, const LoadOptions& options) {
    std::vector<PlacedLuminaire> all = std::move(read.luminaires);
    if (!options.luminaires.empty()) {
        Result<std::vector<PlacedLuminaire>> table = load_luminaire_table(options.luminaires);
        if (!table) {
            const Error& e = table.error();
            read.findings.push_back({Finding::Kind::error, e.where, 0, e.message, e.hint});
            return;
        }
        append(all, *table);
    }
    add_luminaires(all, options.photometric, read.description, read.findings);
}

/// Returns the panes with their names.
std::vector<NamedPane> named_panes(const ReadScene& read) {
    std::vector<NamedPane> out;
    for (std::size_t i = 0; i < std::min(read.description.panes.size(), read.pane_labels.size()); ++i)
        out.push_back({read.pane_labels[i].material, read.pane_labels[i].object, read.description.panes[i].corners});
    return out;
}

/// Reports repairs that remove light from the scene. Where light is needed, they are errors if nothing emits then,
/// since all results would be 0.
void judge_darkening(ReadScene& read, bool needs_light) {
    const SceneDescription& d = read.description;
    const bool emits = !d.distant.empty() || !d.lights.empty() ||
                       std::any_of(d.materials.begin(), d.materials.end(), [](const Material& m) { return m.emits(); });
    for (Finding& finding : read.darkening) {
        if (!emits && needs_light) {
            finding.kind = Finding::Kind::error;
            finding.message += ", and nothing else emits: all light would be 0";
            finding.hint += ", or give the scene a sky (solve --sky)";
        }
        read.findings.push_back(std::move(finding));
    }
}

}  // namespace

LoadedScene load_scene(std::span<const std::string> paths, const LoadOptions& options) {
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const std::string& path = paths[i];
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored))
            return refused(ErrorCode::cannot_read, path, "there is no such file", "");
        if (path.ends_with(".h5"))
            return refused(ErrorCode::bad_input, path, "is a solution or other HDF5 file, where a scene is required",
                           "give the scene that was solved, such as room.obj; solutions are for view (one at a time), "
                           "render, probe, export, bake, report, glare, compare, mix and stats");
        if (!reader_of(path))
            return refused(ErrorCode::bad_input, path, "this kind of scene file is not known",
                           "known endings: .obj, .gltf, .glb, .rad, .stl, .ply, .vs3, .hbjson, .json");
        if (const char* const found = stand_in_for_scene(path))
            return refused(ErrorCode::bad_input, path, fmt::format("holds {} in place of a scene", found),
                           "download the file itself");
        if (std::find(paths.begin(), paths.begin() + static_cast<std::ptrdiff_t>(i), path) !=
            paths.begin() + static_cast<std::ptrdiff_t>(i))
            return refused(ErrorCode::usage, path, "is named twice", "each file of a scene once");
    }
    if (std::optional<Error> e = refuse_options(paths, options))
        return {{*e, {{Finding::Kind::error, e->where, 0, e->message, e->hint}}}};
    ReadScene read = read_files(paths, options);
    if (options.sky) give_sky(*options.sky, read);
    add_luminaires(read, options);
    judge_darkening(read, options.needs_light);
    if (options.without_panes && !read.description.faces.empty()) read.description.panes.clear();
    if (options.light_groups) part_emitters_by_group(read.description);
    SceneLines lines = std::move(read.lines);
    std::vector<Spectrum> deviation = std::move(read.reflectance_deviation);
    const Point origin = read.origin;
    std::vector<NamedPane> panes = named_panes(read);
    LoadedScene scene{checked(std::move(read), lines, options.turn_bodies), {}};
    scene.lines = std::move(lines), scene.reflectance_deviation = std::move(deviation);
    scene.origin = origin, scene.panes = std::move(panes);
    if (!scene.scene && options.stop && options.stop->requested())
        return refused(ErrorCode::limit, paths.front(), "a stop was requested while the scene was being read", "");
    if (options.faults == Faults::refuse) refuse_repairs(scene);
    return scene;
}

CheckedScene load_scene(const std::string& path, Faults faults) {
    return load_scene(std::span(&path, 1), {.faults = faults});
}

bool say_units(std::span<const std::string> paths) {
    return std::any_of(paths.begin(), paths.end(), [](const std::string& p) { return says_units(reader_of(p)); });
}

SceneDescription read_description(std::span<const std::string> paths, const LoadOptions& options) {
    ReadScene read = read_files(paths, options);
    add_luminaires(read, options);
    return std::move(read.description);
}

}  // namespace exitance
