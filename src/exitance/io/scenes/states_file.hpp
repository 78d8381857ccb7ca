#pragma once

#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// The scene that a file of states belongs to.
struct StatesInput {
    std::span<const std::string> files;  ///< Files of the scene; those of a state are added to them.
    const LoadOptions& load;
    const Scene& scene;
    std::span<const NamedPane> panes;  ///< Panes of the scene; empty if the scene comes from a solution.
    std::size_t sensors = 0, hours = 0;
};

/// Reads groups of panes, their states and rules from a TOML file. The format is in docs/daylight.md. Errors:
/// ErrorCode::bad_input with the line, ErrorCode::cannot_read, or those of the scenes of states.
Result<DaylightStates> read_states(const std::string& path, const StatesInput& input);

}  // namespace exitance
