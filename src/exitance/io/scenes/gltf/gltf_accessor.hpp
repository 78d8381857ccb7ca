#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"

namespace exitance {

/// Unchecked description of rows of numbers in a glTF file.
struct GltfAccessor {
    using Bytes = std::optional<std::span<const std::uint8_t>>;  ///< Bytes of a buffer view; empty if they are missing.

    int component = 0;  ///< glTF's code of the number type: 5120 to 5126.
    std::size_t count = 0;
    bool normalized = false;
    int view = -1;           ///< Index of the buffer view; -1 for rows of zeros.
    Bytes bytes = {};        ///< Content of the buffer view.
    std::size_t first = 0;   ///< Offset of the first row, bytes.
    std::size_t stride = 0;  ///< Distance of rows, bytes; 0: contiguous.

    struct Sparse {
        std::int64_t count = 0;
        int place_component = 0;
        Bytes places = {}, values = {};
        std::int64_t first_place = 0, first_value = 0;  ///< Offsets, bytes.
    };
    std::optional<Sparse> sparse = {};  ///< Rows that are replaced.
};

/// Checks the accessors of one file. Only sparse accessors are copied; all copies together have at most eight times the
/// bytes of the file.
class GltfAccessorCheck {
  public:
    /// `file_bytes`: size of the file or of its largest buffer. Copied rows are appended to `copies`, into which the
    /// rows returned by rows() may point.
    GltfAccessorCheck(std::uint64_t file_bytes, std::vector<std::vector<std::uint8_t>>& copies)
        : file_bytes_(file_bytes), copies_(copies) {}

    /// Returns the rows, each of `width` numbers. Error if rows are missing; `what` names the data in the message. O(1)
    /// except for sparse accessors.
    Result<GltfRows> rows(const GltfAccessor& a, std::size_t width, bool is_index, const std::string& what);

  private:
    Result<GltfRows> fill_sparse(const GltfAccessor& a, std::size_t width, GltfRows::Number number,
                                 const GltfRows& base, const std::string& what);

    std::uint64_t file_bytes_, copied_ = 0;
    std::vector<std::vector<std::uint8_t>>& copies_;
};

}  // namespace exitance
