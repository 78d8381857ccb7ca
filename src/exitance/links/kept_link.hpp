#pragma once

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// A link of a hierarchy as a solution's file keeps it, for people.
struct KeptLink {
    ElementId receiver, source;
    float form_factor = 0;  ///< From the receiver to the source, visibility included; the mean over the receiver.
};

}  // namespace exitance
