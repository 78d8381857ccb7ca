#include "exitance/io/scenes/textures/uv_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "exitance/base/triangulation.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"
#include "exitance/io/scenes/textures/obj_match.hpp"
#include "exitance/io/scenes/textures/triangle_weights.hpp"
#include "exitance/scene/face_parts.hpp"
#include "exitance/scene/locator.hpp"

namespace exitance {
namespace {

Error no_set(const std::string& path, const std::string& name, const std::string& sets) {
    return {
        ErrorCode::usage, fmt::format("{} has no texture coordinates '{}'", path, name), "--uv",
        sets.empty() ? "use --uv unwrap, which makes coordinates and writes the model with them" : "it has " + sets};
}

/// Error about faces without coordinates, by object; none if there are none.
Result<void> require_all(const Scene& scene, const Field<SurfaceId, std::uint8_t>& has_places,
                         const std::string& path) {
    std::map<std::uint32_t, std::size_t> missing;  // number of faces by group
    std::size_t count = 0;
    for (SurfaceId s : scene.surfaces().ids())
        if (!has_places[s]) ++missing[scene.surfaces()[s].group.value], ++count;
    if (count == 0) return {};
    constexpr std::size_t max_names = 5;
    std::string names;
    std::size_t listed = 0;
    for (const auto& [group, faces] : missing) {
        if (++listed > max_names) break;
        names +=
            fmt::format("{}'{}' ({} of its faces)", names.empty() ? "" : ", ", scene.groups()[GroupId(group)], faces);
    }
    if (missing.size() > max_names) names += fmt::format(" and {} more objects", missing.size() - max_names);
    return Error{ErrorCode::bad_input,
                 fmt::format("{} of {} faces have no texture coordinates: {}", count, scene.surfaces().size(), names),
                 path,
                 "unwrap these objects in your modeller, or use --uv unwrap: bake then makes coordinates for all"};
}

/// Makes names differ: the second "lamp" becomes "lamp #2".
class UniqueNames {
  public:
    std::string add(const std::string& name) {
        std::string out = name.empty() ? "unnamed" : name;
        for (int k = 2; !taken_.insert(out).second; ++k) out = fmt::format("{} #{}", name, k);
        return out;
    }

  private:
    std::set<std::string> taken_;
};

/// Matches the triangles of a glTF file with a scene's faces, by position.
class GltfUvs {
  public:
    GltfUvs(const Scene& scene, const GltfModel& model, std::size_t set, const std::string& path)
        : scene_(scene), model_(model), set_(set), locator_(scene), parts_(scene), matched_(scene.surfaces().size()) {
        out_.file = path, out_.name = fmt::format("TEXCOORD_{}", set);
        object_of_.resize(model.nodes.size(), -1);
    }

    Result<UvSet> find() {
        for_each_triangle(model_, [this](const GltfTriangle& triangle) { add(triangle); });
        Field<SurfaceId, std::uint8_t> has_places(scene_.surfaces().size());
        for (SurfaceId s : scene_.surfaces().ids()) {
            has_places[s] = matched_[s] != Match::none;
            out_.back_faces += matched_[s] == Match::back;
        }
        if (const Result<void> complete = require_all(scene_, has_places, out_.file); !complete)
            return complete.error();
        return std::move(out_);
    }

  private:
    enum class Match : std::uint8_t { none, back, front };

    void add(const GltfTriangle& triangle) {
        const GltfRows& places = triangle.primitive->places[set_];
        if (places.size() == 0) return;
        UvTriangle out;
        out.corner = triangle.corners;
        for (std::size_t k = 0; k < 3; ++k)
            out.place[k] = {places.at(triangle.vertices[k], 0), places.at(triangle.vertices[k], 1)};
        const Normal n = normalized(cross(out.corner[1] - out.corner[0], out.corner[2] - out.corner[0]));
        std::vector<SurfaceId> found = parts_.find(locator_, out.corner, n);
        const std::vector<SurfaceId> back = parts_.find(locator_, out.corner, -1 * n);
        const bool is_turned = found.empty();  // a face whose front is missing was turned when it was read
        if (!is_turned)
            for (const SurfaceId part : back)
                if (matched_[part] == Match::none) matched_[part] = Match::back;
        if (is_turned) found = back;
        if (found.empty()) return;
        out.surface = found[0];
        if (is_turned) std::swap(out.corner[1], out.corner[2]), std::swap(out.place[1], out.place[2]);
        out.object = object_of(triangle.node);
        for (const SurfaceId part : found) add_part(part, out);
    }

    /// Adds a triangle of the file, or that part of it which became a face.
    void add_part(SurfaceId part, const UvTriangle& whole) {
        matched_[part] = Match::front;
        if (scene_.surfaces()[part].whole == 0) return out_.triangles.push_back(whole);
        const TriangleWeights weights(whole.corner);
        const std::span<const Point> outline = scene_.outline(part);
        for (const auto& t : triangulate(outline, scene_.surfaces()[part].normal)) {
            UvTriangle out = whole;
            out.surface = part;
            for (std::size_t k = 0; k < 3; ++k) {
                out.corner[k] = outline[t[k]];
                const std::array<double, 3> w = weights.at(out.corner[k]);
                out.place[k] = w[0] * whole.place[0] + w[1] * whole.place[1] + w[2] * whole.place[2];
            }
            out_.triangles.push_back(out);
        }
    }

