#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "exitance/scene/pane.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// The sky seen through a pane, in one band: directional radiance times the transmission of the pane.
class SkyWindow {
  public:
    /// The pane's normal must point inwards. `light` must outlive this object.
    SkyWindow(const Pane& pane, const DistantLight& light, std::size_t band);

    /// Returns the radiance seen in direction w (unit vector, out of the window), relative to `reference`. The tables
    /// have an error of 1e-5.
    double relative(const Vec3& w) const {
        double sum = 0;
        for (const Half& half : halves_)
            if (half.sky->below == (w.z < 0)) sum += half.scale * half.value(w);
        return sum > 0 ? sum * at(through_, -dot(n_, w)) : 0;
    }
    /// Returns pi times the mean radiance over directions, W/m^2.
    double reference() const { return reference_; }
    bool is_dark() const { return !(reference_ > 0); }
    /// True if a picture lights the window.
    bool shows_picture() const {
        return std::any_of(halves_.begin(), halves_.end(),
                           [](const Half& half) { return half.sky->picture != nullptr; });
    }
    /// Returns the angle over which it is smooth except at the horizon, radians.
    double smooth_width() const { return width_; }

  private:
    static constexpr int steps = 1024;
    using Table = std::array<float, steps + 2>;
    /// Linear interpolation between entries, x from 0 to 1.
    static double at(const Table& table, double x) {
        const double place = std::clamp(x, 0.0, 1.0) * steps;
        const int i = static_cast<int>(place);
        const double low = table[static_cast<std::size_t>(i)];
        return low + (place - i) * (table[static_cast<std::size_t>(i) + 1] - low);
    }
    struct Half {
        const SkyModel* sky;
        double scale;
        bool is_uniform, has_tables;
        Table by_height, by_sun;  ///< The model's two factors: by w.z, and by the sine of half the angle to the sun.

        Half(const SkyModel& model, double irradiance);
        double value(const Vec3& w) const {
            if (is_uniform) return 1;
            if (!has_tables) return sky->relative(w);
            const double sine_squared = 0.5 * (1 - dot(w, sky->sun));
            constexpr double max_sine_squared =  // near the point opposite to the sun, the table is too steep
                0.95;
            if (sine_squared > max_sine_squared) return sky->relative(w);
            const double v = at(by_height, w.z) * at(by_sun, std::sqrt(std::max(0.0, sine_squared)));
            return std::max(0.0, v);
        }
    };

    Normal n_;
    std::vector<Half> halves_;
    Table through_;
    double reference_ = 0, width_;
};

}  // namespace exitance
