#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"

namespace exitance {

/// What a glTF file says about rows of numbers, before it is believed.
struct GltfAccessor {
    using Bytes = std::optional<std::span<const std::uint8_t>>;  ///< Of a buffer view; nothing: they are not there.

    int component = 0;  ///< The file's number of a kind of number: 5120 to 5126.
    std::size_t count = 0;
    bool normalized = false;
    int view = -1;           ///< The number of the buffer view, -1 for rows of zeros,
    Bytes bytes = {};        ///< what it holds,
    std::size_t first = 0;   ///< where the rows begin in it,
    std::size_t stride = 0;  ///< and how far apart they are; 0: close together.

    struct Sparse {
        std::int64_t count = 0;
        int place_component = 0;
        Bytes places = {}, values = {};
        std::int64_t first_place = 0, first_value = 0;  ///< Bytes.
    };
    std::optional<Sparse> sparse = {};  ///< Rows that are replaced.
};

/// Checks accessors of one file. Only sparse ones are copied, all of them together to at most eight times the bytes of
/// the file.
class GltfAccessorCheck {
  public:
    /// file_bytes  of the file or the largest of its buffers
    /// copies      what rows point into that no buffer holds
    GltfAccessorCheck(std::uint64_t file_bytes, std::vector<std::vector<std::uint8_t>>& copies)
        : file_bytes_(file_bytes), copies_(copies) {}

    /// The rows, of `width` numbers, if all of them are there; an error calls them `what`. O(1) but for sparse ones.
    Result<GltfRows> rows(const GltfAccessor& a, std::size_t width, bool is_index, const std::string& what);

  private:
    Result<GltfRows> fill_sparse(const GltfAccessor& a, std::size_t width, GltfRows::Number number,
                                 const GltfRows& base, const std::string& what);

    std::uint64_t file_bytes_, copied_ = 0;
    std::vector<std::vector<std::uint8_t>>& copies_;
};

}  // namespace exitance
