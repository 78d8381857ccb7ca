#pragma once

#include <optional>

#include "exitance/links/cluster_refiner.hpp"
#include "exitance/links/link_refiner.hpp"
#include "exitance/methods/hierarchical/linked_system.hpp"
#include "exitance/methods/light/light_below.hpp"
#include "exitance/methods/light/nodal_light.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

/// State of a solve over the links of a hierarchy: elements, their light, and links between them. The steps of the
/// solve (link_rounds, ray_correction, hand_over) are functions of it.
struct Hierarchy {
    /// `held`: whether coefficients are stored for all elements or only for those that have links.
    Hierarchy(const MethodInput& input, HierarchyBasis kind, LinkSites::Held held);
    Hierarchy(const Hierarchy&) = delete;  // members refer to one another
    Hierarchy& operator=(const Hierarchy&) = delete;

    /// Groups pieces into clusters, room by room.
    void make_clusters();
    /// Projects direct light, reflected once, as the initial light of all elements. Source: [Gortler93].
    void project_direct();
    /// Refines links based on the present light. Source: [Hanrahan91].
    void refine(const LinkTolerance& tolerance);
    /// Solves b = rho (E_dir + F b) over the links, starting from the present b. `closed`: scale F so that no light is
    /// lost.
    void relax(bool closed = false);

    /// Mean reflected light of the surfaces times the square root of their area, W/m^2 m. Errors of links are relative
    /// to it.
    double light_norm() const;
    /// Total error of links of elements and of clusters, W/m^2 m.
    double link_error() const { return std::hypot(refiner.link_error(), far ? far->error() : 0); }
    std::size_t rays() const { return refiner.rays() + (far ? far->rays() : 0); }
    /// Share of the light carried by links that certainly have no blockers.
    double open_share() const;

    const Material& material(ElementId e) const { return input.stage.scene.material(light.tree.region(e)); }
    /// Evaluates `of_leaf` for all leaves and pulls the result up to all elements.
    NodalField pulled(const std::function<NodalValues(ElementId leaf)>& of_leaf) const;
    /// Returns F b, gathered over the links.
    NodalField gather() const;
    /// E_ind of any element no larger than those with coefficients: F b plus the correction by rays.
    NodalValues indirect_light(const NodalField& F_b, ElementId e) const;

    const MethodInput& input;
    bool is_polynomial;
    NodalBasis basis;
    GlobalLight light;
    LinkSites sites;
    LightBelow reflected_direct_below;       ///< rho E_dir of the leaves, for elements below those with coefficients.
    NodalField reflected_direct, radiosity;  ///< rho E_dir, and all reflected light b.
    LinkRefiner refiner;
    LinkedSystem system;
    std::optional<ClusterTree> clusters;  ///< Clusters; none if links start from all pairs of pieces.
    std::optional<ClusterRefiner> far;
    Field<ElementId, Spectrum> missed;  ///< Per leaf: the part of E_ind that links miss, found by rays; or empty.

  private:
    NodalValues reflected_once(ElementId leaf) const;
    void refine_panes_alike();
    void find_light_below(const std::vector<ElementId>& parents, Field<ElementId, double>& roughness);
};

}  // namespace exitance
