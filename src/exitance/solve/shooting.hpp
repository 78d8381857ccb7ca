#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// Patches that shoot and elements that receive. Receivers are numbered as leaves; spans of receivers have one entry a
/// leaf, spans of patches one a patch.
struct ShootingProblem {
    std::span<const std::uint32_t> patch_of;            ///< By receiver: the patch that it belongs to.
    std::span<const double> receiver_area, patch_area;  ///< m^2
    std::span<const Spectrum> reflectance;              ///< By receiver.
    /// Form factors F_ij from every receiver i to patch j; the span stays valid until the next call.
    std::function<std::span<const float>(std::size_t patch)> column;
};

struct ShootingOptions {
    bool overshooting = false;  ///< Shoot also the light that is yet to come back [Feda92], [Gortler94].
    double unshot = 1e-3;       ///< Stop when the unshot power is this share of `reference`.
    double reference = 0;       ///< Power that `unshot` is relative to, W; 0: what there is at first.
    std::size_t max_shots = 1'000'000;
    const StopRequest* request = nullptr;
    Progress* progress = nullptr;
    /// Told of every shot beforehand: the patch, and the share of power that is unshot.
    std::function<void(std::size_t patch, double unshot)> shot = {};
};

/// Progressive refinement [Cohen88], which is Southwell's relaxation [Gortler94]: again and again the patch with the
/// most power to send sends it to every element that sees it,
///
///     dE_i = F_ij u_j,   E_i += dE_i,   u_p(i) += rho_i dE_i A_i / A_p(i),   u_j = 0.
///
/// If overshooting, it sends u_j and what it expects to be left with later, which then is missing: u_j = - expected.
///
/// `unshot`: by patch, W/m^2, the light that the patches have yet to send; what is left in the end stays in it.
/// `irradiance`: by receiver, W/m^2; what arrives is added to it. O(receivers) and one column a shot.
/// `report.iterations` counts shots, `report.residual` is the share of power that is still unshot.
SolveReport shoot(const ShootingProblem& problem, const ShootingOptions& options, std::span<Spectrum> unshot,
                  std::span<Spectrum> irradiance);

/// Power that is yet to be sent, W: sum_p A_p |u_p|, mean over the bands.
double unshot_power(std::span<const Spectrum> unshot, std::span<const double> patch_area);

}  // namespace exitance
