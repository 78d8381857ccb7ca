#pragma once

#include <cstdint>
#include <string_view>

namespace exitance {

/// The checksum of HDF5's metadata: the hash function lookup3. Source: [Jenkins06]. O(n).
std::uint32_t hdf5_checksum(std::string_view bytes);

}  // namespace exitance
