#pragma once

#include <optional>

#include "exitance/links/cluster_refiner.hpp"
#include "exitance/links/link_refiner.hpp"
#include "exitance/methods/hierarchical/linked_system.hpp"
#include "exitance/methods/light/light_below.hpp"
#include "exitance/methods/light/nodal_light.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

/// What a solve over the links of a hierarchy works on: elements, the light that they hold, and links between them.
/// The steps of the solve (link_rounds, ray_correction, hand_over) are functions of it.
struct Hierarchy {
    /// `held`: by all elements, or by those that links come to.
    Hierarchy(const MethodInput& input, HierarchyBasis kind, LinkSites::Held held);
    Hierarchy(const Hierarchy&) = delete;  // its parts refer to one another
    Hierarchy& operator=(const Hierarchy&) = delete;

    /// From now on pieces hang below clusters, room by room.
    void make_clusters();
    /// Projected direct light, reflected once, becomes the light of all elements. Source: [Gortler93].
    void project_direct();
    /// Links are refined by the light that there is. Source: [Hanrahan91].
    void refine(const LinkTolerance& tolerance);
    /// Gathers over the links until b = rho (E_dir + F b), from the b that there is. `closed`: with all light that
    /// leaves made to arrive.
    void relax(bool closed = false);

    /// Mean over the surfaces of the light that elements reflect, times the root of their area, W/m^2 m: what the
    /// errors of links are relative to.
    double light_norm() const;
    /// Errors of links of elements and of clusters, W/m^2 m.
    double link_error() const { return std::hypot(refiner.link_error(), far ? far->error() : 0); }
    std::size_t rays() const { return refiner.rays() + (far ? far->rays() : 0); }
    /// Share of the light carried by links that certainly meets nothing on its way.
    double open_share() const;

    const Material& material(ElementId e) const { return input.stage.scene.material(light.tree.region(e)); }
    /// What leaves hold, on all elements.
    NodalField pulled(const std::function<NodalValues(ElementId leaf)>& of_leaf) const;
    /// F b by the links.
    NodalField gather() const;
    /// E_ind of any element no larger than those that are held: F b, and what rays found it to miss.
    NodalValues indirect_light(const NodalField& F_b, ElementId e) const;

    const MethodInput& input;
    bool is_polynomial;
    NodalBasis basis;
    GlobalLight light;
    LinkSites sites;
    LightBelow reflected_direct_below;       ///< rho E_dir of leaves.
    NodalField reflected_direct, radiosity;  ///< rho E_dir, and all reflected light b.
    LinkRefiner refiner;
    LinkedSystem system;
    std::optional<ClusterTree> clusters;  ///< None where every piece is linked to every other to begin with.
    std::optional<ClusterRefiner> far;
    Field<ElementId, Spectrum> missed;  ///< By the links, of E_ind; of every leaf, or empty.

  private:
    NodalValues reflected_once(ElementId leaf) const;
    void refine_panes_alike();
    void find_light_below(const std::vector<ElementId>& parents, Field<ElementId, double>& roughness);
};

}  // namespace exitance
