#pragma once

#include <cstdint>
#include <string>

#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance {

/// A handle of the HDF5 library, given back at the end of its scope. Negative when what made it failed.
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

/// The library's type of such numbers in memory, and in files: little-endian there, wherever they are written.
std::int64_t hdf5_native_type(Hdf5Type type);
std::int64_t hdf5_stored_type(Hdf5Type type);

/// The library's own words for the failure at hand, as far down as they go: " (bad object header)", or nothing.
std::string hdf5_says();

/// No words of the library on standard error.
void quieten_hdf5();

/// What is agreed to be read: anything else goes little-trodden ways of the library.
bool is_fixed_text(std::int64_t type);
/// A number whose bits all count, in the order of some machine.
bool is_plain_number(std::int64_t type);

/// What reading a file may take at a time, bytes: what is written shrinks little, since most of it are digits of light.
constexpr std::size_t hdf5_room_for(std::uint64_t file_bytes) {
    return 10 * static_cast<std::size_t>(file_bytes) + (std::size_t{64} << 20);
}

/// May a set of so many items be read: do the bytes that the file holds for it make so many, after unpacking, and are
/// they no more than a file of this size may ask for, 8 bytes each at most?
bool holds_really(std::int64_t set, std::size_t item_bytes, std::size_t items, std::uint64_t file_bytes);

}  // namespace exitance
