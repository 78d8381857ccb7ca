#pragma once

#include <cstddef>

#include "exitance/cli/terminal.hpp"

namespace exitance {

/// Counts measuring points on borders of several sides, which get the light of one of the sides (see PlaceFinder).
class BorderPoints {
  public:
    void add(bool is_between_sides) { ++all_, count_ += is_between_sides; }
    /// Prints a warning if points on borders were counted.
    void tell(Terminal& terminal) const;

  private:
    std::size_t all_ = 0, count_ = 0;
};

}  // namespace exitance