    std::uint32_t object_of(std::size_t node) {
        if (object_of_[node] < 0) {
            object_of_[node] = static_cast<int>(out_.objects.size());
            const GltfModel::Node& n = model_.nodes[node];
            out_.objects.push_back(
                names_.add(n.name.empty() ? model_.meshes[static_cast<std::size_t>(n.mesh)].name : n.name));
        }
        return static_cast<std::uint32_t>(object_of_[node]);
    }

    const Scene& scene_;
    const GltfModel& model_;
    std::size_t set_;
    Locator locator_;
    FaceParts parts_;
    Field<SurfaceId, Match> matched_;
    std::vector<int> object_of_;  ///< Object of each node; -1: not determined yet.
    UniqueNames names_;
    UvSet out_;
};

Result<UvSet> load_gltf_uvs(const Scene& scene, const std::string& path, const std::string& name) {
    std::vector<Finding> findings;  // reported when the scene was read for solving
    const Result<GltfModel> model = load_gltf_model(path, findings, true);
    if (!model) return model.error();
    std::array<bool, std::tuple_size_v<decltype(GltfModel::Primitive::places)>> has_set{};
    for (const GltfModel::Mesh& mesh : model->meshes)
        for (const GltfModel::Primitive& p : mesh.primitives)
            for (std::size_t set = 0; set < has_set.size(); ++set) has_set[set] |= p.places[set].size() > 0;
    std::string sets;
    for (std::size_t set = 0; set < has_set.size(); ++set)
        if (has_set[set]) sets += fmt::format("{}TEXCOORD_{}", sets.empty() ? "" : ", ", set);
    std::size_t chosen = has_set.size();
    for (std::size_t set = 0; set < has_set.size(); ++set)
        if (has_set[set] && name == fmt::format("TEXCOORD_{}", set)) chosen = set;
    if (name == "own" && !sets.empty()) chosen = has_set[1] ? 1 : sets.back() - '0';
    if (chosen == has_set.size()) return no_set(path, name, sets);
    return GltfUvs(scene, *model, chosen, path).find();
}

/// Adds the texture coordinates of an OBJ file's faces to a scene's faces.
class ObjUvs {
  public:
    ObjUvs(const Scene& scene, std::vector<ObjPlaces> faces, const std::string& path)
        : scene_(scene), match_(scene, std::move(faces)), has_places_(scene.surfaces().size()) {
        out_.file = path, out_.name = "vt";
        UniqueNames names;
        for (const std::string& group : scene.groups()) out_.objects.push_back(names.add(group));
    }

    Result<UvSet> find() {
        if (std::all_of(match_.faces().begin(), match_.faces().end(),
                        [](const ObjPlaces& face) { return face.places.empty(); }))
            return no_set(out_.file, out_.name, "");
        if (!match_.is_aligned()) return changed();
        for (SurfaceId s : scene_.surfaces().ids())
            if (!add(s)) return changed();
        if (const Result<void> complete = require_all(scene_, has_places_, out_.file); !complete)
            return complete.error();
        return std::move(out_);
    }

  private:
    Error changed() const {
        return {ErrorCode::bad_input, "the file's faces are not those of the solution", out_.file,
                "the file was changed after the solve: solve it again"};
    }

    /// Adds the triangles of a face. Returns false if it does not lie where the file's face does.
    bool add(SurfaceId s) {
        const ObjPlaces* face = match_.face_of(s);
        if (!face || face->places.empty()) return true;
        const std::optional<std::vector<CornerMean>> corners = match_.corners(s);
        if (!corners) return false;
        const std::span<const Point> outline = scene_.outline(s);
        std::vector<Vec2> places;
        for (const CornerMean& mean : *corners) places.push_back(mean.of(std::span(face->places)));
        for (const auto& [i, j, k] : triangulate(outline, scene_.surfaces()[s].normal))
            out_.triangles.push_back({s,
                                      scene_.surfaces()[s].group.value,
                                      {outline[i], outline[j], outline[k]},
                                      {places[i], places[j], places[k]}});
        has_places_[s] = true;
        return true;
    }

    const Scene& scene_;
    ObjMatch match_;
    Field<SurfaceId, std::uint8_t> has_places_;
    UvSet out_;
};

}  // namespace

Result<UvSet> load_uv_set(const Scene& scene, const std::string& path, const std::string& name) {
    if (scene.file().empty())
        return Error{ErrorCode::usage, "a scene made from arrays has no texture coordinates", "--uv",
                     "use unwrap, which makes charts"};
    if (path.empty())
        return Error{ErrorCode::cannot_read, "is missing, and texture coordinates are read from it", scene.file(),
                     "put it in the folder of the solution file"};
    const std::string kind = ending(path);
    if (kind == ".glb" || kind == ".gltf") return load_gltf_uvs(scene, path, name);
    if (kind != ".obj")
        return Error{ErrorCode::usage, fmt::format("{} files have no texture coordinates", kind), "--uv",
                     "use glTF or OBJ, or leave --uv out: bake then makes charts of its own"};
    if (name != "own" && name != "vt" && name != "TEXCOORD_0") return no_set(path, name, "vt");
    Result<std::vector<ObjPlaces>> faces = read_obj_places(path);
    if (!faces) return faces.error();
    return ObjUvs(scene, std::move(*faces), path).find();
}

}  // namespace exitance
