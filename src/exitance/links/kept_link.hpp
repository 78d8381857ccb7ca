#pragma once

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// A link of a hierarchy in the form stored in a solution file, for inspection.
struct KeptLink {
    ElementId receiver, source;
    float form_factor = 0;  ///< From the receiver to the source, including visibility; mean over the receiver.
};

}  // namespace exitance
