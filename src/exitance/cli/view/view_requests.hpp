#pragma once

#include "exitance/cli/view/view_changes.hpp"
#include "exitance/cli/view/view_frames.hpp"

namespace exitance {

/// Registers the requests of the viewer's page for elements, values and pictures of the newest solution, with the
/// changes of light that they specify. All arguments must outlive the server's answers.
void serve_light(ViewServer& server, const Gallery& gallery, ViewFrames& frames, ViewChanges& changes,
                 const ViewUnits& units);

/// Returns the viewer's page with the light of a solution as one file. Error: a file of the page cannot be read.
///
/// page   folder of the viewer's page
/// facts  solution whose materials and lamps the page describes; the page multiplies and paints them
/// views  saved views, JSON [{name, camera}]
Result<std::string> share_page(const std::string& page, const Viewed& facts, const Viewed& light, const LightUnit& unit,
                               const std::string& views);

/// Registers the request for such a page with the newest solution.
void serve_share(ViewServer& server, const Gallery& gallery, ViewChanges& changes, const ViewUnits& units,
                 const std::string& page);

}  // namespace exitance
