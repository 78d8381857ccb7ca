#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {

/// Directional distribution of an emitter's light: a table over two angles, as in photometric files and Radiance's
/// `brightdata`, and the conversion of its values to radiance. In the lamp's frame, straight down is (0, 0, -1).
struct EmissionProfile {
    /// The angle that an axis of the table measures, in degrees, for the direction d in which light leaves the lamp.
    enum class Angle : std::uint8_t {
        theta,         ///< Angle from straight down, 0 to 180 degrees.
        phi,           ///< Angle about the vertical, from +x towards +y, 0 to 360 degrees.
        phi2,          ///< Like `phi`, folded to 0 to 180 degrees: symmetric in y.
        phi4,          ///< Like `phi`, folded to 0 to 90 degrees: symmetric in x and y.
        b_vertical,    ///< Type B photometry: vertical angle towards +x, -180 to 180 degrees.
        b_vertical2,   ///< Absolute value of `b_vertical`.
        b_horizontal,  ///< Type B photometry: horizontal angle towards -y, degrees.
        b_horizontal2  ///< Absolute value of `b_horizontal`.
    };
    static constexpr int angle_kinds = 8;

    /// The divisor that converts the table's values to radiance.
    enum class Body : std::uint8_t {
        none,      ///< 1: the values are radiance.
        flat,      ///< Cosine to the face's normal: the values are intensity per area of a planar opening.
        box,       ///< Projected area of a box of `size`, metres: the values are intensity.
        cylinder,  ///< Projected area of an upright cylinder of diameter size.x and height size.y, metres.
                   ///< The values are intensity, as for a box.
    };
    static constexpr int bodies = 4;

    struct Axis {
        Angle angle = Angle::theta;
        double offset = 0;             ///< Added to the angle, degrees.
        std::vector<double> at = {0};  ///< Angles of the table's entries: ascending, degrees.
    };
    std::array<Axis, 2> axes;    ///< The table's axes. If an axis has one entry, the values do not depend on its angle.
    std::vector<double> values;  ///< W/(m^2 sr) or W/sr, not negative; the second angle varies fastest.
    Body body = Body::none;
    Vec3 size{1, 1, 1};

    /// Returns the table's value in a direction (unit vector), linear between entries. It is constant for half a step
    /// beyond the first and the last angle, and 0 farther away; azimuths continue at the ends of the table.
    double value(const Vec3& d) const;
    /// Returns the radiance in that direction for a face with this cosine (> 0) between direction and normal.
    double radiance(const Vec3& d, double cosine) const;
    /// Angle over which the light is smooth enough for one quadrature rule, radians: a step of the table, or more where
    /// a parabola fits the table. Set by find_smooth_width() once the table is complete.
    double smooth_width = 0;
    void find_smooth_width();
    /// True if the table is valid and can be evaluated.
    bool is_sane() const;
};

using ProfileId = Id<struct ProfileTag>;

/// How a face emits by a profile: the lamp's frame in world coordinates, and the normalization.
struct DirectedEmission {
    ProfileId profile;                        ///< The emission profile; none: the face emits diffusely.
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< Orthonormal axes of the lamp.
    double scale = 1;                         ///< pi over the profile's flux from the face's front.

    Vec3 in_lamp(const Vec3& w) const { return {dot(x, w), dot(y, w), dot(z, w)}; }
    bool is_sane() const;
};

/// Returns the flux per area (W/m^2) of a face with that profile: the integral of radiance times cosine over the
/// hemisphere in front. n: the face's normal in the lamp's frame. Relative error about 1e-5, less if n is vertical.
double exitance_of(const EmissionProfile& profile, const Normal& n);

class SkyWindow;
/// Implemented in scene/sky/sky_window.hpp, for light that is seen through a window.
double relative_radiance(const SkyWindow& window, const Vec3& w);
double smooth_width(const SkyWindow& window);
bool shows_picture(const SkyWindow& window);

/// Radiance of a face by direction, relative to a diffuse face of the same flux:
///
///     p(w) = pi L(w) / M,     mean of p over directions by the cosine = 1.
class RelativeRadiance {
  public:
    RelativeRadiance() = default;  ///< Diffuse.
    /// `profile` and `emission` must outlive this object.
    RelativeRadiance(const EmissionProfile& profile, const DirectedEmission& emission, const Normal& n)
        : profile_(&profile), emission_(&emission), n_(n) {}
    /// For a distant face of the sky. `sky` must outlive this object; `smooth_width` is a property of the face.
    RelativeRadiance(const SkyModel& sky, double smooth_width, const Normal& n)
        : sky_(&sky), sky_width_(smooth_width), n_(n) {}
    /// For a window, which must outlive this object.
    RelativeRadiance(const SkyWindow& window, const Normal& n) : window_(&window), n_(n) {}

    bool is_directed() const { return profile_ != nullptr || sky_ != nullptr || window_ != nullptr; }
    /// True if the radiance comes from a picture of the sky: it varies over a few degrees everywhere.
    bool is_picture() const { return window_ ? shows_picture(*window_) : sky_ && sky_->picture; }
    /// True if the radiance is discontinuous at the horizon.
    bool breaks_at_horizon() const { return window_ != nullptr; }
    /// Returns p in direction w, a unit vector in front of the face.
    double operator()(const Vec3& w) const {
        if (profile_) return emission_->scale * profile_->radiance(emission_->in_lamp(w), dot(n_, w));
        if (window_) return relative_radiance(*window_, -w);
        return sky_ ? sky_->relative(-w) : 1;
    }
    /// Returns p from the point y of the face towards the point x.
    double towards(const Point& x, const Point& y) const { return is_directed() ? (*this)(normalized(x - y)) : 1; }
    double smooth_width() const {
        return window_ ? exitance::smooth_width(*window_) : sky_ ? sky_width_ : profile_->smooth_width;
    }
    const Normal& normal() const { return n_; }

  private:
    const EmissionProfile* profile_ = nullptr;
    const DirectedEmission* emission_ = nullptr;
    const SkyModel* sky_ = nullptr;
    const SkyWindow* window_ = nullptr;
    double sky_width_ = 0;  ///< Radians.
    Normal n_;
};

}  // namespace exitance
