#include "exitance/transport/narrow_places.hpp"

#include <array>

#include "exitance/core/random.hpp"
#include "exitance/transport/distributed.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t looks = 4;  ///< Of a leaf.

/// Is something in front of the leaf at one of its places, nearer than the leaf is wide?
bool is_narrow(const Stage& stage, const ElementTree& tree, ElementId e, double touching) {
    const RegionId region = tree.region(e);
    const Normal& n = stage.scene.regions()[region].plane.n;
    const ScrambledSobol places(hash(static_cast<std::uint64_t>(Stream::mesh), e.value));
    std::array<Point, looks> x;
    std::array<Vec3, looks> up;
    std::array<RayHit, looks> hits;
    for (std::uint32_t k = 0; k < looks; ++k) {
        x[k] = tree.patch(e).at(tree.uniform(e, places(k, 0), places(k, 1)));
        up[k] = n;
    }
    stage.tracer.nearest(x, up, region, hits);
    const double width = std::sqrt(tree.area(e));
    return std::any_of(hits.begin(), hits.end(),
                       [&](const RayHit& hit) { return hit.front && hit.distance > touching && hit.distance < width; });
}

}  // namespace

Field<ElementId, std::uint8_t> find_narrow_leaves(const Stage& stage, const ElementTree& tree) {
    constexpr double coplanar = 1e-6;  // of the scene's size, as Occluders::is_covered has it
    const double touching = coplanar * stage.scene.size();
    Field<ElementId, std::uint8_t> out(tree.size());
    const std::vector<ElementId> leaves = tree.leaves();
    shared_ranges(
        leaves.size(), 256,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (!stage.is_left_out(tree.region(leaves[i])))
                    out[leaves[i]] = is_narrow(stage, tree, leaves[i], touching) ? 1 : 0;
        },
        [&](std::size_t i) -> std::uint8_t& { return out[leaves[i]]; }, {"narrow places"});
    return out;
}

}  // namespace exitance
