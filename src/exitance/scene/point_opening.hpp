#pragma once

namespace exitance {

/// Edge of the cube that stands for a luminaire whose photometric file gives its opening no extent, metres.
inline constexpr double point_opening_size = 0.001;

}  // namespace exitance
