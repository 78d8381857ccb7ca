#pragma once

namespace exitance {

/// Edge of the cube that represents a luminaire whose photometric file gives no extent of its opening, metres.
inline constexpr double point_opening_size = 0.001;

}  // namespace exitance
