#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "exitance/base/vec.hpp"

namespace exitance {

class SkyPicture;

/// The directional radiance of a sky, up to a factor; z is up.
///
///     L(w) ~ phi(Z) f(gamma),   phi = 1 + a exp(b / cos Z) + g cos Z,   f = f0 + c exp(d gamma) + e cos^2 gamma
///
/// Z is the angle from the zenith, gamma that from the sun. The CIE general sky has f0 = 1 - c exp(d pi / 2) and g = 0,
/// Perez' all-weather sky f0 = 1, the traditional overcast sky a = 0 and g = 2. cos Z is at least 0.01; negative L is
/// replaced by 0. Source: [Darula02], [Perez93]. A sky from a picture takes L from the picture instead.
struct SkyModel {
    double a = 0, b = -1, g = 0;
    double f0 = 1, c = 0, d = -1, e = 0;
    Normal sun{0, 0, 1};        ///< Direction to the sun, unit vector.
    bool intermediate = false;  ///< The CIE intermediate sky times f0, as in Radiance, instead of that product.
    /// Radiance's files blend sky and ground about the horizon by (1.01 + cos Z)^10; this is the value of the ground
    /// then.
    double ground = 0;
    bool blends_ground = false;
    bool below = false;  ///< The model fills the half below the horizon.
    /// Factor for which the cosine-weighted mean of relative() over its half of the directions is 1.
    double scale = 1;
    /// Replaces the formula if not null: the radiance of one band in every direction. Immutable and shared by copies.
    std::shared_ptr<const SkyPicture> picture = {};

    bool is_uniform() const {
        return a == 0 && g == 0 && c == 0 && e == 0 && !intermediate && !blends_ground && !picture;
    }
    /// Returns L in direction w, a unit vector.
    double value(const Vec3& w) const;
    double relative(const Vec3& w) const { return scale * value(w); }
    /// Returns the angle over which the radiance is smooth about w, radians.
    double smooth_width(const Vec3& w) const;
    /// Computes `scale`; returns false if the sky is black. Relative error 1e-6.
    bool normalize();
    bool is_sane() const;
};

/// Returns the cosine-weighted mean of value() over the half of the directions: the irradiance of a horizontal plane
/// over that for value() = 1. Relative error 1e-6.
double horizontal_mean(const SkyModel& sky);

SkyModel uniform_sky();
/// L = L_z (1 + 2 cos Z) / 3, the CIE's overcast sky of 1955.
SkyModel overcast_sky();
/// Returns a CIE general sky (ISO 15469), type 1 to 15; 12 is the clear sky, 1 the overcast one. `sun` is a unit
/// vector.
SkyModel cie_sky(int type, const Normal& sun);

/// Input of Perez' model.
struct PerezInput {
    double diffuse_horizontal = 0;  ///< W/m^2
    double direct_normal = 0;       ///< W/m^2
    int day_of_year = 80;           ///< Day of the year, which determines the Earth's distance from the sun.
};
/// Returns Perez' all-weather sky. Clearness is clamped to 1 to 12.01, brightness to 0.01 to 0.6; a sun below the
/// horizon is moved to it. Source: [Perez93].
SkyModel perez_sky(const PerezInput& input, const Normal& sun);

/// The clearness and brightness of Perez' model.
struct PerezState {
    double clearness = 1, brightness = 0.01;
};
PerezState perez_state(const PerezInput& input, const Normal& sun);

}  // namespace exitance
