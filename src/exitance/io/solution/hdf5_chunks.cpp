#include "exitance/io/solution/hdf5_chunks.hpp"

#include <hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "exitance/base/check.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/io/solution/hdf5_library.hpp"

namespace exitance {
namespace {

// Files are little-endian, and chunks are stored with the byte order of memory.
static_assert(std::endian::native == std::endian::little);

constexpr std::size_t checksum_bytes = 4;
/// Limit on the bytes of a chunk unpacked here: four times the size that is written.
constexpr std::size_t max_chunk_bytes = 1 << 20;

/// Stores the first bytes of all items, then the second bytes, and so on.
void shuffle(std::span<const std::byte> items, std::size_t item_bytes, std::byte* out) {
    const std::size_t count = items.size() / item_bytes;
    for (std::size_t k = 0; k < item_bytes; ++k)
        for (std::size_t i = 0; i < count; ++i) *out++ = items[i * item_bytes + k];
}

void unshuffle(std::span<const std::byte> bytes, std::size_t item_bytes, std::span<std::byte> items) {
    const std::size_t count = items.size() / item_bytes;
    const std::byte* in = bytes.data();
    for (std::size_t k = 0; k < item_bytes; ++k)
        for (std::size_t i = 0; i < count; ++i) items[i * item_bytes + k] = *in++;
}

/// Fletcher's checksum of big-endian words of 16 bits, as defined by the HDF5 library.
std::uint32_t fletcher32(std::span<const std::byte> bytes) {
    EXI_ASSERT(bytes.size() % 2 == 0);
    constexpr std::size_t before_carry = 360;  // number of words that can be added before a sum exceeds 32 bits
    std::uint32_t low = 0, high = 0;
    const auto fold = [](std::uint32_t sum) { return (sum & 0xffff) + (sum >> 16); };
    const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(bytes[i]); };
    for (std::size_t word = 0, words = bytes.size() / 2; word < words;) {
        for (const std::size_t end = std::min(words, word + before_carry); word < end; ++word)
            low += byte(2 * word) << 8 | byte(2 * word + 1), high += low;
        low = fold(low), high = fold(high);
    }
    return fold(high) << 16 | fold(low);
}

}  // namespace

std::size_t Hdf5Filters::max_packed(std::size_t chunk_bytes) const {
    return deflates ? compressBound(chunk_bytes) : chunk_bytes + checksum_bytes;
}

void Hdf5Filters::pack(std::span<const std::byte> chunk, std::vector<std::byte>& packed) const {
    packed.resize(max_packed(chunk.size()));
    if (!deflates) {
        const std::uint32_t sum = fletcher32(chunk);
        std::copy(chunk.begin(), chunk.end(), packed.begin());
        std::memcpy(packed.data() + chunk.size(), &sum, checksum_bytes);
        return;
    }
    std::vector<std::byte> shuffled(chunk.size());
    shuffle(chunk, item_bytes, shuffled.data());
    uLongf size = packed.size();
    constexpr int fastest = 1;
    const int done = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(shuffled.data()), shuffled.size(), fastest);
    EXI_CHECK(done == Z_OK);
    packed.resize(size);
}

