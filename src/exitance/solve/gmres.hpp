#pragma once

#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// GMRES begins anew after so many steps.
inline constexpr int gmres_restart = 20;

/// GMRES(20) on (I - rho F) b = rhs, all bands in one Krylov space, by classical Gram-Schmidt [Saad86]. Vectors are
/// those of own unknowns (`system.F.dealt()`).
SolveReport gmres(const RadiositySystem& system, std::span<Spectrum> b, StopRule stop);

/// The same steps by PETSc's KSP on vectors that are spread over processes (solve/petsc.cpp), to the same bits; `gmres`
/// in a build without PETSc.
SolveReport gmres_over_processes(const RadiositySystem& system, std::span<Spectrum> b, StopRule stop);

/// out <- b - rho F b, of own unknowns.
void apply_system(const RadiositySystem& system, std::span<const Spectrum> b, std::span<Spectrum> out);

}  // namespace exitance
