#pragma once

#include <functional>

#include "exitance/solve/relaxation.hpp"

namespace exitance {

// Textbook relaxations, which call `swept` after every sweep, so that the intermediate light can be examined, and two
// methods that need the matrix itself. All solve b = rhs + rho F b, starting from the given b; `report.iterations`
// counts sweeps over all elements.

/// Jacobi relaxation: updates all elements at once. One gather per sweep.
SolveReport relax_at_once(const RadiositySystem& system, std::span<Spectrum> b, const StopRule& stop,
                          const std::function<void()>& swept);

/// Gauss-Seidel relaxation (factor 1) and successive over-relaxation: b_i <- b_i + factor (rhs_i + rho_i (F b)_i -
/// b_i), element by element. The factor must be in (0, 2).
SolveReport relax_in_turn(const RadiositySystem& system, double factor, std::span<Spectrum> b, const StopRule& stop,
                          const std::function<void()>& swept);

/// Southwell relaxation: relaxes the entry with the largest residual flux A_i |r_i|, then updates the residual by that
/// entry's column. n steps count as one sweep, where n is the number of elements. Stores the matrix: O(n^2) numbers.
/// Source: [Gortler94].
SolveReport relax_largest_residual(const RadiositySystem& system, std::span<Spectrum> b, const StopRule& stop,
                                   const std::function<void()>& swept);

/// Solves (I - rho F) b = rhs by elimination with partial pivoting, band by band. O(n^3), 16 n^2 bytes. On a stop
/// request the remaining bands of b keep their values.
SolveReport solve_dense(const RadiositySystem& system, std::span<Spectrum> b, const StopRequest& stop);

}  // namespace exitance
