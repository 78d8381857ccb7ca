#pragma once

#include "exitance/links/link_sites.hpp"

namespace exitance {

/// Elements of a scene of at most 0.5 m with link sites, and reflected light b(x) at their nodes.
struct LitElements {
    Stage stage;
    ElementTree tree;
    NodalBasis basis;
    LinkSites sites;
    NodalField b;

    template <class Light>
    LitElements(const Scene& scene, HierarchyBasis kind, const Light& light)
        : stage(scene), tree(stage.make_elements({0.5, 0})), basis(kind), sites(stage, tree, basis), b(sites) {
        for (ElementId e : tree.leaves())
            for (std::size_t k = 0; k < sites.nodes(); ++k) b.set_node(e, k, Spectrum(light(sites.node(e, k))));
        b.pull();
    }
};

}  // namespace exitance
