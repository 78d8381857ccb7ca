#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// The discrete problem b = rhs + rho F b on the elements of a mesh, W/m^2. All spans have F.size() entries.
struct RadiositySystem {
    const TransportOperator& F;
    std::span<const Spectrum> reflectance;  ///< Reflectances rho, in [0, 1).
    std::span<const Spectrum> rhs;          ///< Light that enters the system, W/m^2.
    std::span<const double> area;           ///< Areas, the weights of the norms, m^2.
};

enum class Relaxation { jacobi, gauss_seidel, cg, gmres, southwell, chebyshev };

/// Stopping criteria; the first that is met ends the iteration.
struct StopRule {
    double residual = 1e-6;  ///< L2 norm of rhs + rho F b - b over that of rhs.
    std::size_t max_iterations = 1000;
    const StopRequest* request = nullptr;  ///< Stop request, checked after every iteration; may be null.
};

struct SolveReport {
    std::size_t iterations = 0;  ///< Number of applications of F.
    double residual = 0;         ///< Relative residual, as defined at StopRule.
    bool converged = false;
    bool interrupted = false;
    /// Power of repeated reflection, sum_i A_i (b_i - rhs_i), without scaling of F over its value with scaling, per
    /// band. 1 if F was not scaled (`solve_conserving`).
    Spectrum unscaled{1.0};
};

/// L2 norm over the surfaces, all bands together: sqrt(sum_i A_i |b_i|^2).
double surface_norm(std::span<const Spectrum> b, std::span<const double> area);

/// Solves b = rhs + rho F b by iteration, starting from the given b, until a criterion of `stop` is met. Not reaching
/// the tolerance is stated in the report and is not an error. If F is distributed over processes, each relaxes its own
/// unknowns and all get the whole of b; collective.
///
/// - jacobi: b <- rhs + rho F b. Converges while rho < 1 and no row of F sums to more than 1. One gather per iteration.
/// - gauss_seidel: like jacobi, but each element's new value is used at once, in the order of elements. One gather per
///   iteration; sequential.
/// - cg: conjugate gradients on the symmetric form (diag(A / rho) - A F) b = A rhs / rho, Jacobi-preconditioned;
///   elements with rho = 0 are known (b = rhs) and are removed from the system. Requires A_i F_ij = A_j F_ji; each
///   band is solved separately.
/// - gmres: GMRES(20) on (I - rho F) b = rhs, any F; one Krylov space for all bands (solve/gmres.hpp).
///   Source: [Saad86].
/// - chebyshev: two-term Jacobi, b' = a + w (rhs + rho F b - a) from b and the previous iterate a; w from a bound r on
///   the eigenvalues of rho F, which are real and in [-r, r] by reciprocity. Needs 1 / (1 - r^2)^(1/2) gathers where
///   Jacobi needs 1 / (1 - r); no inner products.
///   Source: [Golub61].
/// - southwell: shooting, see solve/shooting.hpp. Here it means gauss_seidel, which visits all elements in turn.
SolveReport solve_radiosity(const RadiositySystem& system, Relaxation method, std::span<Spectrum> b, StopRule stop);

}  // namespace exitance
