#pragma once

#include "exitance/base/result.hpp"
#include "exitance/cli/view/view_units.hpp"

namespace exitance {

/// Checks that the viewer can compare two scenes in one picture: their light is shown in one unit, and their boxes
/// agree within 1% of the first one's diagonal. Lamps, furniture and materials may differ. Error (usage): they cannot
/// be compared; the message names the file `second_file`.
Result<void> check_pair(const Scene& first, const Scene& second, const ViewUnits& units,
                        const std::string& second_file);

}  // namespace exitance
