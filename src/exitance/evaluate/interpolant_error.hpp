#pragma once

#include <cstdint>

#include "exitance/solution/solution.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// The light that an interpolant approximates: direct_weight E_dir + indirect, E_dir exact, W/m^2.
struct InterpolatedLight {
    const ElementFunction& indirect;
    Spectrum direct_weight;
};

/// A leaf of the mesh that an interpolant was fitted on, or the fan of triangles that joining made of it.
struct InterpolatedLeaf {
    ElementId element;
    double expected = 0;  ///< Mean square of the error as the fit estimates it, (W/m^2)^2.
};

/// RMS over all surfaces of rho (light - interpolant), W/m^2; in a scene where nothing reflects, of light -
/// interpolant.
///
/// Light is compared at places that no fit has seen: the residual of a fit at its own places does not contain errors to
/// which the fit adapted, nor shadow edges between the places. Places are stratified over the leaves, half by area and
/// half by the expected square. Standard error of the square: a tenth or so; the result is at least the error that this
/// noise may hide. O(places) exact direct light.
double interpolant_error(const Stage& stage, const ElementFunction& interpolant,
                         std::span<const InterpolatedLeaf> leaves, const InterpolatedLight& light, std::uint64_t seed);

}  // namespace exitance
