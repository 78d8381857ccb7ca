#pragma once

#include "exitance/cli/options/arguments.hpp"
#include "exitance/cli/terminal.hpp"
#include "exitance/io/report/daylight_tables.hpp"
#include "exitance/io/scenes/states_file.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// A scene, and the names of its panes if it comes from scene files.
struct SceneWithNames {
    Scene scene;
    std::vector<NamedPane> panes;
};

/// A simulation, the eye points for views out, and the files to write.
struct DaylightRequest {
    DaylightTask task;
    std::vector<Point> eyes;
    std::vector<ProbePoint> views;  ///< For glare.
    DaylightFormats formats;
    std::optional<DaylightStates> states;  ///< States of panes, which the task uses.
};

/// The scene of scene files or of a solution. A scene needs no light of its own.
Result<SceneWithNames> read_daylight_scene(const DaylightArguments& arguments, Terminal& terminal);

/// Reads weather, sensors and eye points. Warns of faults of the weather file and of sensors on borders.
Result<DaylightRequest> read_daylight_request(const DaylightArguments& arguments, const Scene& scene,
                                              Terminal& terminal);

/// Reads the states of panes, if any, into the request, which may not be moved afterwards.
Result<void> read_daylight_states(const DaylightArguments& arguments, const SceneWithNames& read,
                                  DaylightRequest& request);

}  // namespace exitance
