#pragma once

#include <cstdint>
#include <optional>

#include "exitance/base/vec.hpp"

namespace exitance {

/// The radiance of a sky by direction, but for a factor. z is up.
///
///     L(w) ~ phi(Z) f(gamma),   phi = 1 + a exp(b / cos Z) + g cos Z,   f = f0 + c exp(d gamma) + e cos^2 gamma
///
/// Z is the angle from the zenith, gamma that from the sun. The CIE general sky has f0 = 1 - c exp(d pi / 2) and g = 0,
/// Perez' all-weather sky f0 = 1, the traditional overcast sky a = 0 and g = 2. cos Z counts as 0.01 at least; where
/// coefficients make L negative it is 0. Source: [Darula02], [Perez93].
struct SkyModel {
    double a = 0, b = -1, g = 0;
    double f0 = 1, c = 0, d = -1, e = 0;
    Normal sun{0, 0, 1};        ///< Towards it, of length 1.
    bool intermediate = false;  ///< f0 times the CIE's intermediate sky, as Radiance has it, in place of that product.
    /// Radiance's files blend sky and ground about the horizon by (1.01 + cos Z)^10; this is the ground's value then.
    double ground = 0;
    bool blends_ground = false;
    bool below = false;  ///< It fills the half below the horizon.
    double scale = 1;    ///< Makes relative() 1 in the mean over its half of the directions by the cosine.

    bool is_uniform() const { return a == 0 && g == 0 && c == 0 && e == 0 && !intermediate && !blends_ground; }
    /// Towards w, of length 1.
    double value(const Vec3& w) const;
    double relative(const Vec3& w) const { return scale * value(w); }
    /// Over how wide an angle it is smooth, about w, radians.
    double smooth_width(const Vec3& w) const;
    /// Sets `scale`; false if there is no light in it. Relative error 1e-6.
    bool normalize();
    bool is_sane() const;
};

/// The irradiance of a horizontal plane over that which value() = 1 everywhere brings: mean of value() over the half of
/// the directions by the cosine. Relative error 1e-6.
double horizontal_mean(const SkyModel& sky);

SkyModel uniform_sky();
/// L = L_z (1 + 2 cos Z) / 3, the CIE's overcast sky of 1955.
SkyModel overcast_sky();
/// The CIE general sky (ISO 15469), type 1 to 15; 12 is the clear sky, 1 the overcast one. `sun` of length 1.
SkyModel cie_sky(int type, const Normal& sun);

/// What Perez' model is given.
struct PerezInput {
    double diffuse_horizontal = 0;  ///< W/m^2
    double direct_normal = 0;       ///< W/m^2
    int day_of_year = 80;           ///< For the Earth's distance from the sun.
};
/// Perez' all-weather sky. Clearness counts from 1 to 12.01, brightness from 0.01 to 0.6; below the horizon
/// the sun counts as on it. Source: [Perez93].
SkyModel perez_sky(const PerezInput& input, const Normal& sun);

/// Clearness and brightness that it goes by.
struct PerezState {
    double clearness = 1, brightness = 0.01;
};
PerezState perez_state(const PerezInput& input, const Normal& sun);

}  // namespace exitance
