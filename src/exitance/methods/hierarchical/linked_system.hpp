#pragma once

#include <optional>

#include "exitance/links/cluster_links.hpp"
#include "exitance/links/links.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/transport/passed_light.hpp"

namespace exitance {

/// The radiosity equation over the links of a hierarchy, and over cluster links if there are any.
class LinkedSystem {
  public:
    /// `sites`: the linked elements; must outlive this object.
    LinkedSystem(const MethodInput& input, const LinkSites& sites) : input_(input), sites_(sites) {}

    void set_links(Links near, std::optional<ClusterLinks> far = {});

    /// Solves x = rhs + rho F x for the radiosity of the elements, W/m^2, starting from x. Both `rhs` and `x` are
    /// pulled.
    ///
    /// The system is solved on the part of the hierarchy that has links. Elements below its ends, where the mesh
    /// follows direct light, receive the light of these ends, and the ends send the mean of their light: the result is
    /// the same.
    ///
    /// `closed`: scales F so that no light is lost; `scale` returns the factor.
    SolveReport solve(const NodalField& rhs, NodalField& x, bool closed = false);

    /// Computes E = F b, W/m^2, at the ends of the stored hierarchy, without scaling.
    void gather(const NodalField& b, NodalField& E) const;

    const Spectrum& scale() const { return scale_; }  ///< Factor of the links' light, see ConservingTransport.
    std::size_t size() const { return near_->size() + (far_ ? far_->size() : 0); }
    std::size_t memory_bytes() const { return near_->memory_bytes() + (far_ ? far_->memory_bytes() : 0); }
    const Links& links() const { return *near_; }  ///< Links between elements.

  private:
    PassedLight passed_between(std::span<const ElementId> ends) const;

    const MethodInput& input_;
    const LinkSites& sites_;
    std::optional<Links> near_;
    std::optional<ClusterLinks> far_;
    Spectrum scale_{1.0};
};

}  // namespace exitance
