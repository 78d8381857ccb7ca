#include "exitance/io/scenes/obj/obj.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <unordered_map>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/obj/mtl.hpp"
#include "exitance/io/scenes/textures/textured_faces.hpp"
#include "exitance/scene/findings.hpp"

namespace exitance {
namespace {

constexpr const char* default_material = "default";
constexpr long long max_points = 0xfffffffe;

class ObjReader {
  public:
    ObjReader(const std::string& path, std::string_view text, std::optional<std::size_t> texture_parts = {})
        : path_(path), lines_(text), texture_parts_(texture_parts) {
        out_.description.file = path;
    }
    ReadScene read();
    std::vector<ObjPlaces> read_places();

  private:
    void parse();
    void read_point();
    void read_place();
    void read_normal();
    void read_face();
    static void add_index(std::string_view corner, int number, std::size_t count, std::vector<std::uint32_t>& out);
    void read_libraries();
    void read_library(std::string_view name);
    void use_material(std::string_view name);
    void use_group(std::string_view name);
    void check_indices();
    void resolve_materials();
    void take_panes();
    void take_textures();
    std::vector<Vec2> places_of(std::size_t face) const;
    std::vector<Vec3> normals_of(std::size_t face) const;

    void find(Finding::Kind kind, int line, std::string message, std::string hint = "") {
        out_.findings.push_back({kind, path_, line, std::move(message), std::move(hint)});
    }
    void error(std::string message, std::string hint = "") {
        find(Finding::Kind::error, lines_.number(), std::move(message), std::move(hint));
    }

    /// A material name in 'usemtl'. It is resolved after all libraries have been read.
    struct Use {
        std::string name;
        int line;
    };

