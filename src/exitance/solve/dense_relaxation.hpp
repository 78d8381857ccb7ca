#pragma once

#include <functional>

#include "exitance/solve/relaxation.hpp"

namespace exitance {

// Relaxations as textbooks have them, which call `swept` after every sweep, so that the light on its way can be looked
// at; and two that want the matrix itself. All solve b = rhs + rho F b from the b given; `report.iterations` counts
// sweeps over all elements.

/// Jacobi's: all elements at once. A gather a sweep.
SolveReport relax_at_once(const RadiositySystem& system, std::span<Spectrum> b, const StopRule& stop,
                          const std::function<void()>& swept);

/// Gauss and Seidel's (factor 1) and successive over-relaxation: b_i <- b_i + factor (rhs_i + rho_i (F b)_i - b_i), one
/// after the other. The factor in (0, 2).
SolveReport relax_in_turn(const RadiositySystem& system, double factor, std::span<Spectrum> b, const StopRule& stop,
                          const std::function<void()>& swept);

/// Southwell's: the entry whose residual carries most flux, A_i |r_i|, is relaxed, then the residual is brought up to
/// date by its column; never a sweep. As many steps as there are elements count as one sweep. Source: [Gortler94].
/// Makes the matrix: O(n^2) numbers.
SolveReport relax_largest_residual(const RadiositySystem& system, std::span<Spectrum> b, const StopRule& stop,
                                   const std::function<void()>& swept);

/// (I - rho F) b = rhs by elimination with partial pivoting, band by band. O(n^3), 16 n^2 bytes. A stop that is asked
/// for before the end leaves b as it was.
SolveReport solve_dense(const RadiositySystem& system, std::span<Spectrum> b, const StopRequest& stop);

}  // namespace exitance
