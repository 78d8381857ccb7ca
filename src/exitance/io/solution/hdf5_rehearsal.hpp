#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace exitance {

/// Makes the HDF5 library read every data set and attribute of a solution file and discards the values. The library
/// trusts its input: if metadata are changed and their checksums are corrected, it may crash or never return. So do not
/// call this function directly but through rehearse_hdf5().
/// path     path of a file of `file_bytes` bytes
/// returns  true if all objects could be opened, or if the file cannot be opened at all, which is harmless
/// throws   std::bad_alloc if the library ran out of memory
bool read_all_of_hdf5(const std::string& path, std::uint64_t file_bytes);

/// Runs read_all_of_hdf5() in a copy of this process, which is then discarded. Limits: 2 s plus 0.1 us per byte, and
/// hdf5_room_for(file_bytes) bytes of memory. Returns how the library failed, as the end of "the HDF5 library ...", or
/// nothing.
std::optional<std::string> rehearse_hdf5(const std::string& path, std::uint64_t file_bytes);

}  // namespace exitance
