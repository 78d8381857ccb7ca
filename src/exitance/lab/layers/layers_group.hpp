#pragma once

#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/lab/layers/light_layers.hpp"

namespace exitance {

/// Direct light as one mesh per source in a solution's file. The reader checks every count and index: unless
/// `file.failed()`, the layers that it adds to the solution are safe to use.
void write_layers(Hdf5Writer& file, const std::string& group, const Solution& solution);
void read_layers(Hdf5Reader& file, const std::string& group, Solution& solution);

}  // namespace exitance
