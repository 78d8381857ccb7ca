#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Content of a shared page: what the viewer's page would request from the program.
struct SharedPage {
    std::string scene;                   ///< JSON of viewer_scene_json().
    std::span<const std::string> parts;  ///< All parts of the exported elements, as viewer_part() encodes them.
    std::string views = "[]";            ///< Saved views: JSON [{name, camera}].
};

/// Returns the viewer's page as one HTML file that needs neither the program nor a network: scripts, styles, elements
/// and light are embedded. The page replaces `"state":null` at the beginning of its data by what it shows when a user
/// shares it. `folder`: of the viewer's page. Error: a file of the page cannot be read.
Result<std::string> make_shared_page(const std::string& folder, const SharedPage& content);

/// Reads a file of views that the viewer's page has saved: JSON [{name, camera}]. Error (bad_input): other content.
Result<std::string> read_saved_views(const std::string& path);

}  // namespace exitance
