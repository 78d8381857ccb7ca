#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/photometry/photometric_file.hpp"
#include "exitance/io/scenes/gltf/gltf.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"
#include "exitance/io/scenes/textures/masked_picture.hpp"
#include "exitance/io/scenes/textures/textured_faces.hpp"

namespace exitance {
namespace {

/// Limit for all instances together: a small file can create any number.
constexpr std::size_t max_triangles = 20'000'000;
constexpr double max_reflectance = 0.95;

/// Rotates Y up to Z up.
constexpr Affine upright{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}};

Spectrum spread(const GltfModel::Colour& c) {
    const std::array<double, 3> rgb = {c.r, c.g, c.b};
    Spectrum out;
    if (bands == 1) return Spectrum((c.r + c.g + c.b) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = rgb[b * 3 / bands];
    return out;
}

/// True if a material is imported as panes. Glass that transmits less is imported as a reflector.
bool is_clear_glass(const GltfModel::Material& m) {
    constexpr double min_transmission = 0.5;
    return m.transmission >= min_transmission;
}

class SceneMaker {
  public:
    SceneMaker(const GltfModel& in, ReadScene& out, std::optional<std::size_t> texture_parts)
        : in_(in),
          out_(out.description),
          findings_(out.findings),
          luminaires_(out.luminaires),
          deviation_(out.reflectance_deviation),
          pane_labels_(out.pane_labels),
          textured_(out_, max_reflectance, texture_parts) {}
    void make();

  private:
    void make_materials();
    void report_materials();
    void read_holes();
    std::uint32_t material_of(int material);
    bool visit_nodes();
    bool add_mesh(const GltfModel::Node& node, const Affine& to_world);
    bool add_primitive(const GltfModel::Primitive& p, const GltfModel::Mesh& mesh, const Affine& to_world);
    bool add_pane(const std::array<std::uint32_t, 3>& c, std::uint32_t material);
    void add_triangle(std::array<std::uint32_t, 3> corners, bool double_sided, std::uint32_t material,
                      FaceColours colours);
    FaceColours colours_of(const GltfModel::Primitive& p, const std::array<std::uint32_t, 3>& vertices);
    FacePicture shown(const GltfModel::TextureUse& texture, const GltfModel::Primitive& p,
                      const std::array<std::uint32_t, 3>& vertices);
    std::uint32_t corner(const GltfModel::Primitive& p, const Affine& to_world, std::uint32_t index);
    void add_lamp(const GltfModel::Lamp& lamp, const Affine& to_world);
    void add_view(const GltfModel::View& view, const Affine& to_world);
    void add_luminaire(const std::string& name, const Affine& to_world);

    bool error(std::string message, std::string hint = "") {
        findings_.push_back({Finding::Kind::error, out_.file, 0, std::move(message), std::move(hint)});
        return false;
    }
    void warn(std::string message, std::string hint = "") {
        findings_.push_back({Finding::Kind::warning, out_.file, 0, std::move(message), std::move(hint)});
    }

    const GltfModel& in_;
    SceneDescription& out_;
    std::vector<Finding>& findings_;
    std::vector<PlacedLuminaire>& luminaires_;
    std::vector<Spectrum>& deviation_;
    std::vector<PaneLabel>& pane_labels_;
    std::uint32_t default_material_ = 0;
    bool has_default_ = false;
    std::size_t triangles_ = 0, deformed_ = 0;
    /// For the points of the current primitive: the round in which a vertex was used last, and the scene's point.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> used_;
    std::uint32_t round_ = 0;
    int accessor_ = -1;
    TexturedFaces textured_;
    std::map<int, MaskedPicture> masked_;                 ///< Base textures with holes, by material.
    std::map<int, std::optional<TextureArea>> pictures_;  ///< Textures in use; empty: cannot be read.
};

void SceneMaker::make_materials() {
    for (const GltfModel::Material& m : in_.materials) {
        Material out{m.name, spread(m.base), exitance_of_radiance(spread(m.emission))};
        for (double& v : out.reflectance.value) v = std::clamp(v * std::clamp(1 - m.metallic, 0.0, 1.0), 0.0, 1.0);
        if (max(out.reflectance) > 0) out.through = std::clamp(m.diffuse_transmission, 0.0, 1.0);
        out_.materials.push_back(std::move(out));
    }
}

/// Reads base textures with holes. The colour of a material is then that of the opaque part of its texture.
void SceneMaker::read_holes() {
    for (std::size_t i = 0; i < in_.materials.size(); ++i) {
        const GltfModel::Material& m = in_.materials[i];
        if (!(m.hole_opacity > 0)) continue;
        const std::span<const std::uint8_t> file = in_.pictures[static_cast<std::size_t>(m.base_texture.picture)];
        Result<std::optional<MaskedPicture>> masked = decode_masked(file, m.hole_opacity, srgb_curve());
        const Result<std::array<double, 3>> whole = mean_colour(file, srgb_curve());
        // the picture has no holes, or its failure was reported with the material
        if (!masked || !*masked || !whole) continue;
        const TextureArea::Colour opaque = (*masked)->colour.mean();
        const Spectrum before = spread({(*whole)[0], (*whole)[1], (*whole)[2]});
        const Spectrum after = spread({opaque[0], opaque[1], opaque[2]});
        for (std::size_t b = 0; b < bands; ++b)
            if (before[b] > 0) out_.materials[i].reflectance[b] *= after[b] / before[b];
        masked_.emplace(static_cast<int>(i), std::move(**masked));
    }
}

/// Warns once per kind of omitted property, with the first material's name and the number of others.
void SceneMaker::report_materials() {
    const auto list = [&](const auto& belongs, const std::string& says, const std::string& hint) {
        std::size_t count = 0;
        const Material* first = nullptr;
        for (std::size_t i = 0; i < in_.materials.size(); ++i)
            if (belongs(i) && count++ == 0) first = &out_.materials[i];
        if (first)
            warn(fmt::format("material '{}'{} {}", first->name,
                             count > 1 ? fmt::format(" and {} more", count - 1) : std::string(), says),
                 hint);
    };
    list([&](std::size_t i) { return max(out_.materials[i].reflectance) > max_reflectance; },
         fmt::format("would reflect more than {0}: {0} is used", max_reflectance),
         "white is the default of glTF; walls reflect 0.5 to 0.85");
    list([&](std::size_t i) { return in_.materials[i].metallic >= 1 && !out_.materials[i].emits(); },
         "is metal: it does not reflect diffusely", "set the metallic factor to 0, glTF's default is 1");
    list([&](std::size_t i) { return in_.materials[i].transparent && !is_clear_glass(in_.materials[i]); },
         "lets light through: here it is opaque", "panes of clear glass have KHR_materials_transmission");
    list([&](std::size_t i) { return is_clear_glass(in_.materials[i]); },
         "lets light through: its faces are panes of clear glass", "");
    for (Material& m : out_.materials)
        for (double& v : m.reflectance.value) v = std::min(v, max_reflectance);
}

std::uint32_t SceneMaker::material_of(int material) {
    if (material >= 0) return static_cast<std::uint32_t>(material);
    if (!has_default_) {
        has_default_ = true;
        default_material_ = static_cast<std::uint32_t>(out_.materials.size());
        out_.materials.push_back({"default", Spectrum(0.5), Spectrum()});
        warn("some triangles have no material: they get one named 'default', with reflectance 0.5");
    }
    return default_material_;
}

/// Returns the scene's point for a vertex of the current mesh.
std::uint32_t SceneMaker::corner(const GltfModel::Primitive& p, const Affine& to_world, std::uint32_t index) {
    auto& [round, point] = used_[index];
    if (round != round_) {
        round = round_, point = static_cast<std::uint32_t>(out_.points.size());
        out_.points.push_back(to_world.point(p.positions.point(index)));
    }
    return point;
}

/// Adds a glass triangle as a pane. Returns false if it is not glass.
bool SceneMaker::add_pane(const std::array<std::uint32_t, 3>& c, std::uint32_t material) {
    if (material >= in_.materials.size() || !is_clear_glass(in_.materials[material])) return false;
    const GltfModel::Material& m = in_.materials[material];
    Pane pane;
    for (const std::uint32_t i : c) pane.corners.push_back(out_.points[i]);
    pane.transmissivity = transmissivity_of(std::min(1.0, m.transmission) * spread(m.base));
    out_.panes.push_back(std::move(pane));
    pane_labels_.push_back({m.name, ""});
    ++triangles_;
    return true;
}

/// Texture on a triangle.
FacePicture SceneMaker::shown(const GltfModel::TextureUse& texture, const GltfModel::Primitive& p,
                              const std::array<std::uint32_t, 3>& vertices) {
    if (texture.picture < 0 || static_cast<std::size_t>(texture.picture) >= in_.pictures.size()) return {};
    const GltfRows& places = p.places[static_cast<std::size_t>(texture.place_set)];
    if (places.size() == 0) return {};
    const auto [picture, is_new] = pictures_.try_emplace(texture.picture);
    if (is_new) {
        Result<TextureArea> area =
            TextureArea::of(in_.pictures[static_cast<std::size_t>(texture.picture)], srgb_curve());
        if (area) picture->second = std::move(*area);  // a failure was reported with the material
    }
    if (!picture->second) return {};
    FacePicture out{&*picture->second, {}, TextureArea::wrap_of(texture.wrap_s), TextureArea::wrap_of(texture.wrap_t)};
    for (const std::uint32_t v : vertices) out.places.push_back(texture.moved({places.at(v, 0), places.at(v, 1)}));
    return out;
}

/// Colours of a triangle: its textures, and the colours of its vertices, which multiply the base colour.
FaceColours SceneMaker::colours_of(const GltfModel::Primitive& p, const std::array<std::uint32_t, 3>& vertices) {
    FaceColours out;
    if (p.material >= 0) {
        const GltfModel::Material& m = in_.materials[static_cast<std::size_t>(p.material)];
        out.reflectance = shown(m.base_texture, p, vertices);
        if (const auto masked = masked_.find(p.material); masked != masked_.end() && out.reflectance.picture) {
            out.coverage = out.reflectance;
            out.reflectance.picture = &masked->second.colour, out.coverage.picture = &masked->second.coverage;
        }
        if (out_.materials[static_cast<std::size_t>(p.material)].emits())
            out.exitance = shown(m.emission_texture, p, vertices);
    }
    if (p.colours.size() == 0) return out;
    for (const std::uint32_t v : vertices) {
        const auto channel = [&](std::size_t i) { return std::clamp(p.colours.at(v, i), 0.0, 1.0); };
        out.corner_factors.push_back(spread({channel(0), channel(1), channel(2)}));
    }
    return out;
}

void SceneMaker::add_triangle(std::array<std::uint32_t, 3> c, bool double_sided, std::uint32_t material,
                              FaceColours colours) {
    if (add_pane(c, material)) return;
    const auto turn = [](auto& of_corners) {
        if (!of_corners.empty()) std::swap(of_corners[1], of_corners[2]);
    };
    const auto group = static_cast<std::uint32_t>(out_.groups.size() - 1);
    for (int side = 0; side < (double_sided ? 2 : 1); ++side) {
        out_.faces.push_back({{c.begin(), c.end()}, material, group, 0});
        if (colours.vary()) textured_.show(out_.faces.size() - 1, colours);
        std::swap(c[1], c[2]);
        turn(colours.reflectance.places), turn(colours.exitance.places), turn(colours.coverage.places),
            turn(colours.corner_factors);
    }
    ++triangles_;
}

bool SceneMaker::add_primitive(const GltfModel::Primitive& p, const GltfModel::Mesh& mesh, const Affine& to_world) {
    const std::size_t triangles = p.triangle_count();
    if (triangles > max_triangles - std::min(triangles_, max_triangles))
        return error(fmt::format("there are more than {} triangles", max_triangles),
                     "every instance counts: leave some out");
    if (used_.size() < p.positions.size()) used_.resize(p.positions.size());
    if (p.accessor != accessor_) accessor_ = p.accessor, ++round_;
    const std::uint32_t material = material_of(p.material);
    const bool double_sided = p.material >= 0 && in_.materials[static_cast<std::size_t>(p.material)].double_sided;
    const bool mirrored = to_world.determinant() < 0;
    for (std::size_t t = 0; t < triangles; ++t) {
        std::array<std::size_t, 3> at{};
        if (p.mode == GltfModel::Mode::triangles)
            at = {3 * t, 3 * t + 1, 3 * t + 2};
        else if (p.mode == GltfModel::Mode::strip)
            at = t % 2 == 0 ? std::array{t, t + 1, t + 2} : std::array{t, t + 2, t + 1};
        else
            at = {t + 1, t + 2, 0};
        std::array<std::uint32_t, 3> c{};
        bool restart = false;  // the largest index starts a new strip in files of some programs
        for (std::size_t k = 0; k < 3; ++k) {
            c[k] = p.has_indices ? p.indices.index(at[k]) : static_cast<std::uint32_t>(at[k]);
            restart |= c[k] == 0xffffffffu;
            if (c[k] >= p.positions.size() && !restart)
                return error(fmt::format("mesh '{}' refers to vertex {}, but has {} vertices", mesh.name, c[k],
                                         p.positions.size()));
        }
        if (restart || (p.mode != GltfModel::Mode::triangles && (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])))
            continue;  // strips contain triangles without area to change direction
        if (mirrored) std::swap(c[1], c[2]);
        FaceColours colours = colours_of(p, c);
        for (std::uint32_t& i : c) i = corner(p, to_world, i);
        add_triangle(c, double_sided, material, std::move(colours));
    }
    return true;
}

bool SceneMaker::add_mesh(const GltfModel::Node& node, const Affine& to_world) {
    const GltfModel::Mesh& mesh = in_.meshes[static_cast<std::size_t>(node.mesh)];
    if (mesh.primitives.empty()) return true;
    out_.groups.push_back(node.name.empty() ? mesh.name : node.name);
    accessor_ = -1;
    deformed_ += node.is_deformed;
    return std::all_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [&](const GltfModel::Primitive& p) { return add_primitive(p, mesh, to_world); });
}

