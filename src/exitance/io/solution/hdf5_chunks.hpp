#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance {

/// How the chunks of a big set are filtered: bytes shuffled by their place in an item, then deflated (gzip level 1); or
/// Fletcher's checksum behind them.
///
/// The library has filters of its own for both, which one thread runs, chunk after chunk. These give the same bytes,
/// which any HDF5 library reads, and several threads pack and unpack different chunks.
struct Hdf5Filters {
    std::size_t item_bytes = 1;
    bool deflates = false;

    /// The bytes of a chunk as they stand in the file. O(bytes).
    void pack(std::span<const std::byte> chunk, std::vector<std::byte>& packed) const;
    /// And back; false where they do not make a chunk of just that size, or its checksum is another one.
    bool unpack(std::span<const std::byte> packed, std::span<std::byte> chunk) const;
    /// What a chunk of so many bytes has packed at most.
    std::size_t most_packed(std::size_t chunk_bytes) const;
};

/// So many chunks are held and packed, or unpacked, at a time.
constexpr std::size_t hdf5_chunks_together = 16;

/// Reads all rows of a chunked set, unpacked by all threads. False where the set is not stored as Hdf5Writer stores
/// such numbers, or something about it is damaged: then nothing is said, and it is the library's to read it, or say why
/// not.
/// set   the library's handle      out   bytes of all rows of `columns` numbers
bool read_hdf5_chunks(std::int64_t set, Hdf5Type type, std::size_t columns, std::span<std::byte> out);

}  // namespace exitance
