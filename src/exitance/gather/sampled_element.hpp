#pragma once

#include <functional>

#include "exitance/basis/element_polynomials.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Largest misfit that noise alone explains, as a multiple of the misfit expected of it. Derived from the chi-square
/// distribution: with five degrees of freedom, noise exceeds it once in twenty times.
inline constexpr double noise_misfit_bound = 2.3;

/// A polynomial fitted to irradiance gathered at the places of an element, and statistics of the places.
struct SampledElement {
    /// Coefficients of ElementPolynomials, W/m^2.
    std::array<std::array<float, bands>, ElementPolynomials::max_count> coefficient;
    bool curved = false;         ///< True if it has terms of second degree.
    double light = 0;            ///< RMS of rho E over places and bands, W/m^2.
    double noise_squared = 0;    ///< Variance of rho times the polynomial, mean over bands, (W/m^2)^2.
    double misfit_squared = 0;   ///< Mean of (rho (E - polynomial))^2 over the places, including noise, (W/m^2)^2.
    double noise_in_misfit = 0;  ///< Expected part of misfit_squared that is due to noise.
    /// Parts of `misfit_squared` that vary along one coordinate only, see misfit_along().
    std::array<double, 2> misfit_along = {};
    /// Means over the places of rho^2 times the two estimates of variance, `Gathered::quarters` and `Gathered::halves`,
    /// (W/m^2)^2.
    double quarters = 0, halves = 0;
    unsigned rays = 0;        ///< Rays in total.
    unsigned place_rays = 0;  ///< Rays per place; 0: not gathered yet.
};

/// Extrapolates light to places that are hidden: each gets the value there of the polynomial that fits the visible
/// places, so that hidden places do not influence the fit. Otherwise the darkness of a floor below the leg of a table
/// would darken the floor next to the leg. The noise of hidden places is set to the mean noise of the others. Does
/// nothing if all places are hidden.
///
/// hidden  for every place, whether it is covered or inside a body
void continue_below(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                    const std::vector<bool>& hidden, bool curved, std::span<Gathered> gathered);

/// Weighted least-squares polynomial of the light gathered at `places`. If it is `curved`, its terms of second degree
/// are shrunk according to their noise (James-Stein estimator, [Efron73]), so that they do not add noise to uniform
/// light. `rho`: the element's reflectance. `gain`: ratio of the actual variance to its estimate from quarters of the
/// rays.
SampledElement fit_gathered(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                            std::span<const Gathered> gathered, const Spectrum& rho, bool curved, double gain);

/// Quadrature rule with enough places for `fit_gathered`.
inline RuleOrder rule_order(bool curved) {
    return curved ? RuleOrder::finer : RuleOrder::fine;
}

/// Evaluates a fitted polynomial anywhere on the element.
class SampledFunction {
  public:
    SampledFunction(const ElementTree& tree, ElementId e, const SampledElement& sampled);

    Spectrum at(Vec2 uv) const;

  private:
    ElementPolynomials polynomials_;
    const SampledElement& sampled_;
};

/// A leaf of a function, and the fitted element of which it is a part, or which it is.
struct StraightLeaf {
    ElementId leaf, of;
};

/// Adds fitted elements, which must be leaves of the function's tree, as linear elements. Curved ones are split until
/// the difference is at most `tolerance(e)` (RMS of rho E, W/m^2). `sampled(e)`, `rho(e)`: polynomial and reflectance
/// of an element; called on any thread.
std::vector<StraightLeaf> add_straight(ElementFunction& out, std::span<const ElementId> fitted,
                                       const std::function<const SampledElement&(ElementId)>& sampled,
                                       const std::function<Spectrum(ElementId)>& rho,
                                       const std::function<double(ElementId)>& tolerance);

}  // namespace exitance
