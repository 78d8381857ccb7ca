#pragma once

#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance::test {

/// Builds a glTF file. Numbers are added to the buffer, and every array gets its own accessor and view.
class GltfText {
  public:
    int positions(const std::vector<Point>& points) {
        std::vector<float> numbers;
        for (const Point& p : points)
            for (std::size_t k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(p[k]));
        return add(numbers.data(), numbers.size() * 4, 5126, "VEC3", points.size());
    }
    int indices(const std::vector<std::uint16_t>& numbers) {
        return add(numbers.data(), numbers.size() * 2, 5123, "SCALAR", numbers.size());
    }
    /// Adds bytes as an array of `count` items of a glTF component type (5120 to 5126).
    int add(const void* bytes, std::size_t size, int component, const char* type, std::size_t count) {
        const int view = add_view(bytes, size);
        accessors += (accessors.empty() ? "" : ",") + std::string("{\"bufferView\":") + std::to_string(view) +
                     ",\"componentType\":" + std::to_string(component) + ",\"type\":\"" + type +
                     "\",\"count\":" + std::to_string(count) + "}";
        return accessor_count++;
    }
    int add_view(const void* bytes, std::size_t size) {
        data.resize((data.size() + 3) / 4 * 4);
        views += (views.empty() ? "" : ",") + std::string("{\"buffer\":0,\"byteOffset\":") +
                 std::to_string(data.size()) + ",\"byteLength\":" + std::to_string(size) + "}";
        data.append(static_cast<const char*>(bytes), size);
        return view_count++;
    }

    std::string json(const std::string& buffer_uri = "") const {
        const auto list = [](const char* name, const std::string& items) {
            return items.empty() ? "" : ",\"" + std::string(name) + "\":[" + items + "]";
        };
        return "{\"asset\":{\"version\":\"2.0\"}" + list("nodes", nodes) + list("meshes", meshes) +
               list("materials", materials) + list("textures", textures) + list("images", images) +
               list("cameras", cameras) + list("accessors", accessors) + list("bufferViews", views) +
               (data.empty() ? ""
                             : ",\"buffers\":[{\"byteLength\":" + std::to_string(data.size()) +
                                   (buffer_uri.empty() ? "" : ",\"uri\":\"" + buffer_uri + "\"") + "}]") +
               more + "}";
    }
    /// Returns the binary container.
    std::string glb() const {
        std::string text = json();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string bytes = data;
        bytes.resize((bytes.size() + 3) / 4 * 4);
        const std::size_t chunk = bytes.empty() ? 0 : 8 + bytes.size();
        std::string out = "glTF" + number(2) + number(20 + text.size() + chunk) + number(text.size()) + "JSON" + text;
        if (chunk > 0) out += number(bytes.size()) + std::string("BIN\0", 4) + bytes;
        return out;
    }

    std::string nodes, meshes, materials, textures, images, cameras, accessors, views, more, data;

  private:
    static std::string number(std::size_t n) {
        const auto value = static_cast<std::uint32_t>(n);
        std::string out(4, '\0');
        std::memcpy(out.data(), &value, 4);
        return out;
    }
    int accessor_count = 0, view_count = 0;
};

}  // namespace exitance::test
