#include <fmt/format.h>

#include "exitance/base/version.hpp"
#include "exitance/io/export/export_links_glb.hpp"
#include "exitance/io/export/glb_container.hpp"

namespace exitance {
namespace {

/// Line meshes as JSON lists, and their vertices.
class LineMeshes {
  public:
    /// Adds a mesh of lines, two points per line, metres, Z up.
    void add(const char* name, std::span<const Point> ends, const Float3& colour) {
        if (ends.empty()) return;
        GlbPart part{.first_vertex = vertices_.size(), .vertices = ends.size()};
        for (const Point& p : ends) {
            vertices_.push_back(y_up(p));
            part.include(vertices_.back());
        }
        const char* const comma = count_ > 0 ? "," : "";
        nodes_ += fmt::format("{}{{\"mesh\":{},\"name\":\"{}\"}}", comma, count_, name);
        constexpr int line_list = 1;
        meshes_ += fmt::format(
            "{}{{\"name\":\"{}\",\"primitives\":[{{\"attributes\":{{\"POSITION\":{}}},\"mode\":{},\"material\":{}}}]}}",
            comma, name, count_, line_list, count_);
        materials_ += fmt::format(
            "{}{{\"name\":\"{}\",\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{},{},{},1]}},\"extensions\":{{"
            "\"KHR_materials_unlit\":{{}}}}}}",
            comma, name, colour[0], colour[1], colour[2]);
        add_item(accessors_, vertex_accessor(part, 0, sizeof(Float3), "VEC3", true));
        scene_ += fmt::format("{}{}", comma, count_++);
    }

    std::string json() const {
        const std::size_t bytes = vertices_.size() * sizeof(Float3);
        std::string out = fmt::format(
            "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"exitance {}\"}},\"extensionsUsed\":["
            "\"KHR_materials_unlit\"],\"scene\":0,\"scenes\":[{{\"nodes\":[{}]}}],\"nodes\":[{}],\"meshes\":[{}],"
            "\"materials\":[{}],\"accessors\":[{}],\"bufferViews\":[{{\"buffer\":0,\"byteLength\":{},\"byteStride\":12,"
            "\"target\":34962}}],\"buffers\":[{{\"byteLength\":{}}}]}}",
            program_version, scene_, nodes_, meshes_, materials_, accessors_, bytes, bytes);
        out.resize((out.size() + 3) / 4 * 4, ' ');
        return out;
    }
    const std::vector<Float3>& vertices() const { return vertices_; }

  private:
    std::string nodes_, meshes_, materials_, accessors_, scene_;
    std::vector<Float3> vertices_;
    std::size_t count_ = 0;
};

std::vector<Point> outlines(const ElementTree& tree, std::span<const ElementId> elements) {
    std::vector<Point> ends;
    for (ElementId e : elements) {
        const std::vector<Point> outline = tree.outline(e);
        for (std::size_t i = 0; i < outline.size(); ++i) {
            ends.push_back(outline[i]);
            ends.push_back(outline[(i + 1) % outline.size()]);
        }
    }
    return ends;
}

}  // namespace

Result<void> write_links_glb(const ElementTree& tree, std::span<const ElementId> receivers,
                             std::span<const ElementId> sources, std::span<const KeptLink> links,
                             const std::string& path) {
    std::vector<Point> ends;
    for (const KeptLink& link : links)
        for (const ElementId e : {link.source, link.receiver}) ends.push_back(tree.patch(e).at(tree.centre(e)));
    LineMeshes lines;
    lines.add("receivers", outlines(tree, receivers), {0.8f, 0.1f, 0.05f});
    lines.add("sources", outlines(tree, sources), {0.05f, 0.2f, 0.7f});
    lines.add("links", ends, {0.9f, 0.6f, 0.05f});

    const std::string json = lines.json();
    const std::span<const std::byte> vertices = std::as_bytes(std::span(lines.vertices()));
    return write_glb_container(path, json, std::span(&vertices, 1), "export .csv");
}

}  // namespace exitance
