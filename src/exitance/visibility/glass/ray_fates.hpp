#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/scene/pane.hpp"
#include "exitance/visibility/tracing_frame.hpp"

namespace exitance {

/// Outcome of a ray at a pane of clear glass.
enum class RayFate { passes, is_mirrored, is_absorbed };

/// Decides pseudo-randomly which rays a pane of glass stops, and which of those it reflects. The shares match
/// `Pane::transmission` and `reflection` (mean over bands, within 1e-4, from tables). The decision depends only on the
/// ray and the pane.
class RayFates {
  public:
    /// frame  rotation to the coordinates that rays are traced in
    explicit RayFates(const std::vector<Pane>& panes, const TracingFrame& frame = {});

    /// origin, direction  in the coordinates that rays are traced in; the direction may have any length
    /// pane  index of the pane
    RayFate operator()(const std::array<float, 3>& origin, const std::array<float, 3>& direction,
                       std::uint32_t pane) const;

  private:
    static constexpr std::size_t steps = 256;
    using Table = std::array<float, steps + 1>;  ///< Indexed by the cosine of the angle of incidence.
    struct Shares {
        Normal n;
        Table through, back;
    };
    std::vector<Shares> shares_;  ///< Per pane.
};

}  // namespace exitance