bool Hdf5Filters::unpack(std::span<const std::byte> packed, std::span<std::byte> chunk) const {
    if (!deflates) {
        if (packed.size() != chunk.size() + checksum_bytes || chunk.size() % 2 != 0) return false;
        std::uint32_t sum = 0;
        std::memcpy(&sum, packed.data() + chunk.size(), checksum_bytes);
        std::copy_n(packed.begin(), chunk.size(), chunk.begin());
        return sum == fletcher32(chunk);
    }
    std::vector<std::byte> shuffled(chunk.size());
    uLongf size = shuffled.size();
    if (uncompress(reinterpret_cast<Bytef*>(shuffled.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK ||
        size != chunk.size())
        return false;
    unshuffle(shuffled, item_bytes, chunk);
    return true;
}

namespace {

/// Storage of a data set that was written by Hdf5Writer.
struct Stored {
    Hdf5Filters filters;
    std::size_t rows = 0, together = 0;  ///< Number of rows of the set, and of each chunk.
};

bool has_filter(hid_t creation, unsigned i, H5Z_filter_t wanted) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    return H5Pget_filter2(creation, i, &flags, &values, nullptr, 0, nullptr, &config) == wanted;
}

std::optional<Stored> stored_as(hid_t set, Hdf5Type type, std::size_t columns) {
    const Hdf5Handle creation(H5Dget_create_plist(set)), space(H5Dget_space(set)), held(H5Dget_type(set));
    const int rank = columns == 1 ? 1 : 2;
    std::array<hsize_t, 2> extent{0, 1}, chunk{0, 1};
    if (H5Pget_layout(creation) != H5D_CHUNKED || H5Tequal(held, hdf5_stored_type(type)) <= 0 ||
        H5Sget_simple_extent_ndims(space) != rank || H5Pget_chunk(creation, 2, chunk.data()) != rank ||
        H5Sget_simple_extent_dims(space, extent.data(), nullptr) != rank)
        return {};
    Stored out{{H5Tget_size(held), false}, extent[0], chunk[0]};
    const int filters = H5Pget_nfilters(creation);
    if (filters == 2 && has_filter(creation, 0, H5Z_FILTER_SHUFFLE) && has_filter(creation, 1, H5Z_FILTER_DEFLATE))
        out.filters.deflates = true;
    else if (filters != 1 || !has_filter(creation, 0, H5Z_FILTER_FLETCHER32))
        return {};
    const bool whole_rows = extent[1] == columns && chunk[1] == columns && out.together > 0;
    if (!whole_rows || out.together > max_chunk_bytes / (columns * out.filters.item_bytes)) return {};
    return out;
}

/// Reads a chunk as stored in the file. Returns false if it has more than `most` bytes or lacks a filter.
bool read_packed(hid_t set, std::size_t first_row, std::size_t most, std::vector<std::byte>& packed) {
    const std::array<hsize_t, 2> at{first_row, 0};
    hsize_t size = 0;
    std::uint32_t skipped = 0;
    if (H5Dget_chunk_storage_size(set, at.data(), &size) < 0 || size == 0 || size > most) return false;
    packed.resize(size);
    return H5Dread_chunk(set, H5P_DEFAULT, at.data(), &skipped, packed.data()) >= 0 && skipped == 0;
}

}  // namespace

bool read_hdf5_chunks(std::int64_t set, Hdf5Type type, std::size_t columns, std::span<std::byte> out) {
    const std::optional<Stored> stored = stored_as(set, type, columns);
    if (!stored) return false;
    const std::size_t row_bytes = columns * stored->filters.item_bytes, chunk_bytes = stored->together * row_bytes,
                      most = stored->filters.max_packed(chunk_bytes);
    const std::size_t chunks = (stored->rows + stored->together - 1) / stored->together;
    if (out.size() != stored->rows * row_bytes) return false;
    std::array<std::vector<std::byte>, hdf5_chunks_together> packed;
    std::array<bool, hdf5_chunks_together> is_good{};
    for (std::size_t first = 0; first < chunks; first += hdf5_chunks_together) {
        const std::size_t count = std::min(hdf5_chunks_together, chunks - first);
        for (std::size_t k = 0; k < count; ++k)
            if (!read_packed(set, (first + k) * stored->together, most, packed[k])) return false;
        parallel_for(count, 1,
                     [&](std::size_t k) {
                         const std::size_t begin = (first + k) * chunk_bytes,
                                           size = std::min(chunk_bytes, out.size() - begin);
                         if (size == chunk_bytes) {
                             is_good[k] = stored->filters.unpack(packed[k], out.subspan(begin, size));
                             return;
                         }
                         std::vector<std::byte> whole(chunk_bytes);  // the last chunk extends beyond the last row
                         is_good[k] = stored->filters.unpack(packed[k], whole);
                         std::copy_n(whole.begin(), size, out.begin() + static_cast<std::ptrdiff_t>(begin));
                     },
                     {"unpack"});
        if (std::find(is_good.begin(), is_good.begin() + static_cast<std::ptrdiff_t>(count), false) !=
            is_good.begin() + static_cast<std::ptrdiff_t>(count))
            return false;
    }
    return true;
}

}  // namespace exitance
