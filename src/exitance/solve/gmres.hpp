#pragma once

#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// Steps after which GMRES restarts.
inline constexpr int gmres_restart = 20;

/// GMRES(20) on (I - rho F) b = rhs, with one Krylov space for all bands, by classical Gram-Schmidt. All vectors
/// contain own unknowns (`system.F.dealt()`).
/// Source: [Saad86].
SolveReport gmres(const RadiositySystem& system, std::span<Spectrum> b, StopRule stop);

/// Like `gmres`, by PETSc's KSP on vectors distributed over processes (solve/petsc.cpp), with the same bits. Calls
/// `gmres` in a build without PETSc.
SolveReport gmres_over_processes(const RadiositySystem& system, std::span<Spectrum> b, StopRule stop);

/// out <- b - rho F b, for own unknowns.
void apply_system(const RadiositySystem& system, std::span<const Spectrum> b, std::span<Spectrum> out);

}  // namespace exitance
