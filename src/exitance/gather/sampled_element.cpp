#include "exitance/gather/sampled_element.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/basis/misfit_along.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

double mean_square(const Spectrum& s) {
    return squared(s) / static_cast<double>(bands);
}

}  // namespace

void continue_below(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                    const std::vector<bool>& hidden, bool curved, std::span<Gathered> gathered) {
    Gathered seen;
    double weight = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (hidden[i]) continue;
        const double w = places[i].weight;
        weight += w;
        seen.irradiance += w * gathered[i].irradiance;
        seen.quarters += w * gathered[i].quarters, seen.halves += w * gathered[i].halves;
    }
    if (!(weight > 0)) return;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (hidden[i]) gathered[i] = {seen.irradiance / weight, seen.quarters / weight, seen.halves / weight};
    // Fits alternate with replacing hidden values by the fitted ones. A step leaves the share of the difference that
    // the hidden places have in their own fitted values: about a half for a corner, two thirds for two places next to
    // each other, of which these steps leave a thousandth.
    constexpr int steps = 16;
    const ElementPolynomials polynomials(tree, e, places, curved);
    std::vector<ElementPolynomials::Values> phi;
    for (const WeightedPlace& place : places) phi.push_back(polynomials.at(place.uv));
    for (int step = 0; step < steps; ++step) {
        std::array<Spectrum, ElementPolynomials::max_count> c{};
        for (std::size_t i = 0; i < places.size(); ++i)
            for (std::size_t k = 0; k < polynomials.size(); ++k)
                c[k] += (places[i].weight * phi[i][k]) * gathered[i].irradiance;
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!hidden[i]) continue;
            gathered[i].irradiance = {};
            for (std::size_t k = 0; k < polynomials.size(); ++k) gathered[i].irradiance += phi[i][k] * c[k];
        }
    }
}

SampledElement fit_gathered(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                            std::span<const Gathered> gathered, const Spectrum& rho, bool curved, double gain) {
    const ElementPolynomials polynomials(tree, e, places, curved);
    std::array<Spectrum, ElementPolynomials::max_count> c{};    ///< coefficients of the fit to rho E
    std::array<double, ElementPolynomials::max_count> noise{};  // variance of each coefficient, for rho E
    std::vector<ElementPolynomials::Values> phi;
    SampledElement out;
    out.curved = curved;
    double whole_noise = 0, square = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double w = places[i].weight, quarters = mean(rho * rho * gathered[i].quarters);
        const double variance = gain * quarters;
        out.quarters += w * quarters;
        out.halves += w * mean(rho * rho * gathered[i].halves);
        phi.push_back(polynomials.at(places[i].uv));
        for (std::size_t k = 0; k < polynomials.size(); ++k) {
            c[k] += (w * phi[i][k]) * gathered[i].irradiance;
            noise[k] += w * w * phi[i][k] * phi[i][k] * variance;
        }
        whole_noise += w * variance;
        square += w * mean_square(rho * gathered[i].irradiance);
    }
    out.light = std::sqrt(square);
    double straight = 0, bent = 0, bent_noise = 0;
    for (std::size_t k = 0; k < polynomials.size(); ++k) {
        (k < polynomials.straight() ? straight : bent_noise) += noise[k];
        if (k >= polynomials.straight()) bent += mean_square(rho * c[k]);
    }
    std::vector<Spectrum> rest(places.size());  // gathered minus fitted rho E, per place
    for (std::size_t i = 0; i < places.size(); ++i) {
        rest[i] = gathered[i].irradiance;
        for (std::size_t k = 0; k < polynomials.size(); ++k) rest[i] -= phi[i][k] * c[k];
        rest[i] = rho * rest[i];
        out.misfit_squared += places[i].weight * mean_square(rest[i]);
    }
    out.misfit_along = misfit_along(tree, e, places, rest, curved ? Degree::curved : Degree::straight);
    out.noise_in_misfit = std::max(0.0, whole_noise - straight - bent_noise);
    // Shrinking terms loses light as well as noise; the remaining terms keep their noise.
    const double kept = bent > bent_noise ? 1 - bent_noise / bent : 0, lost = 1 - kept;
    out.noise_squared = straight + kept * kept * bent_noise + lost * lost * std::max(0.0, bent - bent_noise);
    for (std::size_t k = 0; k < ElementPolynomials::max_count; ++k)
        for (std::size_t b = 0; b < bands; ++b)
            out.coefficient[k][b] = static_cast<float>((k < polynomials.straight() ? 1 : kept) * c[k][b]);
    return out;
}

