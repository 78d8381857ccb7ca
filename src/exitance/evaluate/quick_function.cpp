#include "exitance/evaluate/quick_function.hpp"

#include "exitance/processes/distributed.hpp"

namespace exitance {

QuickFunction::Polynomial QuickFunction::polynomial(ElementId leaf, ElementId root) const {
    const Patch patch = function_->tree.patch(leaf), whole = function_->tree.patch(root);
    const Vec2 middle = whole.coordinates(patch.at(0.5, 0.5));
    Polynomial p{static_cast<float>(middle.x), static_cast<float>(middle.y), {}};
    // Coordinates of the centre in the leaf's system, and their derivatives along the root's axes. The axes of a
    // parallelogram are parallel to the root's, so that its uv is a multiple of the root's uv.
    const Point origin = whole.at(p.u, p.v);
    const Vec2 at = patch.coordinates(origin), along_u = patch.coordinates(origin + whole.a) - at,
               along_v = patch.coordinates(origin + whole.b) - at;
    const auto* corner = &function_->values[function_->first_value[leaf]];
    for (std::size_t k = 0; k < bands; ++k) {
        const double c0 = corner[0][k], cu = corner[1][k] - c0, cv = corner[patch.is_triangle() ? 2 : 3][k] - c0;
        const double cm = patch.is_triangle() ? 0 : corner[2][k] - c0 - cu - cv;
        const double du = cu + cm * at.y, dv = cv + cm * at.x;
        const double value[4] = {c0 + cu * at.x + cv * at.y + cm * at.x * at.y, du * along_u.x + dv * along_u.y,
                                 du * along_v.x + dv * along_v.y, cm * along_u.x * along_v.y};
        for (std::size_t i = 0; i < 4; ++i) p.coefficient[i][k] = static_cast<float>(value[i]);
    }
    return p;
}

QuickFunction::QuickFunction(const ElementFunction& function, std::size_t region_count)
    : function_(&function), locator_(function.tree, region_count) {
    const ElementTree& tree = function.tree;
    const bool has_all = locator_.leaves().own_leaves() == locator_.leaves().size();
    Field<ElementId, ElementId> root(has_all ? tree.size() : tree.first_of_fans().value);
    leaves_.reserve(locator_.leaves().own_leaves());
    for (ElementId e : root.ids()) {
        root[e] = tree.parent(e).is_none() ? e : root[tree.parent(e)];
        if (tree.is_leaf(e)) leaves_.push_back(polynomial(e, root[e]));
    }
    if (has_all) function_ = nullptr;
    share_on_node(std::span(leaves_)), share_on_node(locator_.leaves());
}

void QuickFunction::read(std::span<const RayEnd> hits, std::span<Spectrum> values) const {
    constexpr std::size_t together = 32;
    std::array<LeafFinder::Query, together> queries;
    for (std::size_t first = 0; first < hits.size(); first += together) {
        const std::size_t count = std::min(together, hits.size() - first);
        for (std::size_t i = 0; i < count; ++i)
            locator_.find_root(hits[first + i].region, hits[first + i].x, queries[i]);
        locator_.leaves().find(std::span(queries).first(count));
        for (std::size_t i = 0; i < count; ++i)
            if (queries[i].leaf < leaves_.size()) __builtin_prefetch(leaves_.data() + queries[i].leaf);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t leaf = queries[i].leaf;
            Polynomial made;
            if (leaf >= leaves_.size())
                made = polynomial(locator_.leaves().id(leaf), function_->tree.roots()[queries[i].root]);
            const Polynomial& p = leaf < leaves_.size() ? leaves_[leaf] : made;
            const double u = queries[i].uv.x - p.u, v = queries[i].uv.y - p.v, uv = u * v;
            const auto& c = p.coefficient;
            for (std::size_t b = 0; b < bands; ++b)
                values[first + i][b] = c[0][b] + u * c[1][b] + v * c[2][b] + uv * c[3][b];
        }
    }
}

}  // namespace exitance
