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
    double factor = 1;  ///< Factor by which this group is dimmed in the solution that it is stored with.
    /// Values at the corners of the elements of Solution::indirect, which is the sum over the groups.
    CornerValues indirect;
    /// Values at the corners of the elements of Solution::interpolant, which is the sum over the groups.
    CornerValues interpolant;
    std::optional<double> error;  ///< Estimated error of this group, relative to its own light.
    double reflected = 0;         ///< Mean of the group's reflected light, W/m^2.
};

/// Data for dimming and repainting a solution. Dimmed light is a sum over groups. Repainting changes the reflected
/// radiosity b by
///
///     d = (rho' - rho) E + rho' F d,
///
/// where E is the solution's own light and F the stored transport, and adds the light that arrives from d.
struct LightGroups {
    std::vector<LightGroup> groups;
    /// Reflectance and exitance of every material in the stored solution.
    std::vector<Spectrum> reflectance, exitance;
    std::vector<Spectrum> intensity;  ///< Intensity of point and parallel lights.
    std::vector<Spectrum> distant;    ///< Irradiance of domes, then of discs.
    KeptTransport transport;
    TransportLayout layout;  ///< Computed on first use, not stored in files.

    bool empty() const { return groups.empty(); }
    std::size_t light_bytes() const;  ///< Memory of the groups' light.
};

/// Separates the light of a solution by groups. The direct light of each group is exact, projected on the elements of
/// the interpolant. Its indirect light is solved with transport between the solution's elements, which is computed
/// once, by about as many rays as the solution took. The difference between the groups' sum and the solution is
/// distributed in proportion to their light, so that noise of the rays only affects the groups' shares. Each group's
/// error is estimated from its residual, at points and by rays that all groups share. The scene's emitters must be
/// separated by group, with at most `max_light_groups` groups. Error: limit, after a request to stop.
Result<LightGroups> solve_light_groups(const Solution& solution, const SolveOptions& options, Progress& progress,
                                       const StopRequest& stop);
constexpr std::size_t max_light_groups = 64;

/// The requested changes.
struct LightChange {
    std::vector<std::pair<std::string, double>> dim = {};            ///< Groups by name, and factors of at least 0.
    std::vector<std::pair<std::string, Spectrum>> reflectance = {};  ///< Materials by name, and reflectances in [0, 1).
};

/// Changes the light and the scene of a solution, and the groups' factors. The error estimate is composed of the
/// groups' errors, weighted by their light, and of the stored transport's error for the change. Layers are dimmed.
/// Links, discontinuity mesh and cells of the old light are removed. Error: usage, for an unknown name (the hint lists
/// the known ones) or a number out of range; nothing is changed then.
Result<void> change_light(Solution& solution, LightGroups& groups, const LightChange& change);

}  // namespace exitance
