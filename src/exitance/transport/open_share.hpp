#pragma once

#include "exitance/mesh/element_locator.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// How much of the light that leaves receive goes between pieces with nothing in between, certainly: of `radiosity`, by
/// leaf number. From a ray of each of some hundred leaves, one in each of as many strata of equal area.
double open_share(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                  const ElementLocator& locator, std::span<const Spectrum> radiosity, std::uint64_t seed);

/// Does whatever leaves send arrive at the front of a surface? As some four thousand rays tell, in proportion to
/// `power` by leaf number, or from everywhere if that is empty: what less than that of the light escapes by is as good
/// as closed.
bool is_closed(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
               const ElementLocator& locator, std::uint64_t seed, std::span<const double> power = {});

}  // namespace exitance
