#pragma once

#include <cstdint>

#include "exitance/base/spectrum.hpp"

namespace exitance {

/// Luminous efficacy of white light in lm/W, as in Radiance (WHTEFFICACY): converts lumens to watts for three equal
/// bands.
inline constexpr double daylight_efficacy = 179;

/// Weights of the bands in a luminous quantity, summing to 1: Radiance's 0.265, 0.670, 0.065 for R, G, B. With another
/// number of bands, which have no names, all weights are equal.
constexpr Spectrum luminous_weights() {
    Spectrum out(1.0 / static_cast<double>(bands));
    if constexpr (bands == 3) out[0] = 0.265, out[1] = 0.670, out[2] = 0.065;
    return out;
}

/// Returns the sum of the bands weighted by `luminous_weights()`.
constexpr double luminous_sum(const Spectrum& light) {
    const Spectrum weights = luminous_weights();
    double sum = 0;
    for (std::size_t b = 0; b < bands; ++b) sum += weights[b] * light[b];
    return sum;
}

/// The unit for printed light: that of the scene, or another.
enum class UnitChoice : std::uint8_t { scene, watt, lux };

/// Converts light of all bands to one number: E in lx or W/m^2, M and B in lm/m^2 or W/m^2, power in lm or W. This is
/// the only definition of a total over bands: watts are the mean of the bands; lumens are the sum by
/// `luminous_weights()`, times the efficacy if the light is in watts.
class LightUnit {
  public:
    LightUnit() = default;
    /// `photometric`: the scene's light is in lumens.
    LightUnit(UnitChoice choice, bool photometric, double efficacy = daylight_efficacy)
        : is_lux_(choice == UnitChoice::lux || (choice == UnitChoice::scene && photometric)),
          is_photometric_(photometric),
          efficacy_(efficacy) {}

    bool is_lux() const { return is_lux_; }
    /// True if the efficacy converts between watts and lumens.
    bool is_converted() const { return is_lux_ != is_photometric_; }
    const char* power() const { return is_lux_ ? "lm" : "W"; }
    const char* irradiance() const { return is_lux_ ? "lx" : "W/m^2"; }
    const char* radiosity() const { return is_lux_ ? "lm/m^2" : "W/m^2"; }
    const char* radiance() const { return is_lux_ ? "cd/m^2" : "W/(m^2 sr)"; }

    double operator()(const Spectrum& light) const {
        if (is_lux_) return (is_photometric_ ? 1 : efficacy_) * luminous_sum(light);
        return is_photometric_ ? luminous_sum(light) / efficacy_ : mean(light);
    }

  private:
    bool is_lux_ = false, is_photometric_ = false;
    double efficacy_ = daylight_efficacy;
};

/// Returns the unit of the scene's own light.
inline LightUnit own_unit(bool photometric) {
    return {UnitChoice::scene, photometric};
}

}  // namespace exitance
