#pragma once

#include <array>
#include <span>

#include "exitance/base/vec.hpp"

namespace exitance {

/// The skies of CIE 171: types 1 to 15 of the CIE general sky [Darula02], and 16, the traditional overcast sky, all
/// with 10,000 lx on the open ground, the sun (which does not shine) 60 degrees high.
inline constexpr std::size_t cie171_skies = 16;
using SkyValues = std::array<double, cie171_skies>;

/// These skies with the sun in one direction, by formula.
class Cie171Skies {
  public:
    /// sun: of length 1, above the horizon.
    explicit Cie171Skies(const Normal& sun);
    /// Luminances (cd/m^2) in a direction of length 1 above the horizon.
    SkyValues luminance(const Normal& w) const;
    const Normal& sun() const { return sun_; }

  private:
    SkyValues relative(const Normal& w) const;
    Normal sun_;
    SkyValues scale_;
};

inline constexpr double cie171_horizontal_lux = 10000;
/// Of the ground around, 0.3 of the horizontal illuminance reflected diffusely, cd/m^2.
inline constexpr double cie171_ground_luminance = 0.3 * cie171_horizontal_lux / pi;

/// A rectangle o + [a0, a1] a + [b0, b1] b, a and b of length 1 at right angles.
struct SkyOpening {
    Point o;
    Normal a, b;
    double a0 = 0, a1 = 0, b0 = 0, b1 = 0;
};

/// Illuminance (lx) at x on a plane of normal n through an opening, nothing else in the way, below the horizon the
/// ground: the integral of L cos over the opening's solid angle by adaptive Gauss rules of 12 x 12 points, cut at the
/// horizon and at the sun, to 1e-9. It shares no code with the solver.
SkyValues illuminance_through(const SkyOpening& opening, const Point& x, const Normal& n, const Cie171Skies& skies);

}  // namespace exitance
