#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"
#include "exitance/scene/findings.hpp"

namespace exitance {

/// Like read_obj(), but returns the first error if there is any.
inline Result<SceneDescription> load_obj(const std::string& path) {
    ReadScene read = read_obj(path);
    sort_findings(read.findings);
    if (has_errors(read.findings)) return error_of(read.findings);
    return std::move(read.description);
}

}  // namespace exitance
