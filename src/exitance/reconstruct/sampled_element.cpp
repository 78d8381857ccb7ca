#include "exitance/reconstruct/sampled_element.hpp"

#include "exitance/basis/element_fit.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {
namespace {

double mean_square(const Spectrum& s) {
    return squared(s) / static_cast<double>(bands);
}

}  // namespace

SampledElement fit_gathered(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                            std::span<const Gathered> gathered, const Spectrum& rho, bool curved, double gain) {
    const ElementPolynomials polynomials(tree, e, places, curved);
    std::array<Spectrum, ElementPolynomials::most> c{};
    std::array<double, ElementPolynomials::most> noise{};  // of each coefficient, as of rho E
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
    for (std::size_t i = 0; i < places.size(); ++i) {
        Spectrum rest = gathered[i].irradiance;
        for (std::size_t k = 0; k < polynomials.size(); ++k) rest -= phi[i][k] * c[k];
        out.misfit_squared += places[i].weight * mean_square(rho * rest);
    }
    out.noise_in_misfit = std::max(0.0, whole_noise - straight - bent_noise);
    // What is drawn in loses light as much as noise; the rest keeps its noise.
    const double kept = bent > bent_noise ? 1 - bent_noise / bent : 0, lost = 1 - kept;
    out.noise_squared = straight + kept * kept * bent_noise + lost * lost * std::max(0.0, bent - bent_noise);
    for (std::size_t k = 0; k < ElementPolynomials::most; ++k)
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

std::vector<ElementId> add_straight(ElementFunction& out, ElementId leaf, const SampledElement& sampled,
                                    const Spectrum& rho, double tolerance) {
    constexpr int most_cuts = 4;
    const Patch patch = out.tree.patch(leaf);
    const SampledFunction polynomial(out.tree, leaf, sampled);
    std::vector<ElementId> leaves;
    const auto add = [&](ElementId e, const auto& value_at_corner) {
        out.first_value.resize(out.tree.size());
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int i = 0; i < out.tree.patch(e).corner_count(); ++i) out.add_value(value_at_corner(i));
        leaves.push_back(e);
    };
    if (!sampled.curved) {
        add(leaf, [&](int i) { return polynomial.at(patch.corner_uv(i)); });
        return leaves;
    }
    std::vector<std::pair<ElementId, int>> open = {{leaf, 0}};
    while (!open.empty()) {
        const auto [e, cuts] = open.back();
        open.pop_back();
        const std::vector<WeightedPlace> rule = element_rule(out.tree, e, RuleOrder::fine);
        std::vector<Spectrum> values;
        for (const WeightedPlace& place : rule)
            values.push_back(polynomial.at(patch.coordinates(out.tree.patch(e).at(place.uv))));
        const ElementFit fit(out.tree, e, rule, values);
        double rest = 0;
        for (std::size_t i = 0; i < rule.size(); ++i)
            rest += rule[i].weight * mean_square(rho * (values[i] - fit.at(rule[i].uv)));
        if (cuts == most_cuts || rest <= tolerance * tolerance)
            add(e, [&](int i) { return fit.corner(i); });
        else
            for (ElementId child : refine_element(out.tree, e)) open.emplace_back(child, cuts + 1);
    }
    return leaves;
}

}  // namespace exitance
