#pragma once

#include <functional>

#include "exitance/basis/element_polynomials.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// A polynomial fitted to irradiance gathered at the places of an element, and what the places say of it.
struct SampledElement {
    std::array<std::array<float, bands>, ElementPolynomials::most> coefficient;  ///< Of ElementPolynomials, W/m^2.
    bool curved = false;         ///< Are those of second degree among them?
    double light = 0;            ///< RMS of rho E over places and bands, W/m^2.
    double noise_squared = 0;    ///< Of rho E of the polynomial, mean over bands, (W/m^2)^2.
    double misfit_squared = 0;   ///< Mean of (rho (E - polynomial))^2 over the places, noise and all, (W/m^2)^2.
    double noise_in_misfit = 0;  ///< How much of that the rays' noise makes, on average.
    /// How much of `misfit_squared` is along one coordinate alone, see misfit_along().
    std::array<double, 2> misfit_along = {};
    double quarters = 0, halves = 0;  ///< Means over the places of rho^2 `Gathered::quarters`, `halves`, (W/m^2)^2.
    unsigned rays = 0;                ///< Spent in all.
    unsigned place_rays = 0;          ///< Of one place; 0: not gathered yet.
};

/// The polynomial nearest to what was gathered at `places`, in the weighted mean square. Where it is `curved`, its part
/// of second degree is drawn towards zero by as much as noise makes of it on average (James and Stein's estimator,
/// [Efron73]), so that even light is no noisier for it. `rho`: the element's reflectance; `gain`: the variance of what
/// was gathered, in what quarters of the rays tell of it.
SampledElement fit_gathered(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                            std::span<const Gathered> gathered, const Spectrum& rho, bool curved, double gain);

/// The rule whose places `fit_gathered` has enough of.
inline RuleOrder rule_order(bool curved) {
    return curved ? RuleOrder::finer : RuleOrder::fine;
}

/// Its value anywhere on the element.
class SampledFunction {
  public:
    SampledFunction(const ElementTree& tree, ElementId e, const SampledElement& sampled);

    Spectrum at(Vec2 uv) const;

  private:
    ElementPolynomials polynomials_;
    const SampledElement& sampled_;
};

/// A leaf of a function, and the fitted element that it is, or is a part of.
struct StraightLeaf {
    ElementId leaf, of;
};

/// Adds fitted elements, which are leaves of the function's tree, to it, as straight elements: where one is curved, it
/// is cut until what they leave over is at most `tolerance(e)` (RMS of rho E, W/m^2). `sampled(e)`, `rho(e)`: its
/// polynomial and reflectance; on any thread.
std::vector<StraightLeaf> add_straight(ElementFunction& out, std::span<const ElementId> fitted,
                                       const std::function<const SampledElement&(ElementId)>& sampled,
                                       const std::function<Spectrum(ElementId)>& rho,
                                       const std::function<double(ElementId)>& tolerance);

}  // namespace exitance
