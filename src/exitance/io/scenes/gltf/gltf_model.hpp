#pragma once

#include <array>
#include <cstdint>
#include <cstring>
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

/// Rows of numbers in the bytes of a buffer, every byte of them known to be there.
class GltfRows {
  public:
    enum class Number : std::uint8_t { int8, uint8, int16, uint16, uint32, float32 };

    GltfRows() = default;
    GltfRows(const std::uint8_t* first, std::size_t stride, std::size_t count, Number number, bool normalized)
        : first_(first), stride_(stride), count_(count), number_(number), normalized_(normalized) {}

    std::size_t size() const { return count_; }
    /// Number k of a row; of integers that stand for fractions, the fraction.
    double at(std::size_t row, std::size_t k) const;
    std::uint32_t index(std::size_t row) const;
    /// Copies rows of `bytes` bytes each to where they stand close together.
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

/// What a glTF file says, as far as light cares; indices are checked, numbers of a kind. Y up, metres.
struct GltfModel {
    enum class Mode : std::uint8_t { triangles, strip, fan };
    struct Primitive {
        GltfRows positions, indices;
        bool has_indices = false;
        int accessor = -1;  ///< Of the positions: primitives that share it share their points.
        int material = -1;
        Mode mode = Mode::triangles;
        std::array<GltfRows, 2>
            places;  ///< TEXCOORD_0 and 1 where textures were asked for; of no rows where there are none.
    };
    struct Mesh {
        std::string name;
        std::vector<Primitive> primitives;
    };
    struct Colour {
        double r = 0, g = 0, b = 0;
    };
    /// A picture, which set of places, how places go beyond its borders (glTF's numbers), and KHR_texture_transform.
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
        Colour base, emission;  ///< Factors times the means of their textures; emission in W/(m^2 sr).
        double metallic = 1;
        double diffuse_transmission = 0;  ///< Of KHR_materials_diffuse_transmission: of what leaves diffusely.
        double transmission = 0;  ///< Of KHR_materials_transmission: share of the light that goes straight through.
        bool double_sided = false, transparent = false;
        TextureUse base_texture, emission_texture;  ///< Where textures were asked for.
    };
    struct View {
        std::string name;
        double yfov = 1, aspect = 0;  ///< Radians from bottom to top; width over height, 0 if not said.
        double xmag = 0;              ///< Half the width of an orthographic view, m; 0: perspective.
    };
    struct Lamp {
        std::string name;
        PunctualLight::Kind kind = PunctualLight::Kind::point;
        Colour intensity;  ///< Colour times intensity: cd, of parallel light lx.
        double inner_cone = 0, outer_cone = pi / 4;
        bool has_range = false;
    };
    struct Node {
        std::string name;
        Affine to_parent;
        int mesh = -1, view = -1, lamp = -1;
        bool is_deformed = false;  ///< By a skin or morph targets, which stay in their rest pose.
        std::vector<int> children;
    };

    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<View> views;
    std::vector<Lamp> lamps;
    std::vector<Node> nodes;
    std::vector<int> roots;  ///< Nodes of the default scene.

    std::vector<std::span<const std::uint8_t>> pictures;  ///< Files, where textures were asked for; none: not there.

    std::vector<std::vector<std::uint8_t>> bytes;  ///< What the rows point into; moved, never copied.

    GltfModel() = default;
    GltfModel(GltfModel&&) = default;
    GltfModel& operator=(GltfModel&&) = default;
};

/// Translation, rotation (a quaternion: x, y, z, w) and scale of a node, or the 16 numbers of its matrix by columns, as
/// one map; what is empty changes nothing. Nothing where numbers are not finite or a quaternion is 0.
std::optional<Affine> gltf_transform(std::span<const double> matrix, std::span<const double> rotation,
                                     std::span<const double> scale, std::span<const double> translation);

/// Reads the model out of glTF's JSON or binary container; buffers and pictures beside the file are read too. What can
/// be done without goes to `findings`. Every index, count, offset and stride is checked against the data before use,
/// and nothing is copied out of buffers. `with_textures`: places and pictures, too; those that are faulty are left out.
Result<GltfModel> load_gltf_model(const std::string& path, std::vector<Finding>& findings, bool with_textures = false);

}  // namespace exitance
