#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/scene/emitter_groups.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/what_if/light_groups/kept_transport.hpp"

namespace exitance {

/// Values at the corners of a solution's elements, in their order, W/m^2.
using CornerValues = std::vector<std::array<float, bands>>;

/// One group's light, undimmed, on the elements of the whole solution.
struct LightGroup {
    EmitterGroup emitters;
    double factor = 1;            ///< By which it is dimmed in the solution that it is stored with.
    CornerValues indirect;        ///< Of Solution::indirect: the groups' sum is its value.
    CornerValues interpolant;     ///< Of Solution::interpolant, likewise.
    std::optional<double> error;  ///< Estimated, with this group alone, relative to its own light.
    double reflected = 0;         ///< Mean of the light that it makes surfaces reflect, W/m^2.
};

/// What dimming and repainting need. Dimming is a sum. Repainting changes what surfaces reflect, b, by
///
///     d = (rho' - rho) E + rho' F d,
///
/// E the solution's own light, and adds what arrives of d. F is the transport that is kept.
struct LightGroups {
    std::vector<LightGroup> groups;
    std::vector<Spectrum> reflectance, exitance;  ///< Of all materials, as they were solved.
    std::vector<Spectrum> intensity;              ///< Of lights without extent,
    std::vector<Spectrum> distant;                ///< of domes, then discs: their irradiance.
    KeptTransport transport;
    TransportLayout layout;  ///< Made when it is first wanted, and not stored.

    bool empty() const { return groups.empty(); }
    std::size_t light_bytes() const;  ///< Of the groups' light.
};

/// Parts the light of a solution by groups. The direct light of each is exact, as projected on the elements of the
/// interpolant; its indirect light is solved on transport between the solution's elements, which is found once, by
/// about as many rays as the solution took. What the groups' sum lacks to the solution is dealt out by their light, so
/// that the noise of the rays is in their shares alone. Each group's error is estimated from its residual, at points
/// and by rays that all groups share. The scene's emitters must be parted by group, and be in `most_light_groups` at
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
/// light, and of what kept transport misses of the change. Links, discontinuity mesh and cells, which hold the light of
/// before, go. Error: usage, for a name that is not there (the hint lists those that are), or a number out of range;
/// nothing is changed then.
Result<void> change_light(Solution& solution, LightGroups& groups, const LightChange& change);

}  // namespace exitance