void SceneMaker::add_lamp(const GltfModel::Lamp& lamp, const Affine& to_world) {
    PunctualLight light;
    light.name = lamp.name, light.kind = lamp.kind;
    light.position = to_world.origin;
    const double length = norm(to_world.z);
    if (!(length > 0) && lamp.kind != PunctualLight::Kind::point)
        return void(error(fmt::format("light '{}' has no direction: its node has scale 0", lamp.name)));
    if (length > 0) light.direction = -to_world.z / length;
    light.intensity = spread(lamp.intensity);
    light.inner_cone = lamp.inner_cone, light.outer_cone = lamp.outer_cone;
    if (lamp.has_range)
        warn(fmt::format("light '{}' has a range, which is ignored: real light does not end there", lamp.name));
    out_.lights.push_back(std::move(light));
    out_.photometric = true;  // intensities are in candela and lux
}

void SceneMaker::add_view(const GltfModel::View& view, const Affine& to_world) {
    SceneCamera camera;
    const double along = norm(to_world.z), up = norm(to_world.y);
    const double aspect = view.aspect > 0 ? view.aspect : 1.6;
    camera.name = view.name;
    camera.fov = 2 * std::atan(std::tan(0.5 * view.yfov) * aspect) * 180 / pi;
    camera.width = 2 * view.xmag;
    if (view.xmag > 0) camera.fov = 60;
    const bool usable = along > 0 && up > 0 && norm(cross(to_world.z, to_world.y)) > 1e-9 * along * up &&
                        camera.fov > 0 && camera.fov < 180 && std::isfinite(camera.width) && is_finite(to_world.origin);
    if (!usable) return warn(fmt::format("camera '{}' shows nothing and is omitted", view.name));
    camera.eye = to_world.origin;
    camera.target = camera.eye - to_world.z / along;
    camera.up = to_world.y / up;
    out_.cameras.push_back(std::move(camera));
}

