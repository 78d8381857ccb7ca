#pragma once

#include <cstddef>
#include <span>

#include "exitance/core/spectrum.hpp"

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
};

}  // namespace exitance
