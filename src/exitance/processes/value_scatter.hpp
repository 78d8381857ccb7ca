#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "exitance/base/spectrum.hpp"
#include "exitance/processes/dealt_unknowns.hpp"

namespace exitance {

/// Moves values from the processes that hold them to one that reads them. PETSc's scatters do (solve/petsc.cpp); in a
/// build without PETSc everything goes to all (solve/petsc_none.cpp).
class ValueScatter {
  public:
    virtual ~ValueScatter() = default;
    /// `own`: the values of the own unknowns; `fetched`: those of the others that this process reads. All processes
    /// call it.
    virtual void fetch(std::span<const Spectrum> own, std::span<Spectrum> fetched) const = 0;
};

/// `read`: which unknowns of other processes this one reads, ascending. All processes call it.
std::shared_ptr<const ValueScatter> make_scatter(const DealtUnknowns& dealt, std::span<const std::uint32_t> read);

}  // namespace exitance