    const std::string& path_;
    TextLines lines_;
    std::optional<std::size_t> texture_parts_;
    ReadScene out_;
    std::vector<Use> uses_;
    std::unordered_map<std::string, std::uint32_t> use_of_, group_of_;
    std::uint32_t use_ = 0, group_ = 0;
    bool has_use_ = false, has_group_ = false, library_missing_ = false, has_library_ = false;
    MtlExtras extras_;
    std::vector<std::uint32_t> broken_;  ///< Points that could not be read, in ascending order.
    std::vector<Vec2> places_;           ///< Texture coordinates (vt lines), with (0, 0) at the picture's upper left.
    /// Per face, the texture coordinates of its corners; empty if it has none.
    std::vector<std::vector<std::uint32_t>> places_of_face_;
    bool with_normals_ = false;
    std::vector<Vec3> normals_;  ///< Normals (vn lines), if `with_normals_`.
    std::vector<std::vector<std::uint32_t>>
        normals_of_face_;  ///< Per face, the normals of its corners; empty unless `with_normals_`.
};

void ObjReader::parse() {
    while (lines_.next()) {
        const std::string_view key = lines_.word();
        if (key == "v")
            read_point();
        else if (key == "vt")
            read_place();
        else if (key == "vn" && with_normals_)
            read_normal();
        else if (key == "f" || key == "fo")
            read_face();
        else if (key == "usemtl")
            use_material(lines_.rest());
        else if (key == "g" || key == "o")
            use_group(lines_.rest());
        else if (key == "mtllib")
            read_libraries();
    }
    check_indices();
}

ReadScene ObjReader::read() {
    parse();
    resolve_materials();
    return std::move(out_);
}

std::vector<ObjPlaces> ObjReader::read_places() {
    with_normals_ = true;
    parse();
    std::vector<ObjPlaces> out;
    for (std::size_t f = 0; f < out_.description.faces.size(); ++f) {
        ObjPlaces& face = out.emplace_back();
        face.line = out_.description.faces[f].line;
        for (const std::uint32_t c : out_.description.faces[f].corners)
            face.corners.push_back(out_.description.points[c]);
        face.places = places_of(f);
        face.normals = normals_of(f);
    }
    return out;
}

void ObjReader::read_point() {
    auto& points = out_.description.points;
    Point p;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string_view word = lines_.word();
        const NumberKind kind = number_of_word(word, p[i]);
        if (kind == NumberKind::finite) continue;
        if (word.empty())
            error(fmt::format("vertex has {} coordinates, not three", i));
        else
            error(fmt::format("coordinate '{}' is not a {}number", shown(word),
                              kind == NumberKind::not_finite ? "finite " : ""),
                  word.find(',') != word.npos ? "write decimals with a point" : "");
        broken_.push_back(static_cast<std::uint32_t>(points.size()));
        p = {};
        break;
    }
    points.push_back(p);
}

/// Reads a texture coordinate. An unreadable one becomes NaN, and faces that use it show the whole picture.
void ObjReader::read_place() {
    Vec2 place;
    const bool is_place = number_of_word(lines_.word(), place.x) == NumberKind::finite;
    if (const std::string_view word = lines_.word(); !word.empty() && is_place) number_of_word(word, place.y);
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    places_.push_back(is_place ? Vec2{place.x, 1 - place.y} : Vec2{none, none});
}

/// Reads a normal. An unreadable one becomes NaN, and faces that use it have none.
void ObjReader::read_normal() {
    Vec3& n = normals_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
        if (number_of_word(lines_.word(), n[k]) != NumberKind::finite) n.x = std::numeric_limits<double>::quiet_NaN();
}

void ObjReader::read_face() {
    auto& description = out_.description;
    SceneDescription::Face face;
    face.line = lines_.number();
    face.corners.reserve(4);
    std::vector<std::uint32_t> places, normals;
    while (!lines_.rest().empty()) {
        const std::string_view word = lines_.word();
        const auto index = parse_integer(word.substr(0, word.find('/')));
        const auto count = static_cast<long long>(description.points.size());
        if (!index) return error(fmt::format("face names '{}', which is not a vertex number", shown(word)));
        if (*index == 0) return error("face names vertex 0", "vertices are numbered from 1");
        if (*index < -count)
            return error(fmt::format("face names vertex {}, but only {} vertices are above it", *index, count));
        if (*index > max_points) return error(fmt::format("face names vertex {}, a number that is too large", *index));
        face.corners.push_back(static_cast<std::uint32_t>(*index > 0 ? *index - 1 : count + *index));
        add_index(word, 1, places_.size(), places);
        if (with_normals_) add_index(word, 2, normals_.size(), normals);
    }
    if (!has_use_) {
        use_material(default_material);
        find(Finding::Kind::warning, face.line,
             fmt::format("face comes before any 'usemtl': it gets the material '{}', with reflectance 0.5",
                         default_material),
             "name a material with 'usemtl'");
    }
    if (!has_group_) use_group("");
    face.material = use_, face.group = group_;
    if (places.size() != face.corners.size()) places.clear();
    if (normals.size() != face.corners.size()) normals.clear();
    description.faces.push_back(std::move(face));
    places_of_face_.push_back(std::move(places));
    if (with_normals_) normals_of_face_.push_back(std::move(normals));
}

/// Reads the texture coordinate or the normal of a corner, number 1 or 2 of "0/1/2", an index into `size` items.
void ObjReader::add_index(std::string_view corner, int number, std::size_t size, std::vector<std::uint32_t>& out) {
    for (; number > 0; --number) {
        const std::size_t slash = corner.find('/');
        if (slash == corner.npos) return;
        corner.remove_prefix(slash + 1);
    }
    const auto index = parse_integer(corner.substr(0, corner.find('/')));
    const auto count = static_cast<long long>(size);
    if (!index || *index == 0 || *index < -count || *index > max_points) return;
    out.push_back(static_cast<std::uint32_t>(*index > 0 ? *index - 1 : count + *index));
}

/// Reads libraries whose names are separated by blanks, or a single one whose name contains blanks.
void ObjReader::read_libraries() {
    std::error_code ignored;
    if (lines_.rest().empty()) return error("'mtllib' without a file name");
    if (std::filesystem::exists(beside(path_, lines_.rest()), ignored)) return read_library(lines_.rest());
    while (!lines_.rest().empty()) read_library(lines_.word());
}

void ObjReader::read_library(std::string_view name) {
    const std::string file = found_beside(path_, name);
    const Result<std::string> text = read_whole_file(file);
    if (text) {
        has_library_ = true;
        return parse_mtl(*text, file, out_.description.materials, out_.findings, extras_);
    }
    out_.darkening.push_back({Finding::Kind::repair, path_, lines_.number(),
                              fmt::format("material file '{}' {}: its materials reflect 0.5 and emit nothing",
                                          shown(name), text.error().message),
                              "put it in the folder of the scene file"});
    library_missing_ = true;
}

void ObjReader::use_material(std::string_view name) {
    if (name.empty()) return error("'usemtl' without a name");
    const auto [use, is_new] = use_of_.try_emplace(std::string(name), static_cast<std::uint32_t>(uses_.size()));
    if (is_new) uses_.push_back({std::string(name), lines_.number()});
    use_ = use->second;
    has_use_ = true;
}

void ObjReader::use_group(std::string_view name) {
    auto& groups = out_.description.groups;
    const auto [group, is_new] = group_of_.try_emplace(std::string(name), static_cast<std::uint32_t>(groups.size()));
    if (is_new) groups.push_back(name.empty() ? "default" : std::string(name));
    group_ = group->second;
    has_group_ = true;
}

/// Checks indices after the whole file has been read: vertices may follow the faces that use them.
void ObjReader::check_indices() {
    const std::vector<Point>& points = out_.description.points;
    std::vector<SceneDescription::Face>& faces = out_.description.faces;
    const auto is_broken = [&](const SceneDescription::Face& face) {
        const auto beyond =
            std::find_if(face.corners.begin(), face.corners.end(), [&](auto c) { return c >= points.size(); });
        if (beyond != face.corners.end())
            find(Finding::Kind::error, face.line,
                 fmt::format("face names vertex {} of {}", *beyond + 1, points.size()));
        return beyond != face.corners.end() || std::any_of(face.corners.begin(), face.corners.end(), [&](auto c) {
                   return std::binary_search(broken_.begin(), broken_.end(), c);
               });
    };
    std::size_t kept = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (is_broken(faces[f])) continue;
        if (kept != f) faces[kept] = std::move(faces[f]), places_of_face_[kept] = std::move(places_of_face_[f]);
        if (kept != f && with_normals_) normals_of_face_[kept] = std::move(normals_of_face_[f]);
        ++kept;
    }
    faces.resize(kept), places_of_face_.resize(kept);
    if (with_normals_) normals_of_face_.resize(kept);
}

