#include "exitance/visibility/glass/ray_fates.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/random.hpp"

namespace exitance {

RayFates::RayFates(const std::vector<Pane>& panes, const TracingFrame& frame) {
    shares_.reserve(panes.size());
    for (const Pane& pane : panes) {
        Shares& s = shares_.emplace_back();
        s.n = frame(pane.n);
        for (std::size_t k = 0; k <= steps; ++k) {
            const double cosine = static_cast<double>(k) / steps;
            s.through[k] = static_cast<float>(mean(pane.transmission(cosine)));
            s.back[k] = static_cast<float>(mean(pane.reflection(cosine)));
        }
    }
}

RayFate RayFates::operator()(const std::array<float, 3>& origin, const std::array<float, 3>& direction,
                             std::uint32_t pane) const {
    const Shares& s = shares_[pane];
    const Vec3 w = normalized(Vec3{direction[0], direction[1], direction[2]});
    const double at = std::min(1.0, std::abs(dot(s.n, w))) * steps;
    const auto k = std::min(static_cast<std::size_t>(at), steps - 1);
    const double share = at - static_cast<double>(k);
    const auto look_up = [&](const Table& t) { return (1 - share) * t[k] + share * t[k + 1]; };
    std::uint64_t key = hash(0x676c617373u, pane);
    for (const float v : origin) key = hash(key, std::bit_cast<std::uint32_t>(v));
    for (const float v : direction) key = hash(key, std::bit_cast<std::uint32_t>(v));
    const double chance = static_cast<double>(key >> 11) * 0x1p-53, through = look_up(s.through);
    if (chance < through) return RayFate::passes;
    return chance < through + look_up(s.back) ? RayFate::is_mirrored : RayFate::is_absorbed;
}

}  // namespace exitance
