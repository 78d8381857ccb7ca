#pragma once

#include <array>
#include <span>

#include "exitance/base/vec.hpp"

namespace exitance {

/// The skies of CIE 171: types 1 to 15 of the CIE general sky [Darula02], and 16, the traditional overcast sky. All
/// have 10,000 lx on open ground, and the sun 60 degrees high without direct light.
inline constexpr std::size_t cie171_skies = 16;
using SkyValues = std::array<double, cie171_skies>;

/// These skies for one direction of the sun, by their formulas.
class Cie171Skies {
  public:
    /// `sun`: unit vector, above the horizon.
    explicit Cie171Skies(const Normal& sun);
    /// Luminances (cd/m^2) in direction `w`, a unit vector above the horizon.
    SkyValues luminance(const Normal& w) const;
    const Normal& sun() const { return sun_; }

  private:
    SkyValues relative(const Normal& w) const;
    Normal sun_;
    SkyValues scale_;
};

inline constexpr double cie171_horizontal_lux = 10000;
/// Luminance of the surrounding ground, which reflects 0.3 of the horizontal illuminance diffusely, cd/m^2.
inline constexpr double cie171_ground_luminance = 0.3 * cie171_horizontal_lux / pi;

/// A rectangle o + [a0, a1] a + [b0, b1] b with orthogonal unit vectors a and b.
struct SkyOpening {
    Point o;
    Normal a, b;
    double a0 = 0, a1 = 0, b0 = 0, b1 = 0;
};

/// Illuminance (lx) at x on a plane of normal n through an opening, without other blockers; below the horizon is the
/// ground. Integrates L cos over the opening's solid angle by adaptive Gauss rules of 12 x 12 points, split at the
/// horizon and at the sun, to 1e-9. Shares no code with the solver.
SkyValues illuminance_through(const SkyOpening& opening, const Point& x, const Normal& n, const Cie171Skies& skies);

}  // namespace exitance
