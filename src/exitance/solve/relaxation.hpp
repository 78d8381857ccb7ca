#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// The discrete problem b = rhs + rho F b on the elements of a mesh, W/m^2. All spans have F.size() entries.
struct RadiositySystem {
    const TransportOperator& F;
    std::span<const Spectrum> reflectance;  ///< rho, in [0, 1)
    std::span<const Spectrum> rhs;          ///< Light that enters the system, W/m^2.
    std::span<const double> area;           ///< m^2; weights of the norms.
};

enum class Relaxation { jacobi, gauss_seidel, cg, gmres, southwell, chebyshev };

/// When to stop: the first of these that is reached.
struct StopRule {
    double residual = 1e-6;  ///< L2 norm of rhs + rho F b - b over that of rhs.
    std::size_t max_iterations = 1000;
    const StopRequest* request = nullptr;  ///< Asked after every iteration; may be null.
};

struct SolveReport {
    std::size_t iterations = 0;  ///< Applications of F.
    double residual = 0;         ///< Relative, see StopRule.
    bool converged = false;
    bool interrupted = false;
    /// Power that comes back by reflection after the first one, sum_i A_i (b_i - rhs_i), had F not been scaled to lose
    /// no light, by what it is; a value a band. 1 where it was not (`solve_conserving`).
    Spectrum unscaled{1.0};
};

/// L2 norm over the surfaces, all bands together: sqrt(sum_i A_i |b_i|^2).
double surface_norm(std::span<const Spectrum> b, std::span<const double> area);

/// Where F is dealt out to processes, each relaxes its own unknowns; all call this alike, and have all of b afterwards.
///
/// Iterates from the b given until the rule stops it. Missing the tolerance is a finding in the report, not an error.
///
/// - jacobi: b <- rhs + rho F b. Contracts while rho < 1 and no row of F sums past 1. One gather an iteration.
/// - gauss_seidel: the same, each element's new value used at once, in the order of elements. One gather an iteration;
///   sequential by nature.
/// - cg: conjugate gradients on the symmetric form (diag(A / rho) - A F) b = A rhs / rho, Jacobi-preconditioned;
///   elements with rho = 0 are known (b = rhs) and leave the system. Wants A_i F_ij = A_j F_ji; each band has its own
///   process.
/// - gmres: GMRES(20) on (I - rho F) b = rhs, any F; all bands have one Krylov space (solve/gmres.hpp).
///   Source: [Saad86].
/// - chebyshev: Jacobi with two terms, b' = a + w (rhs + rho F b - a) from b and the step before it, a; w from a bound
///   r on the eigenvalues of rho F, real and in [-r, r] by reciprocity. 1 / (1 - r^2)^(1/2) gathers where Jacobi takes
///   1 / (1 - r); no inner products. Source: [Golub61].
/// - southwell: shooting, see solve/shooting.hpp; asked for here it stands for gauss_seidel, which visits all in turn.
SolveReport solve_radiosity(const RadiositySystem& system, Relaxation method, std::span<Spectrum> b, StopRule stop);

}  // namespace exitance
