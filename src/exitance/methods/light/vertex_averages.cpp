#include "exitance/methods/light/vertex_averages.hpp"

#include <cmath>
#include <map>
#include <tuple>

namespace exitance {

ElementFunction averaged_at_vertices(const ElementFunction& function, double rounding) {
    using Key = std::tuple<std::uint32_t, long long, long long, long long>;
    struct Sum {
        Spectrum total;
        double count = 0;
    };
    const ElementTree& tree = function.tree;
    const auto key = [&](ElementId e, const Point& p) {
        const auto cell = [&](double x) { return std::llround(x / rounding); };
        return Key{tree.region(e).value, cell(p.x), cell(p.y), cell(p.z)};
    };
    std::map<Key, Sum> sums;
    const std::vector<ElementId> leaves = tree.leaves();
    for (ElementId e : leaves)
        for (int i = 0; i < tree.patch(e).corner_count(); ++i) {
            Sum& sum = sums[key(e, tree.patch(e).corner(i))];
            sum.total += function.at({e, tree.patch(e).corner_uv(i)});
            sum.count += 1;
        }
    ElementFunction out;
    out.tree = tree;
    out.first_value.resize(tree.size(), 0);
    for (ElementId e : leaves) {
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int i = 0; i < tree.patch(e).corner_count(); ++i) {
            const Sum& sum = sums[key(e, tree.patch(e).corner(i))];
            out.add_value(sum.total / sum.count);
        }
    }
    return out;
}

}  // namespace exitance
