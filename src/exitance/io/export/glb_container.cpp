#include "exitance/io/export/glb_container.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <initializer_list>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {

void GlbPart::include(const Float3& position) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        lo[axis] = std::min(lo[axis], position[axis]), hi[axis] = std::max(hi[axis], position[axis]);
}

void add_item(std::string& list, const std::string& item) {
    list += (list.empty() ? "" : ",") + item;
}

std::string json_triple(const Float3& v) {
    return fmt::format("[{},{},{}]", v[0], v[1], v[2]);
}

std::string json_triple(const std::array<double, 3>& v) {
    return fmt::format("[{},{},{}]", v[0], v[1], v[2]);
}

std::string vertex_accessor(const GlbPart& part, std::size_t view, std::size_t stride, const char* type,
                            bool with_bounds) {
    const std::string bounds =
        with_bounds ? fmt::format(",\"min\":{},\"max\":{}", json_triple(part.lo), json_triple(part.hi)) : "";
    return fmt::format("{{\"bufferView\":{},\"byteOffset\":{},\"componentType\":5126,\"count\":{},\"type\":\"{}\"{}}}",
                       view, part.first_vertex * stride, part.vertices, type, bounds);
}

std::string index_accessor(const GlbPart& part, std::size_t view) {
    return fmt::format(
        "{{\"bufferView\":{},\"byteOffset\":{},\"componentType\":5125,\"count\":{},\"type\":\"SCALAR\"}}", view,
        part.first_index * 4, part.indices);
}

Result<void> write_glb_container(const std::string& path, const std::string& json,
                                 std::span<const std::span<const std::byte>> parts, const std::string& instead) {
    static_assert(std::endian::native == std::endian::little);
    std::size_t binary = 0;
    for (const auto& part : parts) binary += part.size();
    const std::size_t total = 12 + 8 + json.size() + 8 + binary;
    if (total > 0xffffffffu)
        return Error{ErrorCode::cannot_write,
                     "cannot write " + path + ": a .glb file holds at most 4 GiB, this one needs " +
                         std::to_string(total >> 20) + " MiB",
                     path, instead};
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    const auto words = [&](std::initializer_list<std::size_t> values) {
        for (const std::size_t value : values) {
            const auto word = static_cast<std::uint32_t>(value);
            file->write(std::as_bytes(std::span(&word, 1)));
        }
    };
    words({0x46546c67, 2, total, json.size(), 0x4e4f534a});  // "glTF", version, length; "JSON"
    file->write(json);
    words({binary, 0x004e4942});  // "BIN"
    for (const auto& part : parts) file->write(part);
    return file->commit();
}

}  // namespace exitance
