#include "exitance/cli/border_points.hpp"

#include <fmt/format.h>

namespace exitance {

void BorderPoints::tell(Terminal& terminal) const {
    if (count_ == 0) return;
    terminal.note(
        fmt::format("warning: {} of {} points lie on a border between sides of different light (a partition, a pane, "
                    "the end or corner of a wall): the light of one side is given (move a point to choose its side)",
                    count_, all_));
}

}  // namespace exitance
