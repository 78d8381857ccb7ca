#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Light from which a step of iterative refinement starts (`next_light`, `corrected_sums`).
struct RefinementInput {
    const Stage& stage;
    const GlobalLight& light;         ///< The method's light.
    const ElementFunction& indirect;  ///< The delivered function, which was gathered from it.
    const DirectProjection& direct;
    Spectrum c;      ///< Share of `find_direct_share`.
    RayBudget rays;  ///< Rays between the leaves of the method, by which the step solves.
    std::uint64_t seed;
};

}  // namespace exitance