SampledFunction::SampledFunction(const ElementTree& tree, ElementId e, const SampledElement& sampled)
    : polynomials_(tree, e, element_rule(tree, e, rule_order(sampled.curved)), sampled.curved), sampled_(sampled) {}

Spectrum SampledFunction::at(Vec2 uv) const {
    const ElementPolynomials::Values phi = polynomials_.at(uv);
    Spectrum sum;
    for (std::size_t k = 0; k < polynomials_.size(); ++k)
        for (std::size_t b = 0; b < bands; ++b) sum[b] += phi[k] * static_cast<double>(sampled_.coefficient[k][b]);
    return sum;
}

namespace {

/// A linear element: its values at the corners, and the mean squared difference of rho E from the function that it
/// replaces.
struct StraightFit {
    std::array<Spectrum, 4> corner;
    double rest_squared = 0;
    /// Part that varies along one coordinate only, see `SampledElement::misfit_along`.
    std::array<double, 2> rest_along = {};
};

/// Least-squares linear element for `part` of an element with the polynomial `sampled`.
StraightFit straighten(const ElementTree& tree, ElementId part, ElementId whole, const SampledElement& sampled,
                       const Spectrum& rho) {
    const SampledFunction polynomial(tree, whole, sampled);
    const Patch& patch = tree.patch(part);
    StraightFit out;
    if (!sampled.curved) {
        for (int i = 0; i < patch.corner_count(); ++i)
            out.corner[static_cast<std::size_t>(i)] = polynomial.at(patch.corner_uv(i));
        return out;
    }
    const std::vector<WeightedPlace> rule = element_rule(tree, part, RuleOrder::fine);
    std::vector<Spectrum> values;
    for (const WeightedPlace& place : rule)
        values.push_back(polynomial.at(tree.patch(whole).coordinates(patch.at(place.uv))));
    const ElementFit fit(tree, part, rule, values);
    for (std::size_t i = 0; i < rule.size(); ++i) {
        values[i] = rho * (values[i] - fit.at(rule[i].uv));
        out.rest_squared += rule[i].weight * mean_square(values[i]);
    }
    out.rest_along = misfit_along(tree, part, rule, values, Degree::straight);
    for (int i = 0; i < patch.corner_count(); ++i) out.corner[static_cast<std::size_t>(i)] = fit.corner(i);
    return out;
}

}  // namespace

std::vector<StraightLeaf> add_straight(ElementFunction& out, std::span<const ElementId> fitted,
                                       const std::function<const SampledElement&(ElementId)>& sampled,
                                       const std::function<Spectrum(ElementId)>& rho,
                                       const std::function<double(ElementId)>& tolerance) {
    constexpr int max_cuts = 4;
    std::vector<StraightLeaf> leaves, parts;
    for (ElementId e : fitted) parts.push_back({e, e});
    for (int cuts = 0; !parts.empty(); ++cuts) {
        std::vector<StraightFit> fit(parts.size());
        shared_ranges_of(
            std::span(fit), parts.size(), 64,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    const auto [part, whole] = parts[i];
                    fit[i] = straighten(out.tree, part, whole, sampled(whole), rho(whole));
                }
            },
            [&](std::size_t i) -> StraightFit& { return fit[i]; }, {"gather"});
        std::vector<StraightLeaf> smaller;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto [part, whole] = parts[i];
            const double allowed = tolerance(whole);
            if (cuts < max_cuts && fit[i].rest_squared > allowed * allowed) {
                const Cut only = sufficient_cut(fit[i].rest_squared, fit[i].rest_along, allowed * allowed);
                for (ElementId child : refine_element(out.tree, part, only)) smaller.push_back({child, whole});
                continue;
            }
            out.first_value.resize(out.tree.size());
            out.first_value[part] = static_cast<std::uint32_t>(out.values.size());
            for (int c = 0; c < out.tree.patch(part).corner_count(); ++c)
                out.add_value(fit[i].corner[static_cast<std::size_t>(c)]);
            leaves.push_back(parts[i]);
        }
        parts = std::move(smaller);
    }
    return leaves;
}

}  // namespace exitance