/// Returns the name of a photometric file without the number that programs append to copies ("a.ies.001"); empty for
/// other names.
std::string photometric_name(std::string name) {
    if (const std::size_t dot = name.find_last_of('.');
        dot != std::string::npos && dot + 1 < name.size() && name.find_first_not_of("0123456789", dot + 1) == name.npos)
        name.erase(dot);
    return names_photometry(name) ? name : "";
}

/// Adds a luminaire for an empty node that is named as a photometric file. Without rotation it shines down, with its C0
/// plane along x.
void SceneMaker::add_luminaire(const std::string& name, const Affine& to_world) {
    PlacedLuminaire out;
    out.path = beside(out_.file, name), out.file = out_.file, out.position = to_world.origin;
    const Vec3 z = to_world.y, x = to_world.x - (squared_norm(z) > 0 ? dot(to_world.x, z) / squared_norm(z) : 0) * z;
    if (!(norm(x) > 0 && norm(z) > 0) || !is_finite(to_world.origin))
        return void(error(fmt::format("luminaire '{}' has no direction: its node has scale 0", name)));
    out.x = normalized(x), out.z = normalized(z), out.y = cross(out.z, out.x);
    luminaires_.push_back(std::move(out));
}

/// Visits every node once, parents first. A node that is reached twice is an error.
bool SceneMaker::visit_nodes() {
    struct Visit {
        int node;
        Affine parent;
    };
    std::vector<bool> seen(in_.nodes.size());
    std::vector<Visit> open;
    for (auto root = in_.roots.rbegin(); root != in_.roots.rend(); ++root) open.push_back({*root, upright});
    while (!open.empty()) {
        const auto [number, parent] = open.back();
        open.pop_back();
        const auto at = static_cast<std::size_t>(number);
        const GltfModel::Node& node = in_.nodes[at];
        if (seen[at])
            return error(fmt::format("node {} ('{}') has two parents, or is its own ancestor", number, node.name),
                         "the nodes of glTF form trees");
        seen[at] = true;
        const Affine to_world = parent * node.to_parent;
        if (node.mesh >= 0 && !add_mesh(node, to_world)) return false;
        if (node.lamp >= 0) add_lamp(in_.lamps[static_cast<std::size_t>(node.lamp)], to_world);
        if (node.view >= 0) add_view(in_.views[static_cast<std::size_t>(node.view)], to_world);
        if (node.mesh < 0 && node.lamp < 0 && node.view < 0)
            if (const std::string name = photometric_name(node.name); !name.empty()) add_luminaire(name, to_world);
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            open.push_back({*child, to_world});
    }
    return true;
}

