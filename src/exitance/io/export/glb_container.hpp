#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

using Float3 = std::array<float, 3>;

/// Converts Z up to glTF's Y up.
inline Float3 y_up(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.z), static_cast<float>(-v.y)};
}

/// A part of the vertices and of the indices of a mesh, with the bounds of its positions, which glTF requires.
struct GlbPart {
    std::size_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
    Float3 lo = {HUGE_VALF, HUGE_VALF, HUGE_VALF}, hi = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

    void include(const Float3& position);
};

/// Adds an item to a JSON list without brackets.
void add_item(std::string& list, const std::string& item);

/// Formats three numbers as a JSON array.
std::string json_triple(const Float3& v);
std::string json_triple(const std::array<double, 3>& v);

/// Formats the accessor of a part of a vertex array: buffer view `view`, `stride` bytes per vertex, glTF's `type`.
/// with_bounds  also gives the bounds, as required for positions
std::string vertex_accessor(const GlbPart& part, std::size_t view, std::size_t stride, const char* type,
                            bool with_bounds);
/// Formats the accessor of a part of the indices, 32 bits each.
std::string index_accessor(const GlbPart& part, std::size_t view);

/// Writes a .glb file: a header, the JSON chunk, and a binary chunk of the concatenated `parts`. The length of `json`,
/// and of all parts together, must be a multiple of 4. `instead` is the hint in the error if the file would exceed 4
/// GiB.
Result<void> write_glb_container(const std::string& path, const std::string& json,
                                 std::span<const std::span<const std::byte>> parts, const std::string& instead);

}  // namespace exitance
