#include "exitance/io/scenes/textures/scene_textures.hpp"

#include <algorithm>
#include <filesystem>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"
#include "exitance/io/scenes/textures/masked_picture.hpp"
#include "exitance/io/scenes/textures/triangle_weights.hpp"
#include "exitance/scene/face_parts.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/scene/material_name.hpp"

namespace exitance {
namespace {

class TextureFinder {
  public:
    TextureFinder(const Scene& scene, const GltfModel& model)
        : scene_(scene), model_(model), locator_(scene), parts_(scene) {}

    std::optional<SceneTextures> find() {
        std::size_t corners = 0;
        for (const Surface& s : scene_.surfaces()) corners += s.corner_count;
        for (std::vector<Vec2>& set : out_.places) set.resize(corners);
        for_each_triangle(model_, [this](const GltfTriangle& triangle) { add(triangle); });
        if (!found_[0] && !found_[1]) return std::nullopt;
        if (!found_[1]) out_.places[1].clear();
        add_pictures();
        return std::move(out_);
    }

  private:
    void add(const GltfTriangle& triangle) {
        const GltfModel::Primitive& p = *triangle.primitive;
        const std::array<Point, 3>& corner = triangle.corners;
        if (p.places[0].size() == 0 && p.places[1].size() == 0) return;
        const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
        // Faces may have been reversed, or be the back of a double-sided triangle.
        for (const double side : {1.0, -1.0})
            for (const SurfaceId part : parts_.find(locator_, corner, side * normalized(normal)))
                add_places(p, triangle.vertices, corner, part);
    }

    void add_places(const GltfModel::Primitive& p, const std::array<std::size_t, 3>& v,
                    const std::array<Point, 3>& corner, SurfaceId s) {
        const TriangleWeights patch(corner);
        const std::uint32_t first = scene_.surfaces()[s].first_corner;
        const auto material = static_cast<std::size_t>(std::max(p.material, 0));
        for (std::size_t set = 0; set < 2; ++set) {
            if (p.places[set].size() == 0) continue;
            found_[set] = true;
            const GltfModel::Material* m = p.material >= 0 ? &model_.materials[material] : nullptr;
            const bool moved = m && m->base_texture.picture >= 0 && m->base_texture.place_set == static_cast<int>(set);
            for (std::size_t k = 0; k < scene_.outline(s).size(); ++k) {
                const std::array<double, 3> weight = patch.at(scene_.outline(s)[k]);
                Vec2 place;
                for (std::size_t c = 0; c < 3; ++c)
                    place = place + weight[c] * Vec2{p.places[set].at(v[c], 0), p.places[set].at(v[c], 1)};
                if (moved) place = m->base_texture.moved(place);
                out_.places[set][first + k] = place;
            }
        }
    }

    void add_pictures() {
        out_.coats.resize(scene_.materials().size());
        std::vector<int> number(model_.pictures.size(), -1);
        for (MaterialId id : scene_.materials().ids()) {
            const std::string_view name = name_in_file(scene_.materials()[id].name);
            const auto material = std::find_if(model_.materials.begin(), model_.materials.end(),
                                               [&](const GltfModel::Material& m) { return m.name == name; });
            if (material == model_.materials.end() || material->base_texture.picture < 0) continue;
            if (material - model_.materials.begin() >= static_cast<std::ptrdiff_t>(scene_.materials().size())) continue;
            const GltfModel::TextureUse& texture = material->base_texture;
            const auto source = static_cast<std::size_t>(texture.picture);
            if (number[source] < 0) {
                const std::span<const std::uint8_t> file = model_.pictures[source];
                Result<TexturePixels> pixels = decode_texture(file);
                if (!pixels || pixels->width == 0) continue;
                if (material->hole_opacity > 0) fill_holes(*pixels, material->hole_opacity);
                number[source] = static_cast<int>(out_.pictures.size());
                out_.pictures.push_back(
                    {{file.begin(), file.end()}, file[0] == 0xff ? "image/jpeg" : "image/png", std::move(*pixels)});
            }
            const auto whole = static_cast<std::uint32_t>(material - model_.materials.begin());
            out_.coats[id] = {number[source], texture.place_set, texture.wrap_s, texture.wrap_t, MaterialId(whole)};
        }
    }

    const Scene& scene_;
    const GltfModel& model_;
    Locator locator_;
    FaceParts parts_;
    SceneTextures out_;
    bool found_[2] = {false, false};
};

}  // namespace

std::string find_scene_file(const Scene& scene, const std::string& beside) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path there = scene.file(), here = fs::path(beside).parent_path() / there.filename();
    if (fs::is_regular_file(there, ignored)) return there.string();
    return fs::is_regular_file(here, ignored) ? here.string() : "";
}

std::optional<SceneTextures> load_scene_textures(const Scene& scene, const std::string& path) {
    if (ending(path) != ".glb" && ending(path) != ".gltf") return std::nullopt;
    std::vector<Finding> findings;  // reported when the scene was read for solving
    const Result<GltfModel> model = load_gltf_model(path, findings, true);
    if (!model) return std::nullopt;
    return TextureFinder(scene, *model).find();
}

}  // namespace exitance
