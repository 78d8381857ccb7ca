#pragma once

#include "exitance/mesh/numbered_leaves.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Share of the light received by leaves that is exchanged between pieces that are certainly unoccluded. `radiosity`:
/// by leaf number, W/m^2. Estimated by one ray from one leaf in each of 512 strata of equal area.
double open_share(const Stage& stage, const NumberedLeaves& leaves, std::span<const Spectrum> radiosity,
                  std::uint64_t seed);

/// Above this open share, links compute light as accurately as required. Below it, links only determine what elements
/// reflect, and rays gather that light: at a point that sees many surfaces in part, rays over the hemisphere are more
/// accurate than as many rays between pairs. Chosen; 0.45 and 1 choose the same in rooms with a door, measured by
/// `exitance solve office.obj --error 0.02`.
constexpr double mostly_open = 0.9;

/// True if open_share() > mostly_open. Casts only an eighth of the rays if the share is far below.
bool is_mostly_open(const Stage& stage, const NumberedLeaves& leaves, std::span<const Spectrum> radiosity,
                    std::uint64_t seed);

/// True if all light that leaves send arrives at the front of some surface, by some four thousand rays: distributed in
/// proportion to `power` by leaf number, or over all surfaces if that is empty. Loss of a smaller share of the light is
/// negligible.
bool is_closed(const Stage& stage, const NumberedLeaves& leaves, std::uint64_t seed,
               std::span<const double> power = {});

}  // namespace exitance
