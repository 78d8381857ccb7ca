#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/base/trace.hpp"

namespace exitance {

/// Writes what parallel loops did as JSON in the Chrome trace format, which Perfetto and about:tracing open: phases and
/// loops on the first line, a line a worker below. Docs: formats.md. Appears whole or not at all.
Result<void> write_trace(const TaskTrace& trace, const std::string& path);

}  // namespace exitance
