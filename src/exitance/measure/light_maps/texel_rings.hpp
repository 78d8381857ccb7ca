#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "exitance/base/spectrum.hpp"

namespace exitance {

/// Position of a texel in a map, or a step from one texel to another.
struct TexelPlace {
    int x, y;
    TexelPlace operator+(const TexelPlace& o) const { return {x + o.x, y + o.y}; }
};

/// Steps to the neighbours of a texel: the four nearest ones first.
constexpr std::array<TexelPlace, 8> texel_neighbours{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
constexpr std::size_t nearest_neighbours = 4;

/// Sorts texels by their indices in the map, and removes repeated ones.
template <class Index>
void sort_texels(std::vector<TexelPlace>& texels, const Index& index) {
    std::sort(texels.begin(), texels.end(),
              [&](const TexelPlace& a, const TexelPlace& b) { return index(a) < index(b); });
    const auto last = std::unique(texels.begin(), texels.end(),
                                  [&](const TexelPlace& a, const TexelPlace& b) { return index(a) == index(b); });
    texels.erase(last, texels.end());
}

/// Value of a texel: the mean over its usable neighbours or, if `linear`, over linear extrapolations from them and from
/// the texels behind them, which change the neighbour's value by half at most. Prefers the four nearest neighbours.
/// is_usable(t)   true if the value of texel t may be used
/// is_computed(t) true if texel t was not extrapolated itself; only such texels are extrapolated from
/// value(t)       light of texel t
template <class IsUsable, class IsComputed, class Value>
Spectrum value_from_neighbours(const TexelPlace& t, bool linear, const IsUsable& is_usable,
                               const IsComputed& is_computed, const Value& value) {
    Spectrum sum;
    int count = 0;
    for (std::size_t k = 0; k < texel_neighbours.size() && (k < nearest_neighbours || count == 0 || !linear); ++k) {
        const TexelPlace near = t + texel_neighbours[k], far = near + texel_neighbours[k];
        if (!is_usable(near)) continue;
        Spectrum light = value(near);
        // Texels of a curved border have been extrapolated already.
        if (linear && is_computed(near) && is_usable(far)) {
            const Spectrum before = value(far);
            for (std::size_t b = 0; b < bands; ++b)
                light[b] = std::clamp(2 * light[b] - before[b], 0.5 * light[b], 1.5 * light[b]);
        }
        sum += light, ++count;
    }
    return sum / std::max(count, 1);
}

}  // namespace exitance
