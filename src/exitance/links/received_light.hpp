#pragma once

#include "exitance/links/error/link_judge.hpp"

namespace exitance {

/// A link with what the refinement needs to judge its receiver.
struct FoundLink {
    FoundLink() = default;
    FoundLink(const LinkDecision& decision, bool is_open);

    static constexpr std::uint32_t none = 0xffffffffu;

    Link link;
    std::array<float, 5> departure{};
    float squared_error = 0, light = 0, undersampling = 0;
    std::uint32_t shadow = none;  ///< Where shadowed light and its variance at the nodes stand in the refiner's pool.
    bool near = false;            ///< True if it has a block.
    bool open = false;            ///< True if its view is certainly open.
    bool cuts_receiver = false;   ///< Whatever its other links bring.
};

/// What all links of a receiver bring to it: the sum of their departures, and light that meets something on its way.
struct ReceivedLight {
    Departure departure{};
    NodeRow shadowed{}, variance{};

    /// `shadow`: light at the nodes where something stands in between, then its variance; null: none.
    void add(const FoundLink& link, const float* shadow, std::size_t nodes);

    /// Of interpolation, mean square: the departure from a polynomial, and where shadowed light varies over the
    /// receiver by more than the rays' errors, a part of that, (W/m^2)^2.
    double squared_error(const LinkSites& sites, ElementId e) const;
};

/// Mean square over the check points, (W/m^2)^2.
template <class Values>
double mean_square(const Values& departure) {
    double sum = 0;
    for (double v : departure) sum += v * v;
    return sum / static_cast<double>(departure.size());
}

}  // namespace exitance
