#pragma once

#include <cstdint>
#include <limits>

#include "exitance/base/ids.hpp"
#include "exitance/links/error/link_oracle.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Tolerances and options for accepting links.
struct LinkTolerance {
    /// Limit for one link: root of the receiver's area times the RMS error of the radiosity that it causes there, W/m^2
    /// m.
    double error = 0;
    /// Limit for all links of a receiver together: root of its area times the RMS departure, W/m^2 m.
    double interpolation = 0;
    /// Weight of errors that have one sign all over a receiver: they accumulate over links and reflections, whereas
    /// others cancel.
    double systematic = 1;
    /// Weight of the error of the source's polynomial, for a receiver at a distance equal to the source's size.
    double residual_weight = 0.5;
    /// Maximum number of links. Once it is exceeded, no more elements are split.
    std::size_t max_links = std::numeric_limits<std::size_t>::max();
    double min_area = 0;      ///< Elements smaller than this are not split, m^2.
    bool fractional = false;  ///< Use one unoccluded share for all nodes of a link instead of one per pair of nodes.
    bool quadrature = false;  ///< Test visibility by one ray from each node to each node, instead of several.
    /// True if rays later correct the mean of the received light. Links with a small contribution may then be constants
    /// whatever the basis, and peaks between check points are left to the rays.
    bool corrected = false;
    /// Weight of squared errors, per receiving element; null: uniform.
    const Field<ElementId, double>* importance = nullptr;
    /// True if pairs are dropped after a stop request; otherwise they are linked without further splits.
    bool gives_up = false;
    bool triage = true;  ///< Classify pairs (open, none, mixed) before casting rays.
    LinkOracle oracle = LinkOracle::transport;
    double strongest = 0;  ///< Limit for the other oracles: form factor, or power (W), of a link.
    std::uint64_t seed = 1;

    double weight(ElementId receiver) const { return importance ? (*importance)[receiver] : 1; }
};

}  // namespace exitance
