#include <algorithm>

#include "exitance/measure/light_maps/directed_irradiance.hpp"
#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance {
namespace {

using Source = LightMap::Source;

bool is_known(Source source) {
    return source == Source::computed || source == Source::extrapolated;
}

/// Position of a texel in the map.
struct Texel {
    int x, y;
};

constexpr std::array<Texel, 8> around{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

/// Fills the texels of one chart's rectangle.
class Filler {
  public:
    Filler(const Chart::Rectangle& room, LightMap& map) : room_(room), map_(map) {}

    /// Texels without a value that touch a known one.
    std::vector<Texel> first_ring() const {
        std::vector<Texel> ring;
        for (int y = room_.y; y < room_.y + room_.height; ++y)
            for (int x = room_.x; x < room_.x + room_.width; ++x)
                if (!is_known(source({x, y})) && touches_known({x, y})) ring.push_back({x, y});
        return ring;
    }

    void fill(const std::vector<Texel>& ring, bool linear) {
        std::vector<Spectrum> values;
        for (const Texel& t : ring) {
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
    std::vector<Texel> next_ring(const std::vector<Texel>& ring, bool with_buried) {
        std::vector<Texel> next;
        for (const Texel& t : ring)
            for (const Texel& d : around) {
                const Texel n{t.x + d.x, t.y + d.y};
                if (!is_inside(n) || is_known(source(n)) || (source(n) == Source::buried && !with_buried)) continue;
                next.push_back(n);
            }
        const auto key = [&](const Texel& t) { return map_.index(t.x, t.y); };
        std::sort(next.begin(), next.end(), [&](const Texel& a, const Texel& b) { return key(a) < key(b); });
        next.erase(
            std::unique(next.begin(), next.end(), [&](const Texel& a, const Texel& b) { return key(a) == key(b); }),
            next.end());
        return next;
    }

  private:
    bool is_inside(const Texel& t) const {
        return t.x >= room_.x && t.y >= room_.y && t.x < room_.x + room_.width && t.y < room_.y + room_.height;
    }
    Source source(const Texel& t) const { return map_.source[map_.index(t.x, t.y)]; }
    std::vector<std::size_t> known_around(const Texel& t) const {
        std::vector<std::size_t> out;
        for (const Texel& d : around) {
            const Texel n{t.x + d.x, t.y + d.y};
            if (is_inside(n) && is_known(source(n))) out.push_back(map_.index(n.x, n.y));
        }
        return out;
    }
    bool touches_known(const Texel& t) const {
        return std::any_of(around.begin(), around.end(), [&](const Texel& d) {
            const Texel n{t.x + d.x, t.y + d.y};
            return is_inside(n) && is_known(source(n));
        });
    }

    /// Mean over the known neighbours or, if `linear`, of linear extrapolations from them. Prefers the four nearest
    /// ones.
    Spectrum value(const Texel& t, bool linear) const {
        Spectrum sum;
        int count = 0;
        for (std::size_t k = 0; k < around.size() && (k < 4 || count == 0 || !linear); ++k) {
            const Texel d = around[k], near{t.x + d.x, t.y + d.y}, far{near.x + d.x, near.y + d.y};
            if (!is_inside(near) || !is_known(source(near))) continue;
            Spectrum light = map_.at(map_.index(near.x, near.y));
            // Texels of a curved border have been extrapolated already.
            const bool goes_on = linear && source(near) == Source::computed;
            if (goes_on && is_inside(far) && is_known(source(far))) light = going_on(light, far);
            sum += light, ++count;
        }
        return sum / std::max(count, 1);
    }

    Spectrum going_on(const Spectrum& near, const Texel& far) const {
        const Spectrum before = map_.at(map_.index(far.x, far.y));
        Spectrum out;
        for (std::size_t b = 0; b < bands; ++b)
            out[b] = std::clamp(2 * near[b] - before[b], 0.5 * near[b], 1.5 * near[b]);
        return out;
    }

    const Chart::Rectangle room_;
    LightMap& map_;
};

}  // namespace

void extrapolate_texels(const Chart& chart, int reach, LightMap& map) {
    Filler filler(chart.room, map);
    std::vector<Texel> ring = filler.first_ring();
    for (int k = 1; !ring.empty(); ++k) {
        filler.fill(ring, k == 1);
        ring = filler.next_ring(ring, k < reach);
    }
}

}  // namespace exitance
