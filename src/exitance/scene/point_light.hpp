#pragma once

#include <string>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A punctual light (without extent): a point light, a spotlight, or parallel light from infinitely far away. Its
/// shadows are hard.
///
///     E(x) = I(w) cos / r^2,   w the unit direction from the light to x, r the distance;
///     E(x) = E_0 cos           for parallel light.
///
/// Candela and W/sr, like lumen and watt, are not distinguished: photometric input gives photometric output.
struct PunctualLight {
    enum class Kind { point, spot, directional };

    std::string name;
    Kind kind = Kind::point;
    Point position;              ///< Metres; unused for parallel light.
    Normal direction{0, 0, -1};  ///< Axis of a spotlight, or direction of parallel light; unit vector.
    /// W/sr (cd) on the axis; for parallel light the irradiance E_0 perpendicular to it, W/m^2 (lx).
    Spectrum intensity;
    double inner_cone = 0;       ///< Half angle of a spotlight's full intensity, radians.
    double outer_cone = pi / 4;  ///< Half angle of all of a spotlight's light, radians; inner < outer <= pi / 2.

    bool is_directional() const { return kind == Kind::directional; }

    /// Returns the intensity in direction w (unit vector) as a share of `intensity`. Between the cones of a spotlight
    /// it is that of glTF's extension KHR_lights_punctual: ((cos a - cos outer) / (cos inner - cos outer))^2, clamped
    /// to [0, 1].
    double share_towards(const Normal& w) const;

    /// Returns the emitted flux, W: the intensity integrated over all directions. 0 for parallel light, whose flux
    /// depends on the surfaces that it hits.
    Spectrum power() const;
};

}  // namespace exitance
