#pragma once

#include <string>

#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/scene/pane.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// Skies and suns of a scene; data sets are omitted if there are none. The reader validates everything that it returns.
void write_sky(Hdf5Writer& file, const std::string& group, const DistantLight& light);
DistantLight read_sky(Hdf5Reader& file, const std::string& group);

/// Panes of glass of a scene; a data set is omitted if there are none. The reader validates everything that it returns.
void write_panes(Hdf5Writer& file, const std::string& group, const std::vector<Pane>& panes);
std::vector<Pane> read_panes(Hdf5Reader& file, const std::string& group);

}  // namespace exitance