void ObjReader::resolve_materials() {
    auto& materials = out_.description.materials;
    std::unordered_map<std::string, std::uint32_t> by_name;
    for (std::uint32_t m = 0; m < materials.size(); ++m) by_name.emplace(materials[m].name, m);
    std::vector<std::uint32_t> meaning;
    const Use* unknown = nullptr;
    std::size_t unknown_count = 0;
    for (const Use& use : uses_) {
        auto known = by_name.find(use.name);
        if (known == by_name.end()) {
            if (use.name != default_material && unknown_count++ == 0) unknown = &use;
            known = by_name.emplace(use.name, static_cast<std::uint32_t>(materials.size())).first;
            materials.push_back({use.name, Spectrum(0.5), Spectrum()});
        }
        meaning.push_back(known->second);
    }
    if (unknown && !library_missing_)
        find(Finding::Kind::repair, unknown->line,
             fmt::format("material '{}'{}: such faces reflect 0.5 and emit nothing", shown(unknown->name),
                         unknown_count > 1
                             ? fmt::format(" and {} more are in {}", unknown_count - 1,
                                           has_library_ ? "no material file" : "no file, as the scene names none")
                         : has_library_ ? " is in no material file"
                                        : " is in no file, as the scene names none"),
             has_library_ ? "define it with 'newmtl', or correct the name" : "name its file with 'mtllib'");
    for (auto& face : out_.description.faces) face.material = meaning[face.material];
    take_textures();
    take_panes();
}

