#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// Shooting patches and receiving elements. Receivers are numbered like leaves. Spans have one entry per receiver or
/// one per patch.
struct ShootingProblem {
    std::span<const std::uint32_t> patch_of;            ///< Patch of each receiver.
    std::span<const double> receiver_area, patch_area;  ///< m^2
    std::span<const Spectrum> reflectance;              ///< Reflectance of each receiver.
    /// Form factors F_ij from every receiver i to patch j; the span stays valid until the next call.
    std::function<std::span<const float>(std::size_t patch)> column;
};

struct ShootingOptions {
    /// Also shoot an estimate of the light that will be reflected back [Feda92], [Gortler94].
    bool overshooting = false;
    double unshot = 1e-3;  ///< Stop when the unshot power is at most this share of `reference`.
    double reference = 0;  ///< Power that `unshot` is relative to, W; 0: the initial unshot power.
    std::size_t max_shots = 1'000'000;
    const StopRequest* request = nullptr;
    Progress* progress = nullptr;
    /// Called before every shot with the patch and the share of power that is unshot.
    std::function<void(std::size_t patch, double unshot)> shot = {};
};

/// Progressive refinement [Cohen88], which is Southwell relaxation [Gortler94]: repeatedly, the patch with the most
/// unshot power sends it to every visible element,
///
///     dE_i = F_ij u_j,   E_i += dE_i,   u_p(i) += rho_i dE_i A_i / A_p(i),   u_j = 0.
///
/// With overshooting it sends u_j plus an estimate of the light that it will receive later, which is then subtracted:
/// u_j = - estimate.
///
/// `unshot`: by patch, W/m^2: the light that patches have yet to send; contains the remainder on return.
/// `irradiance`: by receiver, W/m^2; arriving light is added.
/// Returns the number of shots (`iterations`) and the share of power that is still unshot (`residual`). O(receivers)
/// and one column per shot.
SolveReport shoot(const ShootingProblem& problem, const ShootingOptions& options, std::span<Spectrum> unshot,
                  std::span<Spectrum> irradiance);

/// Unshot power, W: sum_p A_p |u_p|, mean over the bands.
double unshot_power(std::span<const Spectrum> unshot, std::span<const double> patch_area);

}  // namespace exitance
