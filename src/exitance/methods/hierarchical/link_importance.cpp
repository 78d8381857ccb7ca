#include "exitance/methods/hierarchical/link_importance.hpp"

#include "exitance/methods/importance.hpp"

namespace exitance {

Field<ElementId, double> find_link_importance(Hierarchy& h) {
    const ElementTree& tree = h.light.tree;
    const std::vector<Spectrum> points =
        importance_at(h.input.stage, tree, h.light.numbering, h.input.options.importance, h.input.options.seed);
    const std::vector<ElementId>& leaves = h.light.numbering.leaves;
    NodalField w(h.sites);
    const NodalField source = h.pulled([&](ElementId leaf) {
        NodalValues out{};
        out.fill(h.material(leaf).reflectance * points[h.light.numbering.number[leaf]]);
        return out;
    });
    NodalField v = source;
    h.system.solve(source, v);
    h.system.gather(v, w);
    Field<ElementId, double> importance(tree.size(), 0.0);
    double total = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const double here = mean(points[i] + mean_over(h.sites, w.values(leaves[i]), leaves[i]));
        importance[leaves[i]] = tree.area(leaves[i]) * std::max(0.0, here);
        total += importance[leaves[i]];
    }
    for (std::size_t e = importance.size(); e-- > 0;)
        for (ElementId child : tree.children(ElementId(e))) importance[ElementId(e)] += importance[child];
    constexpr double min_importance = 1e-6;  // derived from rounding
    for (ElementId e : importance.ids())
        importance[e] = std::max(min_importance, importance[e] / total * h.input.stage.area / tree.area(e));
    return importance;
}

}  // namespace exitance
