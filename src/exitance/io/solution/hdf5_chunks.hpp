#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance {

/// Filters for the chunks of a large data set: bytes are shuffled by their position in an item and deflated (gzip level
/// 1), or followed by Fletcher's checksum.
///
/// The HDF5 library has both filters, but runs them in one thread, chunk by chunk. These functions produce the same
/// bytes, which any HDF5 library can read, and allow several threads to pack and unpack different chunks.
struct Hdf5Filters {
    std::size_t item_bytes = 1;
    bool deflates = false;

    /// Computes the bytes of a chunk as stored in the file. O(bytes).
    void pack(std::span<const std::byte> chunk, std::vector<std::byte>& packed) const;
    /// Inverse of pack(). Returns false if the bytes do not give a chunk of exactly that size, or if the checksum is
    /// wrong.
    bool unpack(std::span<const std::byte> packed, std::span<std::byte> chunk) const;
    /// Upper bound of the packed size of a chunk, bytes.
    std::size_t max_packed(std::size_t chunk_bytes) const;
};

/// Number of chunks that are held in memory and packed or unpacked at a time.
constexpr std::size_t hdf5_chunks_together = 16;

/// Reads all rows of a chunked data set and unpacks them with all threads. Returns false, without an error message, if
/// the set is damaged or not stored in the way that Hdf5Writer stores such numbers; the caller then uses the library,
/// which reads the set or reports the error.
/// set  the library's handle
/// out  receives the bytes of all rows, each of `columns` numbers
bool read_hdf5_chunks(std::int64_t set, Hdf5Type type, std::size_t columns, std::span<std::byte> out);

}  // namespace exitance
