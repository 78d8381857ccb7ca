#pragma once

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Returns the factor on the rays of rows that are cast from the leaves of a mesh. It is 1 unless they are a crowd
/// (`ErrorShare`): whatever gathers their light meets many of them, so that their noise averages out, and fewer rays of
/// each suffice. It is nearer to 1 if small parts of the surfaces reflect most of the light, which few rays meet.
/// reflected  light that every leaf reflects, by leaf number, W/m^2
double fewer_rays_in_crowd(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                           std::span<const Spectrum> reflected);

}  // namespace exitance