/// Returns the values of a face's corners, which are given by their indices; empty if one of them is not known.
template <class Value>
std::vector<Value> values_at_corners(const std::vector<Value>& values, const std::vector<std::uint32_t>& indices) {
    std::vector<Value> out;
    for (const std::uint32_t i : indices) {
        if (i >= values.size() || std::isnan(values[i].x)) return {};
        out.push_back(values[i]);
    }
    return out;
}

/// Texture coordinates of a face's corners; empty if it has none.
std::vector<Vec2> ObjReader::places_of(std::size_t face) const {
    return values_at_corners(places_, places_of_face_[face]);
}

/// Normals of a face's corners; empty if it has none.
std::vector<Vec3> ObjReader::normals_of(std::size_t face) const {
    return values_at_corners(normals_, normals_of_face_[face]);
}

/// Gives textured faces the colours of their parts of pictures. Glass has none: its faces become panes.
void ObjReader::take_textures() {
    if (extras_.pictures.empty()) return;
    SceneDescription& d = out_.description;
    TexturedFaces textured(d, whitest_reflectance, texture_parts_);
    std::vector<const MtlPictures*> pictures(d.materials.size());
    for (std::size_t m = 0; m < pictures.size(); ++m)
        if (const auto found = extras_.pictures.find(d.materials[m].name);
            found != extras_.pictures.end() && !extras_.glass.contains(d.materials[m].name))
            pictures[m] = &found->second;
    for (std::size_t f = 0; f < d.faces.size(); ++f) {
        const MtlPictures* shown = pictures[d.faces[f].material];
        const std::vector<Vec2> places = shown ? places_of(f) : std::vector<Vec2>();
        if (places.empty()) continue;
        FaceColours colours;
        if (shown->reflectance) colours.reflectance = {shown->reflectance.get(), places};
        if (shown->exitance) colours.exitance = {shown->exitance.get(), places};
        if (shown->coverage) colours.coverage = {shown->coverage.get(), places};
        textured.show(f, std::move(colours));
    }
    textured.finish();
    out_.reflectance_deviation = textured.reflectance_deviation();
    for (const std::optional<Finding>& finding : {textured.finding(), textured.finding_of_holes()})
        if (finding) find(finding->kind, 0, finding->message, finding->hint);
}

/// Turns faces of glass into panes.
void ObjReader::take_panes() {
    if (extras_.glass.empty()) return;
    SceneDescription& d = out_.description;
    std::vector<bool> is_listed(d.materials.size());
    std::erase_if(d.faces, [&](const SceneDescription::Face& face) {
        const auto glass = extras_.glass.find(d.materials[face.material].name);
        if (glass == extras_.glass.end()) return false;
        if (!is_listed[face.material])
            out_.glazed_by.push_back(fmt::format("material '{}' ({})", shown(glass->first), glass->second.where));
        is_listed[face.material] = true;
        Pane pane;
        for (const std::uint32_t c : face.corners) pane.corners.push_back(d.points[c]);
        pane.transmissivity = glass->second.transmissivity, pane.line = face.line;
        d.panes.push_back(std::move(pane));
        out_.pane_labels.push_back({glass->first, d.groups[face.group]});
        return true;
    });
}

}  // namespace

ReadScene read_obj(const std::string& path, std::optional<std::size_t> texture_parts) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return unreadable_scene(path, text.error().message);
    if (text->starts_with("\xff\xfe") || text->starts_with("\xfe\xff"))
        return unreadable_scene(path, "is text in UTF-16", "save it as UTF-8 or plain ASCII");
    return ObjReader(path, *text, texture_parts).read();
}

Result<std::vector<ObjPlaces>> read_obj_places(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    return ObjReader(path, *text).read_places();
}

}  // namespace exitance
