#pragma once

#include <optional>

#include "exitance/links/cluster_links.hpp"
#include "exitance/links/links.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/transport/passed_light.hpp"

namespace exitance {

/// The equation of light over the links of a hierarchy, and over those of clusters where there are any.
class LinkedSystem {
  public:
    /// `sites`, which must outlive it, of the elements that are linked.
    LinkedSystem(const MethodInput& input, const LinkSites& sites) : input_(input), sites_(sites) {}

    void set_links(Links near, std::optional<ClusterLinks> far = {});

    /// x = rhs + rho F x for what leaves the elements, W/m^2, from the x that there is; both as pulled.
    ///
    /// Solved on the part of the hierarchy that links touch. Below its ends, where the mesh follows direct light, all
    /// elements receive what the ends do, and the ends send what rhs and that come to: the answer is the same.
    ///
    /// `closed`: with all light that leaves made to arrive; then `scale` says by how much more than links bring.
    SolveReport solve(const NodalField& rhs, NodalField& x, bool closed = false);

    /// E = F b, W/m^2, of the ends of what is held; unscaled.
    void gather(const NodalField& b, NodalField& E) const;

    const Spectrum& scale() const { return scale_; }  ///< Of what links bring, see ConservingTransport.
    std::size_t size() const { return near_->size() + (far_ ? far_->size() : 0); }
    std::size_t memory_bytes() const { return near_->memory_bytes() + (far_ ? far_->memory_bytes() : 0); }
    const Links& links() const { return *near_; }  ///< Those between elements.

  private:
    PassedLight passed_between(std::span<const ElementId> ends) const;

    const MethodInput& input_;
    const LinkSites& sites_;
    std::optional<Links> near_;
    std::optional<ClusterLinks> far_;
    Spectrum scale_{1.0};
};

}  // namespace exitance
