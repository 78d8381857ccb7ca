#pragma once

#include <cstdint>
#include <limits>

#include "exitance/base/ids.hpp"
#include "exitance/links/error/link_oracle.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// What decides whether a link is good enough.
struct LinkTolerance {
    /// Of one link: root of the receiver's area times the RMS error of the radiosity that it causes there, W/m^2 m.
    double error = 0;
    double interpolation = 0;  ///< Of all links of a receiver: root of its area times the RMS departure, likewise.
    /// Weight of an error that is alike all over a receiver: it adds up from link to link and from reflection to
    /// reflection, where others cancel.
    double systematic = 1;
    /// Weight of what a source's polynomial leaves out, for a receiver as near as the source is large.
    double residual_weight = 0.5;
    /// Largest number of links: beyond it no element is cut.
    std::size_t most_links = std::numeric_limits<std::size_t>::max();
    double least_area = 0;    ///< No element is cut below this, m^2.
    bool fractional = false;  ///< The share of rays that get through, for all nodes of a link; else each its own.
    bool quadrature = false;  ///< One ray from each node to each node, yes or no.
    /// Do rays correct what arrives in the mean? Then links that carry little may be constants, whatever the basis, and
    /// peaks between check points are left to rays.
    bool corrected = false;
    /// Weight of squared errors on a receiver, by element; null: alike everywhere.
    const Field<ElementId, double>* importance = nullptr;
    bool gives_up = false;  ///< Are pairs dropped once a stop is asked for? Else they are linked as they are.
    bool triage = true;     ///< Pairs are classified (all open, none, mixed) before rays are cast.
    LinkOracle oracle = LinkOracle::transport;
    double strongest = 0;  ///< Of the other oracles: form factor or power (W) of a link.
    std::uint64_t seed = 1;

    double weight(ElementId receiver) const { return importance ? (*importance)[receiver] : 1; }
};

}  // namespace exitance
