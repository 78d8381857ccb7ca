#include "exitance/io/scenes/gltf/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace exitance {
namespace {

Error bad(std::string message) {
    return {ErrorCode::bad_input, std::move(message), "", ""};
}

std::optional<GltfRows::Number> number_of(int component) {
    switch (component) {
        case 5120:
            return GltfRows::Number::int8;
        case 5121:
            return GltfRows::Number::uint8;
        case 5122:
            return GltfRows::Number::int16;
        case 5123:
            return GltfRows::Number::uint16;
        case 5125:
            return GltfRows::Number::uint32;
        case 5126:
            return GltfRows::Number::float32;
        default:
            return std::nullopt;
    }
}

/// True if `count` rows of `row` bytes, `stride` bytes apart, fit into `bytes` bytes from `offset` on.
bool fits(std::size_t bytes, std::size_t offset, std::size_t stride, std::size_t row, std::size_t count) {
    if (count == 0) return true;
    if (offset > bytes || row > bytes - offset || stride == 0) return false;
    return count - 1 <= (bytes - offset - row) / stride;
}

}  // namespace

Result<GltfRows> GltfAccessorCheck::rows(const GltfAccessor& a, std::size_t width, bool is_index,
                                         const std::string& what) {
    const auto number = number_of(a.component);
    if (!number) return bad(fmt::format("{} do not have the expected type", what));
    const bool whole = *number == GltfRows::Number::uint8 || *number == GltfRows::Number::uint16 ||
                       *number == GltfRows::Number::uint32;
    if (is_index && !whole) return bad(fmt::format("{} are not whole numbers", what));
    const std::size_t row = width * GltfRows::bytes(*number);
    GltfRows out;
    if (a.view >= 0) {
        if (!a.bytes)
            return bad(fmt::format("{} refer to bytes that the file does not have (buffer view {})", what, a.view));
        const std::size_t stride = a.stride == 0 ? row : a.stride;
        if (stride < row || !fits(a.bytes->size(), a.first, stride, row, a.count))
            return bad(fmt::format("{} are {} rows from byte {} on, but there are only {} bytes", what, a.count,
                                   a.first, a.bytes->size()));
        out = GltfRows(a.bytes->data() + a.first, stride, a.count, *number, a.normalized);
    } else if (!a.sparse) {
        return bad(fmt::format("{} have no data", what));
    } else if (a.count > file_bytes_) {
        return bad(fmt::format("{} are {} rows of zeros, more than the file has bytes", what, a.count));
    }
    return a.sparse ? fill_sparse(a, width, *number, out, what) : Result<GltfRows>(out);
}

/// Copies the rows and replaces the sparse ones. The copies are bounded by the file's size.
Result<GltfRows> GltfAccessorCheck::fill_sparse(const GltfAccessor& a, std::size_t width, GltfRows::Number number,
                                                const GltfRows& base, const std::string& what) {
    const GltfAccessor::Sparse& sparse = *a.sparse;
    const auto count = static_cast<std::size_t>(std::max<std::int64_t>(sparse.count, 0));
    const auto place_number = number_of(sparse.place_component);
    const std::size_t row = width * GltfRows::bytes(number);
    if (!sparse.places || !sparse.values || !place_number || sparse.first_place < 0 || sparse.first_value < 0)
        return bad(fmt::format("{} are sparse, and their replacements are missing", what));
    const auto first_place = static_cast<std::size_t>(sparse.first_place),
               first_value = static_cast<std::size_t>(sparse.first_value);
    const std::size_t place_size = GltfRows::bytes(*place_number);
    if (!fits(sparse.places->size(), first_place, place_size, place_size, count) ||
        !fits(sparse.values->size(), first_value, row, row, count))
        return bad(fmt::format("{} are sparse, and their replacements are incomplete", what));
    copied_ += row * a.count;
    if (copied_ > 8 * file_bytes_) return bad(fmt::format("{} are sparse, and too many for the file", what));
    std::vector<std::uint8_t>& bytes = copies_.emplace_back(row * a.count);
    const GltfRows place(sparse.places->data() + first_place, place_size, count, *place_number, false);
    if (a.view >= 0) base.copy_to(bytes.data(), row);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = place.index(i);
        if (at >= a.count) return bad(fmt::format("{} are sparse, and row {} of {} is replaced", what, at, a.count));
        std::memcpy(bytes.data() + at * row, sparse.values->data() + first_value + i * row, row);
    }
    return GltfRows(bytes.data(), row, a.count, number, a.normalized);
}

}  // namespace exitance
