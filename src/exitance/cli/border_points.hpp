#pragma once

#include <cstddef>

#include "exitance/cli/terminal.hpp"

namespace exitance {

/// Counts measuring points on borders, where the light is that of one of several sides (see PlaceFinder).
class BorderPoints {
  public:
    void add(bool is_between_sides) { ++all_, count_ += is_between_sides; }
    /// Prints a warning if there are any.
    void tell(Terminal& terminal) const;

  private:
    std::size_t all_ = 0, count_ = 0;
};

}  // namespace exitance
