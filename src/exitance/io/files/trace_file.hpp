#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/base/trace.hpp"

namespace exitance {

/// Writes the recorded parallel loops as JSON in the Chrome trace format, which Perfetto and about:tracing can open:
/// phases and loops on the first line, then one line per worker. Format: docs/formats/solutions.md. The file appears
/// whole or not at all.
Result<void> write_trace(const TaskTrace& trace, const std::string& path);

}  // namespace exitance
