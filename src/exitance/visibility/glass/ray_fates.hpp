#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/scene/pane.hpp"

namespace exitance {

/// What becomes of a ray at a pane of clear glass.
enum class RayFate { passes, is_mirrored, is_absorbed };

/// Panes of glass as rays meet them: one ray in so many is stopped, as the share of the light that does not pass asks
/// for, and of these so many are mirrored (`Pane::transmission` and `reflection`, mean over bands, within 1e-4 by
/// tables). Which ones these are follows from the ray and the pane alone.
class RayFates {
  public:
    explicit RayFates(const std::vector<Pane>& panes);

    /// Origin and direction, of any length, in the coordinates that rays are traced in; `pane`: its number.
    RayFate operator()(const std::array<float, 3>& origin, const std::array<float, 3>& direction,
                       std::uint32_t pane) const;

  private:
    static constexpr std::size_t steps = 256;
    using Table = std::array<float, steps + 1>;  ///< By the cosine.
    struct Shares {
        Normal n;
        Table through, back;
    };
    std::vector<Shares> shares_;  ///< By pane.
};

}  // namespace exitance
