#pragma once

#include <functional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Irradiance at a point of a region, W/m^2.
using LightAt = std::function<Spectrum(RegionId, const Point&)>;

/// Exact irradiance at sample points distributed uniformly over all surfaces. It gives the brightness of the scene and
/// measures the error of an approximation.
class ExactPlaces {
  public:
    /// The reference is direct light times `direct_weight`, plus `indirect` unless that is empty. Points not evaluated
    /// before `stop` is requested stay dark.
    ExactPlaces(const Stage& stage, const Spectrum& direct_weight, const LightAt& indirect, std::uint64_t seed,
                const StopRequest& stop);

    double mean_light() const { return mean_; }  ///< Mean of rho E (of E if nothing reflects), W/m^2.
    double largest_light() const { return largest_; }
    double area() const { return area_; }  ///< Area of all surfaces, m^2.
    /// Weight w of irradiance on a region: how much it reflects (light_weight), or 1 if no surface reflects.
    Spectrum weight(RegionId r) const;
    /// RMS over all surfaces of w (E - light), W/m^2.
    double error(const LightAt& light) const;

  private:
    struct Place {
        RegionId region;
        Point at;
        Spectrum light;
    };

    const Stage& stage_;
    std::vector<Place> places_;
    bool reflects_ = true;
    double mean_ = 0, largest_ = 0, area_ = 0;
};

}  // namespace exitance
