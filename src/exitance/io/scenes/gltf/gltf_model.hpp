#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/io/scenes/affine.hpp"
#include "exitance/scene/point_light.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Rows of numbers in a buffer, all bytes of which are known to exist.
class GltfRows {
  public:
    enum class Number : std::uint8_t { int8, uint8, int16, uint16, uint32, float32 };

    GltfRows() = default;
    GltfRows(const std::uint8_t* first, std::size_t stride, std::size_t count, Number number, bool normalized)
        : first_(first), stride_(stride), count_(count), number_(number), normalized_(normalized) {}

    std::size_t size() const { return count_; }
    /// Number `k` of a row. Normalized integers are converted to fractions.
    double at(std::size_t row, std::size_t k) const;
    std::uint32_t index(std::size_t row) const;
    /// Copies the rows, of `bytes` bytes each, contiguously to `out`.
    void copy_to(std::uint8_t* out, std::size_t bytes) const {
        for (std::size_t i = 0; i < count_; ++i) std::memcpy(out + i * bytes, first_ + i * stride_, bytes);
    }
    Point point(std::size_t row) const { return {at(row, 0), at(row, 1), at(row, 2)}; }

    static std::size_t bytes(Number number);

  private:
    template <class T>
    T value(std::size_t row, std::size_t k) const {
        T out;
        std::memcpy(&out, first_ + row * stride_ + k * sizeof(T), sizeof(T));
        return out;
    }

    const std::uint8_t* first_ = nullptr;
    std::size_t stride_ = 0, count_ = 0;
    Number number_ = Number::float32;
    bool normalized_ = false;
};

/// The parts of a glTF file that matter for light, with checked indices and consistent counts. Y up, metres.
struct GltfModel {
    enum class Mode : std::uint8_t { triangles, strip, fan };
    struct Primitive {
        GltfRows positions, indices;
        bool has_indices = false;
        int accessor = -1;  ///< Accessor of the positions. Primitives with equal accessors share their points.
        int material = -1;
        Mode mode = Mode::triangles;
        std::array<GltfRows, 4> places;  ///< TEXCOORD_0 to 3 if textures were requested; empty if missing.
        GltfRows normals;                ///< NORMAL; empty if missing or not requested.
        GltfRows colours;  ///< COLOR_0, which multiplies the base colour; empty if missing or not requested.

        std::size_t triangle_count() const {
            const std::size_t corners = has_indices ? indices.size() : positions.size();
            return mode == Mode::triangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
        }
    };
    struct Mesh {
        std::string name;
        std::vector<Primitive> primitives;
    };
    struct Colour {
        double r = 0, g = 0, b = 0;
    };
    /// A texture: its picture, the set of texture coordinates, glTF's wrap modes, and KHR_texture_transform.
    struct TextureUse {
        int picture = -1, place_set = 0, wrap_s = 10497, wrap_t = 10497;
        std::array<double, 6> transform = {1, 0, 0, 0, 1, 0};  ///< s' = t0 s + t1 t + t2, t' = t3 s + t4 t + t5

        Vec2 moved(const Vec2& p) const {
            const auto& t = transform;
            return {t[0] * p.x + t[1] * p.y + t[2], t[3] * p.x + t[4] * p.y + t[5]};
        }
    };
    struct Material {
        std::string name;
        Colour base, emission;  ///< Colour factors times the mean colours of their textures; emission in W/(m^2 sr).
        double metallic = 1;
        /// KHR_materials_diffuse_transmission: transmitted share of the light that leaves diffusely.
        double diffuse_transmission = 0;
        double transmission = 0;  ///< KHR_materials_transmission: share of light that passes without scattering.
        bool double_sided = false, transparent = false;
        /// For masks: opacity of the base texture below which there are holes; 0: no holes.
        double hole_opacity = 0;
        TextureUse base_texture, emission_texture;  ///< Set if textures were requested.
    };
    struct View {
        std::string name;
        double yfov = 1, aspect = 0;  ///< Vertical field of view, radians; width over height, 0 if unknown.
        double xmag = 0;              ///< Half of the width of an orthographic view, m; 0: perspective.
    };
    struct Lamp {
        std::string name;
        PunctualLight::Kind kind = PunctualLight::Kind::point;
        Colour intensity;  ///< Colour times intensity, cd; lx for parallel light.
        double inner_cone = 0, outer_cone = pi / 4;
        bool has_range = false;
    };
    struct Node {
        std::string name;
        Affine to_parent;
        int mesh = -1, view = -1, lamp = -1;
        bool is_deformed = false;  ///< True if the node has a skin or morph targets, which are ignored.
        std::vector<int> children;
    };

    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<View> views;
    std::vector<Lamp> lamps;
    std::vector<Node> nodes;
    std::vector<int> roots;  ///< Nodes of the default scene.

    std::vector<std::span<const std::uint8_t>> pictures;  ///< Files, if textures were requested; empty if missing.

    std::vector<std::vector<std::uint8_t>> bytes;  ///< Memory that the rows point into; moved, never copied.

    GltfModel() = default;
    GltfModel(GltfModel&&) = default;
    GltfModel& operator=(GltfModel&&) = default;
};

/// A triangle of a glTF scene in the scene's axes (Z up).
struct GltfTriangle {
    std::size_t node = 0;
    const GltfModel::Primitive* primitive = nullptr;
    std::array<std::size_t, 3> vertices{};  ///< Rows of the primitive.
    std::array<Point, 3> corners;           ///< Metres.
    std::array<Vec3, 3> normals{};          ///< Unit vectors; zero if the file has none or they were not requested.
};

/// Calls visit(triangle) for every triangle with an area of every node's mesh, in the order in which read_gltf reads
/// them. Triangles that name missing vertices are omitted.
void for_each_triangle(const GltfModel& model, const std::function<void(const GltfTriangle&)>& visit);

/// Returns the transform of a node from its matrix (16 numbers, by columns), or from its rotation (a quaternion x, y,
/// z, w), scale and translation. Empty arguments have no effect. Empty if numbers are not finite or the quaternion is
/// 0.
std::optional<Affine> gltf_transform(std::span<const double> matrix, std::span<const double> rotation,
                                     std::span<const double> scale, std::span<const double> translation);

/// Reads a model from glTF's JSON or binary container, with the buffers and pictures in separate files. Faults in
/// optional parts are added to `findings`. Every index, count, offset and stride is checked against the data before
/// use, and no data are copied out of buffers. `with_textures` also reads normals, texture coordinates and pictures;
/// faulty ones are omitted.
Result<GltfModel> load_gltf_model(const std::string& path, std::vector<Finding>& findings, bool with_textures = false);

}  // namespace exitance
