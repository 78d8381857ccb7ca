#pragma once

#include <cstdint>
#include <string>

#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance {

/// Owns a handle of the HDF5 library. Negative if the call that created it failed.
class Hdf5Handle {
  public:
    explicit Hdf5Handle(std::int64_t id) : id_(id) {}
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    ~Hdf5Handle();
    operator std::int64_t() const { return id_; }

  private:
    std::int64_t id_;
};

/// The library's type for numbers in memory, and in files, where they are always little-endian.
std::int64_t hdf5_native_type(Hdf5Type type);
std::int64_t hdf5_stored_type(Hdf5Type type);

/// The library's innermost message about the current error, such as " (bad object header)"; may be empty.
std::string hdf5_says();

/// Stops the library from printing messages to standard error.
void quieten_hdf5();

/// True for text of fixed length. Other types are not read, since rarely used parts of the library are less robust.
bool is_fixed_text(std::int64_t type);
/// True for a number without padding bits, in either byte order.
bool is_plain_number(std::int64_t type);

/// Limit on the memory for reading a file, bytes. Files shrink little by compression, since most of their content is
/// digits of light.
constexpr std::size_t hdf5_room_for(std::uint64_t file_bytes) {
    return 10 * static_cast<std::size_t>(file_bytes) + (std::size_t{64} << 20);
}

/// True if a data set may be read: the bytes stored for it can unpack to `items` items of `item_bytes`, and the items,
/// with at least 8 bytes each, fit into hdf5_room_for(file_bytes).
bool holds_really(std::int64_t set, std::size_t item_bytes, std::size_t items, std::uint64_t file_bytes);

}  // namespace exitance
