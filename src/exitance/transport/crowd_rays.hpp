#pragma once

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Returns the factor, at most 1, on the number of rays per row that are cast from the leaves of a mesh. It is 1 unless
/// the leaves are a crowd (`ErrorShare`). Rays that gather the light of a crowd hit many different leaves, so that the
/// noise of single leaves averages out, and fewer rays per leaf suffice. If small parts of the surfaces reflect most of
/// the light, few rays hit them, and the factor is closer to 1.
/// reflected  light that every leaf reflects, by leaf number, W/m^2
double fewer_rays_in_crowd(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                           std::span<const Spectrum> reflected);

}  // namespace exitance
