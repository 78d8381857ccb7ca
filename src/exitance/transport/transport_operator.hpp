#pragma once

#include <cstddef>
#include <span>

#include "exitance/base/spectrum.hpp"
#include "exitance/processes/dealt_unknowns.hpp"

namespace exitance {

/// Diffuse transport between the elements of a mesh, E = F B. Implementations store F as a dense matrix, as rows of
/// rays, as columns computed on demand, or as the links of a hierarchy.
class TransportOperator {
  public:
    virtual ~TransportOperator() = default;

    virtual std::size_t size() const = 0;
    /// irradiance[i] = sum_j F_ij radiosity[j], both W/m^2, both of size() entries; they must not overlap.
    virtual void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const = 0;
    /// Returns irradiance[receiver] of gather(), without computing the others.
    virtual Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const = 0;
    virtual std::size_t memory_bytes() const = 0;

    /// Distribution of vectors over processes during a solve. By default every process stores all rows and all
    /// unknowns.
    virtual DealtUnknowns dealt() const { return DealtUnknowns(size()); }
    /// Like `gather`, for vectors of dealt().own_count() values, the own part of each. Collective.
    virtual void gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
        gather(radiosity, irradiance);
    }

  protected:
    /// Implements `gather` by `gather_own` for distributed operators; all processes get the whole `irradiance`.
    /// Collective.
    void gather_dealt(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
        const DealtUnknowns unknowns = dealt();
        const std::vector<Spectrum> own = unknowns.own_part(radiosity);
        std::vector<Spectrum> out(own.size());
        gather_own(own, out);
        unknowns.tell<Spectrum>(out, irradiance, "solve");
    }
};

}  // namespace exitance
