#pragma once

#include <cstdint>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {

/// Has the library write a file that it makes with this list of properties to `output`, which must outlive it. What the
/// system refuses is kept there: to the library everything is written, since it does not come to an end with files that
/// it can neither write nor give up.
void set_hdf5_output(std::int64_t file_access, AtomicFile& output);

}  // namespace exitance
