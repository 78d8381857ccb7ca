#pragma once

#include "exitance/io/scenes/honeybee/honeybee_model.hpp"

namespace exitance {

/// The objects of a dynamic group of a Honeybee model.
struct HoneybeeStates {
    std::vector<std::string> objects;  ///< Identifiers.
    /// Per state: transmittance at normal incidence, relative to the first state; 1 for a state with a scene of its
    /// own.
    std::vector<double> factors;
    /// Per state: 0 if it uses the scene of the first state. Otherwise the first state with equal shades and materials,
    /// which share a scene.
    std::vector<std::size_t> scene;
    bool has_shades = false;  ///< True if one of the objects is a shade, whose states change all light of the scene.

    /// The choices that make the scene of a state from the model.
    HoneybeeChoices choices(std::size_t state) const;
};

/// Finds the objects with a `dynamic_group_identifier`, or one object with this identifier, and their states, unless
/// `objects_only`. States of windows and doors have factors; those of shades, or of windows together with shades, have
/// a geometry each. Errors (bad_input, without a place): no such objects; states of windows with other materials than
/// glass, or brighter than the first; objects whose states differ.
Result<HoneybeeStates> find_honeybee_states(const HoneybeeModel& model, const std::string& group, bool objects_only);

}  // namespace exitance
