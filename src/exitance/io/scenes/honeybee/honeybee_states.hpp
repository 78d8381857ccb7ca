#pragma once

#include "exitance/io/scenes/honeybee/honeybee_model.hpp"

namespace exitance {

/// The objects of a dynamic group of a Honeybee model.
struct HoneybeeStates {
    std::vector<std::string> objects;  ///< Identifiers.
    /// Per state: its transmittance at normal incidence relative to that of the first state.
    std::vector<double> factors;
};

/// Finds the objects with a `dynamic_group_identifier`, or one object with this identifier, and the factors of their
/// states, unless `objects_only`. Errors (bad_input, without a place): no such objects; states with shades, with other
/// materials than glass, or brighter than the first; objects whose states differ.
Result<HoneybeeStates> find_honeybee_states(const HoneybeeModel& model, const std::string& group, bool objects_only);

}  // namespace exitance
