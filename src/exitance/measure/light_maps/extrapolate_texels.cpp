#include <algorithm>

#include "exitance/measure/light_maps/directed_irradiance.hpp"
#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/light_maps/texel_rings.hpp"

namespace exitance {
namespace {

using Source = LightMap::Source;

bool is_known(Source source) {
    return source == Source::computed || source == Source::extrapolated;
}

/// Fills the texels of one chart's rectangle.
class Filler {
  public:
    Filler(const Chart::Rectangle& room, LightMap& map) : room_(room), map_(map) {}

    /// Texels without a value that touch a known one.
    std::vector<TexelPlace> first_ring() const {
        std::vector<TexelPlace> ring;
        for (int y = room_.y; y < room_.y + room_.height; ++y)
            for (int x = room_.x; x < room_.x + room_.width; ++x)
                if (!is_known(source({x, y})) && touches_known({x, y})) ring.push_back({x, y});
        return ring;
    }

    void fill(const std::vector<TexelPlace>& ring, bool linear) {
        std::vector<Spectrum> values;
        for (const TexelPlace& t : ring) {
            values.push_back(value(t, linear && source(t) != Source::buried));
            continue_directed(known_around(t), values.back(), map_.index(t.x, t.y), map_);
        }
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::size_t at = map_.index(ring[i].x, ring[i].y);
            for (std::size_t b = 0; b < bands; ++b) map_.irradiance[at][b] = static_cast<float>(values[i][b]);
            map_.source[at] = Source::extrapolated;
        }
    }

    /// Texels without a value next to those that were just filled.
    std::vector<TexelPlace> next_ring(const std::vector<TexelPlace>& ring, bool with_buried) {
        std::vector<TexelPlace> next;
        for (const TexelPlace& t : ring)
            for (const TexelPlace& d : texel_neighbours) {
                const TexelPlace n = t + d;
                if (!is_inside(n) || is_known(source(n)) || (source(n) == Source::buried && !with_buried)) continue;
                next.push_back(n);
            }
        sort_texels(next, [&](const TexelPlace& t) { return map_.index(t.x, t.y); });
        return next;
    }

  private:
    bool is_inside(const TexelPlace& t) const {
        return t.x >= room_.x && t.y >= room_.y && t.x < room_.x + room_.width && t.y < room_.y + room_.height;
    }
    Source source(const TexelPlace& t) const { return map_.source[map_.index(t.x, t.y)]; }
    std::vector<std::size_t> known_around(const TexelPlace& t) const {
        std::vector<std::size_t> out;
        for (const TexelPlace& d : texel_neighbours) {
            const TexelPlace n = t + d;
            if (is_inside(n) && is_known(source(n))) out.push_back(map_.index(n.x, n.y));
        }
        return out;
    }
    bool touches_known(const TexelPlace& t) const {
        return std::any_of(texel_neighbours.begin(), texel_neighbours.end(), [&](const TexelPlace& d) {
            const TexelPlace n = t + d;
            return is_inside(n) && is_known(source(n));
        });
    }

    Spectrum value(const TexelPlace& t, bool linear) const {
        return value_from_neighbours(
            t, linear, [&](const TexelPlace& n) { return is_inside(n) && is_known(source(n)); },
            [&](const TexelPlace& n) { return source(n) == Source::computed; },
            [&](const TexelPlace& n) { return map_.at(map_.index(n.x, n.y)); });
    }

    const Chart::Rectangle room_;
    LightMap& map_;
};

}  // namespace

void extrapolate_texels(const Chart& chart, int reach, LightMap& map) {
    Filler filler(chart.room, map);
    std::vector<TexelPlace> ring = filler.first_ring();
    for (int k = 1; !ring.empty(); ++k) {
        filler.fill(ring, k == 1);
        ring = filler.next_ring(ring, k < reach);
    }
}

}  // namespace exitance
