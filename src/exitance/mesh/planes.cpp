#include "exitance/mesh/planes.hpp"

#include <algorithm>
#include <tuple>

#include "exitance/mesh/contact_lines.hpp"
#include "exitance/scene/joining/weld.hpp"

namespace exitance {

Field<RegionId, std::uint32_t> plane_of_regions(const Scene& scene) {
    std::vector<Point> normals;
    for (const Region& region : scene.regions()) normals.push_back(Point{} + region.plane.n);
    const std::vector<std::uint32_t> direction = weld(normals, contact_share);
    std::vector<RegionId> order(scene.regions().ids().begin(), scene.regions().ids().end());
    const auto key = [&](RegionId r) {
        const Region& region = scene.regions()[r];
        return std::tuple(direction[r.value], region.level, region.plane.offset, r.value);
    };
    std::sort(order.begin(), order.end(), [&](RegionId a, RegionId b) { return key(a) < key(b); });
    std::vector<std::uint32_t> first(order.size());  // per region: the first region of its plane
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool apart = i == 0 || direction[order[i].value] != direction[order[i - 1].value] ||
                           scene.regions()[order[i]].level != scene.regions()[order[i - 1]].level ||
                           scene.regions()[order[i]].plane.offset - scene.regions()[order[i - 1]].plane.offset >
                               contact_share * scene.size();
        first[order[i].value] = apart ? order[i].value : first[order[i - 1].value];
    }
    Field<RegionId, std::uint32_t> out;
    out.resize(order.size());
    std::vector<std::uint32_t> number(order.size(), ~0u);
    std::uint32_t count = 0;
    for (RegionId r : scene.regions().ids()) {
        std::uint32_t& n = number[first[r.value]];
        if (n == ~0u) n = count++;
        out[r] = n;
    }
    return out;
}

std::vector<std::vector<ElementId>> leaves_of_planes(const ElementTree& tree,
                                                     const Field<RegionId, std::uint32_t>& plane) {
    std::uint32_t count = 0;
    for (const std::uint32_t p : plane) count = std::max(count, p + 1);
    std::vector<std::vector<ElementId>> out(count);
    for (ElementId e : tree.leaves()) out[plane[tree.region(e)]].push_back(e);
    return out;
}

}  // namespace exitance
