#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exitance/core/progress.hpp"
#include "exitance/core/result.hpp"
#include "exitance/reconstruct/solution.hpp"
#include "exitance/scene/emitter_groups.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Values at the corners of a solution's elements, in their order, W/m^2.
using CornerValues = std::vector<std::array<float, bands>>;

/// One group's light, undimmed, on the elements of the whole solution.
struct LightGroup {
    EmitterGroup emitters;
    double factor = 1;         ///< By which it is dimmed in the solution that it is stored with.
    CornerValues indirect;     ///< Of Solution::indirect: the groups' sum is its value.
    CornerValues interpolant;  ///< Of Solution::interpolant, likewise.
    CornerValues direct;       ///< Direct light at the centres of the leaves of `indirect`.
    /// Estimated, with this group alone, relative to its own light: of its own solve, and of what the whole solution's
    /// elements miss of it.
    std::optional<double> error;
    double reflected = 0;  ///< Mean of the light that it makes surfaces reflect, W/m^2.
};

/// What dimming and repainting need. Dimming is a sum. Repainting solves E = F rho (E_direct + E) twice on the leaves,
/// with the reflectances as they were and as they are to be; F is held as the leaves that so many rays from each leaf
/// meet. The solution's light changes by the ratio of the two, averaged where leaves meet.
struct LightGroups {
    std::vector<LightGroup> groups;
    std::vector<Spectrum> reflectance, exitance;  ///< Of all materials, as they were solved.
    std::vector<Spectrum> intensity;              ///< Of lights without extent,
    std::vector<Spectrum> distant;                ///< of domes, then discs: their irradiance.
    std::uint32_t rays = 0;                       ///< From each leaf,
    std::vector<std::uint32_t> met;               ///< and the leaf's number that each meets; `nothing`.
    static constexpr std::uint32_t nothing = 0xffffffffu;
    // Made when it is first wanted, and not stored: the node that each corner of `indirect` lies at.
    std::vector<std::uint32_t> node;
    std::size_t node_count = 0;

    bool empty() const { return groups.empty(); }
    std::size_t light_bytes() const;    ///< Of the groups' light.
    std::size_t repaint_bytes() const;  ///< Of the rays' ends and of direct light a leaf.
};

/// Solves every group by itself as `options` say, evaluates it at the corners of the solution's elements, and spreads
/// what the sum lacks to the solution over the groups. Takes as long as the groups' solves and about 2
/// seconds of rays. The scene's emitters must be parted by group, and be in `most_light_groups` at
/// most. Error: limit, where a stop came first.
Result<LightGroups> solve_light_groups(const Solution& solution, const SolveOptions& options, Progress& progress,
                                       const StopRequest& stop);
constexpr std::size_t most_light_groups = 64;

/// What is to change.
struct LightChange {
    std::vector<std::pair<std::string, double>> dim = {};            ///< Groups by name, and factors of at least 0.
    std::vector<std::pair<std::string, Spectrum>> reflectance = {};  ///< Materials by name, [0, 1).
};

/// Changes light and scene of a solution, and the groups' factors. The estimate of the error is the groups' by their
/// light; unknown once something was repainted. Links, discontinuity mesh and cells, which hold the light of before,
/// go. Error: usage, for a name that is not there (the hint lists those that are), or a number out of range; nothing is
/// changed then.
Result<void> change_light(Solution& solution, LightGroups& groups, const LightChange& change);

}  // namespace exitance
