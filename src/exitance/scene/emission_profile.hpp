#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {

/// How an emitter's light depends on direction: a table over two angles, as photometric files and Radiance's
/// `brightdata` hold it, and what makes radiance of its values. The lamp's frame: straight down is (0, 0, -1).
struct EmissionProfile {
    /// What an angle of the table measures, in degrees, of the direction d in which light leaves the lamp.
    enum class Angle : std::uint8_t {
        theta,         ///< From straight down, 0 to 180.
        phi,           ///< About the vertical, from +x towards +y, 0 to 360;
        phi2,          ///< folded to 0 to 180: the halves y > 0 and y < 0 are alike;
        phi4,          ///< folded to 0 to 90: all quadrants are alike.
        b_vertical,    ///< Of photometry of type B: towards +x, -180 to 180;
        b_vertical2,   ///< its absolute value;
        b_horizontal,  ///< towards -y;
        b_horizontal2  ///< its absolute value.
    };
    static constexpr int angle_kinds = 8;

    /// What the table's value is divided by to make radiance.
    enum class Body : std::uint8_t {
        none,      ///< Nothing: it is radiance.
        flat,      ///< The cosine to the face's normal: it is intensity per area of a plane opening.
        box,       ///< The projected area of a box of `size`, metres: it is intensity.
        cylinder,  ///< That of an upright cylinder, size.x its diameter, size.y its height.
    };
    static constexpr int bodies = 4;

    struct Axis {
        Angle angle = Angle::theta;
        double offset = 0;             ///< Added to the angle, degrees.
        std::vector<double> at = {0};  ///< Where the table has entries: ascending, degrees.
    };
    std::array<Axis, 2> axes;    ///< One entry in an axis: the same for all its angles.
    std::vector<double> values;  ///< W/(m^2 sr) or W/sr, none below 0; the second angle is the fastest.
    Body body = Body::none;
    Vec3 size{1, 1, 1};

    /// The table at a direction (of length 1), linear between its entries. Half a step beyond the first and the last
    /// angle it is as there, and 0 beyond; about the vertical it goes on as at its ends.
    double value(const Vec3& d) const;
    /// Radiance in that direction, of a face that it leaves under this cosine to the normal (> 0).
    double radiance(const Vec3& d, double cosine) const;
    /// Over how wide an angle light is smooth enough for one rule of quadrature, radians: a step of the
    /// table, or more where a parabola says what it says. Set by find_smooth_width(), once the table is there.
    double smooth_width = 0;
    void find_smooth_width();
    /// Is it a table that can be evaluated?
    bool is_sane() const;
};

using ProfileId = Id<struct ProfileTag>;

/// How a material's face takes part in a profile: the lamp's frame in the world, and what normalizes it.
struct DirectedEmission {
    ProfileId profile;                        ///< None: the face is diffuse.
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< The lamp's axes, of length 1 and at right angles.
    double scale = 1;                         ///< pi over the profile's flux from the face's front.

    Vec3 in_lamp(const Vec3& w) const { return {dot(x, w), dot(y, w), dot(z, w)}; }
    bool is_sane() const;
};

/// Flux per area (W/m^2) of a face with that profile: its radiance times the cosine over all directions in front of it.
/// n: the face's normal in the lamp's frame. Relative error about 1e-5, where n is vertical there less.
double exitance_of(const EmissionProfile& profile, const Normal& n);

class SkyWindow;
/// Of what is seen through a window (scene/sky/sky_window.hpp).
double relative_radiance(const SkyWindow& window, const Vec3& w);
double smooth_width(const SkyWindow& window);

/// Radiance of a face by direction, as a multiple of that of a diffuse face of the same flux:
///
///     p(w) = pi L(w) / M,     mean of p over directions by the cosine = 1.
class RelativeRadiance {
  public:
    RelativeRadiance() = default;  ///< Diffuse.
    /// All must outlive it.
    RelativeRadiance(const EmissionProfile& profile, const DirectedEmission& emission, const Normal& n)
        : profile_(&profile), emission_(&emission), n_(n) {}
    /// Of a far face of the sky; it must outlive it. `smooth_width`: of this face.
    RelativeRadiance(const SkyModel& sky, double smooth_width, const Normal& n)
        : sky_(&sky), sky_width_(smooth_width), n_(n) {}
    /// Of a window; it must outlive it.
    RelativeRadiance(const SkyWindow& window, const Normal& n) : window_(&window), n_(n) {}

    bool is_directed() const { return profile_ != nullptr || sky_ != nullptr || window_ != nullptr; }
    /// Does it change at once at the horizon?
    bool breaks_at_horizon() const { return window_ != nullptr; }
    /// Towards w, of length 1, in front of the face.
    double operator()(const Vec3& w) const {
        if (profile_) return emission_->scale * profile_->radiance(emission_->in_lamp(w), dot(n_, w));
        if (window_) return relative_radiance(*window_, -w);
        return sky_ ? sky_->relative(-w) : 1;
    }
    /// Towards the point x from the point y of the face.
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