void SceneMaker::make() {
    make_materials();
    read_holes();
    report_materials();
    if (!visit_nodes()) return out_.faces.clear();
    textured_.finish();
    deviation_ = textured_.reflectance_deviation();
    for (const std::optional<Finding>& finding : {textured_.finding(), textured_.finding_of_holes()})
        if (finding) warn(finding->message, finding->hint);
    if (deformed_ > 0)
        warn(fmt::format("{} {} deformed by skins or morph targets: {} in the rest pose", deformed_,
                         deformed_ == 1 ? "node is" : "nodes are", deformed_ == 1 ? "it stays" : "they stay"));
}

}  // namespace

ReadScene read_gltf(const std::string& path, std::optional<std::size_t> texture_parts) {
    ReadScene out;
    out.description.file = path;
    Result<GltfModel> model = load_gltf_model(path, out.findings, true);
    if (!model) {
        const Error& e = model.error();
        out.findings.push_back({Finding::Kind::error, path, 0, e.message, e.hint});
        return out;
    }
    SceneMaker(*model, out, texture_parts).make();
    for (const GltfModel::Material& m : model->materials)
        if (is_clear_glass(m)) out.glazed_by.push_back(fmt::format("material '{}' ({})", m.name, path));
    return out;
}

}  // namespace exitance
