#include "exitance/io/scenes/gltf/gltf_model.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {

std::size_t GltfRows::bytes(Number number) {
    switch (number) {
        case Number::int8:
        case Number::uint8:
            return 1;
        case Number::int16:
        case Number::uint16:
            return 2;
        default:
            return 4;
    }
}

double GltfRows::at(std::size_t row, std::size_t k) const {
    switch (number_) {
        case Number::float32:
            return static_cast<double>(value<float>(row, k));
        case Number::uint32:
            return value<std::uint32_t>(row, k);
        case Number::int16: {
            const double v = value<std::int16_t>(row, k);
            return normalized_ ? std::max(v / 32767, -1.0) : v;
        }
        case Number::uint16:
            return value<std::uint16_t>(row, k) / (normalized_ ? 65535.0 : 1.0);
        case Number::int8: {
            const double v = value<std::int8_t>(row, k);
            return normalized_ ? std::max(v / 127, -1.0) : v;
        }
        case Number::uint8:
            return value<std::uint8_t>(row, k) / (normalized_ ? 255.0 : 1.0);
    }
    return 0;
}

std::uint32_t GltfRows::index(std::size_t row) const {
    switch (number_) {
        case Number::uint8:
            return value<std::uint8_t>(row, 0);
        case Number::uint16:
            return value<std::uint16_t>(row, 0);
        default:
            return value<std::uint32_t>(row, 0);
    }
}

std::optional<Affine> gltf_transform(std::span<const double> matrix, std::span<const double> rotation,
                                     std::span<const double> scale, std::span<const double> translation) {
    Affine m;
    if (matrix.size() == 16) {
        const auto column = [&](std::size_t c) { return Vec3{matrix[4 * c], matrix[4 * c + 1], matrix[4 * c + 2]}; };
        m = {column(0), column(1), column(2), column(3)};
    } else {
        if (rotation.size() == 4) {
            double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
            const double length = std::sqrt(x * x + y * y + z * z + w * w);
            if (!(length > 0)) return std::nullopt;
            x /= length, y /= length, z /= length, w /= length;
            m.x = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
            m.y = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
            m.z = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
        }
        if (scale.size() == 3) m.x *= scale[0], m.y *= scale[1], m.z *= scale[2];
        if (translation.size() == 3) m.origin = {translation[0], translation[1], translation[2]};
    }
    if (!is_finite(m.x) || !is_finite(m.y) || !is_finite(m.z) || !is_finite(m.origin)) return std::nullopt;
    return m;
}

namespace {

/// Vertex indices of triangle `t`.
std::array<std::size_t, 3> vertices_of(const GltfModel::Primitive& p, std::size_t t) {
    std::array<std::size_t, 3> at = {3 * t, 3 * t + 1, 3 * t + 2};
    if (p.mode == GltfModel::Mode::strip) at = {t, t + 1 + t % 2, t + 2 - t % 2};
    if (p.mode == GltfModel::Mode::fan) at = {t + 1, t + 2, 0};
    if (p.has_indices)
        for (std::size_t& i : at) i = p.indices.index(i);
    return at;
}

class TriangleVisitor {
  public:
    TriangleVisitor(const GltfModel& model, const std::function<void(const GltfTriangle&)>& visit)
        : model_(model), visit_(visit), seen_(model.nodes.size()) {}

    void descend(int number, const Affine& parent, int depth) {
        constexpr int max_depth = 1000;
        const auto at = static_cast<std::size_t>(number);
        if (seen_[at] || depth > max_depth) return;
        seen_[at] = true;
        const GltfModel::Node& node = model_.nodes[at];
        const Affine to_world = parent * node.to_parent;
        if (node.mesh >= 0)
            for (const GltfModel::Primitive& p : model_.meshes[static_cast<std::size_t>(node.mesh)].primitives)
                add(at, p, to_world);
        for (const int child : node.children) descend(child, to_world, depth + 1);
    }

  private:
    void add(std::size_t node, const GltfModel::Primitive& p, const Affine& to_world) {
        const bool is_mirrored = to_world.determinant() < 0;
        // Cofactors of the matrix: normals stay perpendicular to surfaces that are scaled unevenly.
        const double side = is_mirrored ? -1 : 1;
        const Affine turn{side * cross(to_world.y, to_world.z),
                          side * cross(to_world.z, to_world.x),
                          side * cross(to_world.x, to_world.y),
                          {}};
        for (std::size_t t = 0, count = p.triangle_count(); t < count; ++t) {
            GltfTriangle triangle{node, &p, vertices_of(p, t), {}, {}};
            std::array<std::size_t, 3>& v = triangle.vertices;
            if (std::max({v[0], v[1], v[2]}) >= p.positions.size()) continue;
            if (is_mirrored) std::swap(v[1], v[2]);
            std::array<Point, 3>& corner = triangle.corners;
            for (std::size_t k = 0; k < 3; ++k) corner[k] = to_world.point(p.positions.point(v[k]));
            for (std::size_t k = 0; k < 3 && p.normals.size() > 0; ++k)
                if (const Vec3 n = turn.vector(p.normals.point(v[k])); norm(n) > 0) triangle.normals[k] = normalized(n);
            if (norm(cross(corner[1] - corner[0], corner[2] - corner[0])) > 0) visit_(triangle);
        }
    }

    const GltfModel& model_;
    const std::function<void(const GltfTriangle&)>& visit_;
    std::vector<bool> seen_;
};

}  // namespace

void for_each_triangle(const GltfModel& model, const std::function<void(const GltfTriangle&)>& visit) {
    constexpr Affine upright{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}};  // rotates Y up to Z up
    TriangleVisitor visitor(model, visit);
    for (const int root : model.roots) visitor.descend(root, upright, 0);
}

}  // namespace exitance
