#pragma once

#include <cstddef>
#include <span>

#include "exitance/base/spectrum.hpp"
#include "exitance/processes/dealt_unknowns.hpp"

namespace exitance {

/// Diffuse transport between the elements of a mesh, E = F B. How F is held is the operator's affair: a dense matrix,
/// rows of rays, columns made when asked for, or the links of a hierarchy.
class TransportOperator {
  public:
    virtual ~TransportOperator() = default;

    virtual std::size_t size() const = 0;
    /// irradiance[i] = sum_j F_ij radiosity[j], both W/m^2, both of size() entries; they must not overlap.
    virtual void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const = 0;
    /// The same for one receiver.
    virtual Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const = 0;
    virtual std::size_t memory_bytes() const = 0;

    /// How processes hold vectors while they solve with it. Those that have all of every row hold all.
    virtual DealtUnknowns dealt() const { return DealtUnknowns(size()); }
    /// `gather` of what this process holds of both, dealt().own_count() entries. All processes call it.
    virtual void gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
        gather(radiosity, irradiance);
    }

  protected:
    /// `gather` by way of `gather_own`, for operators that are dealt out: all processes have all of `irradiance`.
    void gather_dealt(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
        const DealtUnknowns unknowns = dealt();
        const std::vector<Spectrum> own = unknowns.own_part(radiosity);
        std::vector<Spectrum> out(own.size());
        gather_own(own, out);
        unknowns.tell<Spectrum>(out, irradiance, "solve");
    }
};

}  // namespace exitance
