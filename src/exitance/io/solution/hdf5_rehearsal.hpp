#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace exitance {

/// Lets the HDF5 library read every data set and attribute of a solution, as they stand in the file, and drops them.
/// The library takes bytes on trust that are damaged on purpose, whose checksums are right: it may crash, or go on for
/// ever. Hence not in this process but by rehearse_hdf5.
/// path        file of file_bytes bytes
/// returns     whether everything could be opened; true for a file that cannot be opened at all, which does no harm
/// throws      std::bad_alloc where the library got less memory than it asked for
bool read_all_of_hdf5(const std::string& path, std::uint64_t file_bytes);

/// The same in a copy of this process that is thrown away: 2 s and 0.1 us a byte, and hdf5_room_for the file, are its
/// limits. Returns how the library failed, as the end of "the HDF5 library ...", or nothing.
std::optional<std::string> rehearse_hdf5(const std::string& path, std::uint64_t file_bytes);

}  // namespace exitance
