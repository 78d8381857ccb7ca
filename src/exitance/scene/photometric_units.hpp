#pragma once

#include <cstdint>

#include "exitance/core/spectrum.hpp"

namespace exitance {

/// lm/W of white light, as Radiance has it (WHTEFFICACY): what turns lumens into watts of three equal bands.
inline constexpr double daylight_efficacy = 179;

/// How much each of three bands in watts counts for the eye: Radiance's weights of R, G, B, 0.265, 0.670, 0.065, whose
/// sum is 1. In builds of other bands all count alike.
inline double radiance_weighted_mean(const Spectrum& watts) {
    if constexpr (bands == 3) return 0.265 * watts[0] + 0.670 * watts[1] + 0.065 * watts[2];
    return mean(watts);
}

/// What makes lm/m^2 (lx) of light.
struct LuminousWeights {
    bool photometric = false;  ///< Light is in lumens as it stands; its bands are weighed as those of linear sRGB.
    double efficacy = daylight_efficacy;  ///< lm/W otherwise.

    double operator()(const Spectrum& light) const {
        return photometric ? luminous_mean(light) : efficacy * radiance_weighted_mean(light);
    }
};

/// In what unit light is told: that of the scene, or another.
enum class UnitChoice : std::uint8_t { scene, watt, lux };

/// Light as one number: E in lx or W/m^2, M and B in lm/m^2 or W/m^2, by what the scene's own light is in. Light that
/// is in lumens is not converted to lumens again.
class LightUnit {
  public:
    LightUnit() = default;
    LightUnit(UnitChoice choice, bool photometric, double efficacy = daylight_efficacy)
        : is_lux_(choice == UnitChoice::lux || (choice == UnitChoice::scene && photometric)),
          weights_{photometric, efficacy} {}

    bool is_lux() const { return is_lux_; }
    /// Does the efficacy have a part in it?
    bool is_converted() const { return is_lux_ != weights_.photometric; }
    double operator()(const Spectrum& light) const {
        if (is_lux_) return weights_(light);
        return weights_.photometric ? luminous_mean(light) / weights_.efficacy : mean(light);
    }

  private:
    bool is_lux_ = false;
    LuminousWeights weights_;
};

}  // namespace exitance
