#pragma once

#include "exitance/links/error/link_judge.hpp"

namespace exitance {

/// A link with the data that judging its receiver needs.
struct FoundLink {
    FoundLink() = default;
    FoundLink(const LinkDecision& decision, bool is_open);

    static constexpr std::uint32_t none = 0xffffffffu;

    Link link;
    std::array<float, 5> departure{};
    float squared_error = 0, light = 0, undersampling = 0;
    std::uint32_t shadow = none;  ///< Index in the refiner's pool of the shadowed light at the nodes and its variance.
    bool near = false;            ///< True if the link has a block.
    bool open = false;            ///< True if source and receiver certainly see each other unoccluded.
    bool cuts_receiver = false;   ///< True if its receiver must be split whatever the other links contribute.
};

/// Sum over all links of a receiver: departures from the receiver's polynomial, and light that may be occluded.
struct ReceivedLight {
    Departure departure{};
    NodeRow shadowed{}, variance{};

    /// Adds a link. `shadow`: light at the nodes with possible occluders in between, then its variance; null: none.
    void add(const FoundLink& link, const float* shadow, std::size_t nodes);

    /// Mean squared interpolation error, (W/m^2)^2: the departure from a polynomial and, if the shadowed light varies
    /// over the receiver by more than the rays' errors, a share of that variation.
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
