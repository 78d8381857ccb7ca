#pragma once

#include <cstdint>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {

/// Makes the library write a file created with this property list to `output`, which must outlive the file. System
/// errors are stored in `output` and hidden from the library, which cannot close a file that it fails to write.
void set_hdf5_output(std::int64_t file_access, AtomicFile& output);

}  // namespace exitance
