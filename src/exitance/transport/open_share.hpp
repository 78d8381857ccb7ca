#pragma once

#include "exitance/mesh/element_locator.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// How much of the light that leaves receive goes between pieces with nothing in between, certainly: of `radiosity`, by
/// leaf number. From a ray of each of some hundred leaves, one in each of as many strata of equal area.
double open_share(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                  const ElementLocator& locator, std::span<const Spectrum> radiosity, std::uint64_t seed);

/// Where so much light passes in the open, links give it as exactly as it is asked for. Elsewhere they only find what
/// the elements reflect, and rays gather that: from a place that sees many things in part, rays over the hemisphere say
/// more than as many between pairs.
constexpr double mostly_open = 0.9;

/// Is open_share above that? Some of its rays tell, where it is far below.
bool is_mostly_open(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                    const ElementLocator& locator, std::span<const Spectrum> radiosity, std::uint64_t seed);

/// Does whatever leaves send arrive at the front of a surface? As some four thousand rays tell, in proportion to
/// `power` by leaf number, or from everywhere if that is empty: what less than that of the light escapes by is as good
/// as closed.
bool is_closed(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
               const ElementLocator& locator, std::uint64_t seed, std::span<const double> power = {});

}  // namespace exitance
