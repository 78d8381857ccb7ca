#pragma once

#include <string>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A source without extent: a point, a spot, or parallel light from infinitely far away. Its shadows are hard.
///
///     E(x) = I(w) cos / r^2,   w the unit direction from the light to x, r the distance;
///     E(x) = E_0 cos           for parallel light.
///
/// Candela and W/sr are one here as lumen and watt are: what goes in photometrically comes out so.
struct PunctualLight {
    enum class Kind { point, spot, directional };

    std::string name;
    Kind kind = Kind::point;
    Point position;              ///< Metres; of no meaning for parallel light.
    Normal direction{0, 0, -1};  ///< In which a spot's axis and parallel light go; of length 1.
    Spectrum intensity;          ///< W/sr (cd) on the axis; of parallel light the irradiance E_0 across it, W/m^2 (lx).
    double inner_cone = 0;       ///< Half the angle of a spot's full light, radians,
    double outer_cone = pi / 4;  ///< and of all its light; inner < outer <= pi / 2.

    bool is_directional() const { return kind == Kind::directional; }

    /// Intensity in the direction w (of length 1) as a share of `intensity`. A spot's falls between its cones as
    /// glTF's extension KHR_lights_punctual says: ((cos a - cos outer) / (cos inner - cos outer))^2, clamped to [0, 1].
    double share_towards(const Normal& w) const;

    /// Emitted flux, W: the intensity over all directions. Parallel light has none of its own: what it brings is what
    /// surfaces stand in its way.
    Spectrum power() const;
};

}  // namespace exitance
