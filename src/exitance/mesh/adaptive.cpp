#include "exitance/mesh/adaptive.hpp"

namespace exitance {
namespace {

/// The line through a cell's centroid perpendicular to its longest extent, measured in space.
CutLine across_longest_extent(const ElementTree& tree, ElementId e) {
    const std::vector<Vec2> domain = tree.domain(e);
    const Patch& patch = tree.patch(e);
    Vec3 longest;
    for (std::size_t i = 0; i < domain.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 d = patch.at(domain[i]) - patch.at(domain[j]);
            if (squared_norm(d) > squared_norm(longest)) longest = d;
        }
    // Points p(u, v) with longest . p constant: the normal in (u, v) is (longest . a, longest . b).
    Vec2 normal = {dot(longest, patch.a), dot(longest, patch.b)};
    normal = (1 / std::hypot(normal.x, normal.y)) * normal;
    return {normal, dot(normal, tree.centre(e))};
}

}  // namespace

IdRange<ElementId> refine_element(ElementTree& tree, ElementId leaf, Cut only) {
    if (tree.is_cell(leaf)) {
        tree.split_by_line(leaf, across_longest_extent(tree, leaf));
        return tree.children(leaf);
    }
    const Patch& patch = tree.patch(leaf);
    const double a = norm(patch.a), b = norm(patch.b);
    // Ratio of sides above which only the longer one is halved. Derived from sqrt(2), above which that improves the
    // shape, and rounded up so that 3 : 2 still counts as not longer, however coordinates are rounded.
    constexpr double long_ratio = 1.5 * (1 + 1e-6);
    tree.split(leaf, only != Cut::none     ? only
                     : patch.is_triangle() ? Cut::both
                     : a > long_ratio * b  ? Cut::u
                     : b > long_ratio * a  ? Cut::v
                                           : Cut::both);
    return tree.children(leaf);
}

Cut sufficient_cut(double misfit_squared, const std::array<double, 2>& along, double allowed_squared) {
    const double most = std::max(along[0], along[1]);
    if (!(most > 0) || !(misfit_squared - most <= allowed_squared)) return Cut::none;
    return along[0] >= along[1] ? Cut::u : Cut::v;
}

}  // namespace exitance
