#pragma once

#include <functional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Light as a function of place, W/m^2.
using LightAt = std::function<Spectrum(RegionId, const Point&)>;

/// Exact light at places that are uniform over all surfaces: how bright it is, and a measure of what is to be like it.
class ExactPlaces {
  public:
    /// Direct light times `direct_weight`, and `indirect`, if there is any, on top of it.
    ExactPlaces(const Stage& stage, const Spectrum& direct_weight, const LightAt& indirect, std::uint64_t seed,
                const StopRequest& stop);

    double mean_light() const { return mean_; }  ///< Of rho E (of E where nothing reflects), W/m^2.
    double largest_light() const { return largest_; }
    double area() const { return area_; }  ///< Of all surfaces, m^2.
    /// What light counts: by what reflects it; where nothing does, as it is.
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
