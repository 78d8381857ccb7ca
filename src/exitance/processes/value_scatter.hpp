#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "exitance/base/spectrum.hpp"
#include "exitance/processes/dealt_unknowns.hpp"

namespace exitance {

/// Transfers values from the processes that own them to a process that reads them. Implemented by PETSc's scatters
/// (solve/petsc.cpp); a build without PETSc sends everything to all (solve/petsc_none.cpp).
class ValueScatter {
  public:
    virtual ~ValueScatter() = default;
    /// `own`: values of the own unknowns; `fetched`: receives the values of the other processes' unknowns that this one
    /// reads. Collective.
    virtual void fetch(std::span<const Spectrum> own, std::span<Spectrum> fetched) const = 0;
};

/// `read`: unknowns of other processes that this one reads, ascending. Collective.
std::shared_ptr<const ValueScatter> make_scatter(const DealtUnknowns& dealt, std::span<const std::uint32_t> read);

}  // namespace exitance
