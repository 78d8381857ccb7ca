#include "exitance/scene/other_side.hpp"

#include <bit>

#include "exitance/base/random.hpp"
#include "exitance/scene/joining/hash_chains.hpp"

namespace exitance {
namespace {

/// Returns a hash of a set of points that does not depend on their order.
std::uint64_t key_of(std::span<const Point> points, const Point& centre) {
    std::uint64_t key = 0;
    for (const Point& p : points) {
        const Vec3 d = p - centre;
        const auto bits = [](double x) {  // -0 is 0
            return std::bit_cast<std::uint32_t>(static_cast<float>(x) + 0.0f);
        };
        key += hash(bits(d.x), bits(d.y), bits(d.z));
    }
    return key;
}

template <class AnyId, class Key, class NormalOf>
Field<AnyId, AnyId> pair_up(std::size_t count, const Key& key, const NormalOf& normal) {
    HashChains chains(count);
    std::vector<std::uint64_t> keys(count);
    Field<AnyId, AnyId> out;
    for (std::size_t i = 0; i < count; ++i) {
        keys[i] = key(AnyId(i));
        for (std::uint32_t e = chains.first(keys[i]); e != HashChains::end; e = chains.next(e)) {
            if (keys[e] != keys[i] || dot(normal(AnyId(e)), normal(AnyId(i))) > -parallel_cosine) continue;
            out.resize(count);
            out[AnyId(i)] = AnyId(e), out[AnyId(e)] = AnyId(i);
            break;
        }
        chains.add(keys[i]);
    }
    return out;
}

}  // namespace

Field<SurfaceId, SurfaceId> other_sides_of_surfaces(const Scene& scene) {
    const Point centre = scene.box().centre();
    return pair_up<SurfaceId>(
        scene.surfaces().size(), [&](SurfaceId s) { return key_of(scene.outline(s), centre); },
        [&](SurfaceId s) { return scene.surfaces()[s].normal; });
}

bool is_second_side(const Scene& scene, const Field<SurfaceId, SurfaceId>& other_side, SurfaceId side) {
    if (other_side.size() == 0 || other_side[side].is_none()) return false;
    const SurfaceId first = other_side[side];
    const auto lies_on = [&](SurfaceId s) { return scene.regions()[scene.surfaces()[s].region].level > 0; };
    return first.value < side.value && other_side[first] == side && !lies_on(first) && !lies_on(side);
}

Field<RegionId, RegionId> other_sides_of_regions(const Scene& scene) {
    const Point centre = scene.box().centre();
    return pair_up<RegionId>(
        scene.regions().size(),
        [&](RegionId r) {
            std::uint64_t key = 0;
            for (const auto& loop : scene.regions()[r].loops) key += key_of(loop, centre);
            return key;
        },
        [&](RegionId r) { return scene.regions()[r].plane.n; });
}

}  // namespace exitance
