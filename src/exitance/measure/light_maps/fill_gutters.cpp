#include <algorithm>

#include "exitance/measure/light_maps/directed_irradiance.hpp"
#include "exitance/measure/light_maps/texel_rings.hpp"
#include "exitance/measure/light_maps/uv_light_map.hpp"

namespace exitance {
namespace {

using Source = LightMap::Source;
constexpr std::uint32_t no_chart = UvLayout::no_chart;

/// For each of texel_neighbours: its quarters (UvLightMap::quarters) from which bilinear lookups read the texel.
constexpr std::array<std::uint8_t, 8> reading{1 | 4, 2 | 8, 1 | 2, 4 | 8, 1, 2, 4, 8};

class GutterFiller {
  public:
    explicit GutterFiller(UvLightMap& map) : map_(map) {}

    /// Texels without a value that touch a known one, in the order of the map.
    std::vector<TexelPlace> first_ring() const {
        std::vector<TexelPlace> ring;
        for (int y = 0; y < map_.light.size.height; ++y)
            for (int x = 0; x < map_.light.size.width; ++x)
                if (!is_known({x, y}) && chart_for({x, y}) != no_chart) ring.push_back({x, y});
        return ring;
    }

    void fill(const std::vector<TexelPlace>& ring, bool is_first) {
        struct Filled {
            std::uint32_t chart;
            Spectrum irradiance, radiosity;
        };
        std::vector<Filled> filled;
        for (const TexelPlace& t : ring) {
            const std::uint32_t chart = chart_for(t);
            const bool linear = is_first && source(t) != Source::buried;
            filled.push_back(
                {chart, value(t, chart, map_.light.irradiance, linear), value(t, chart, map_.radiosity, linear)});
            continue_directed(known_of(t, chart), filled.back().irradiance, index(t), map_.light);
            map_.close_texels += is_first && source(t) == Source::nothing && is_read_by_other(t, chart);
        }
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::size_t at = index(ring[i]);
            for (std::size_t b = 0; b < bands; ++b) {
                map_.light.irradiance[at][b] = static_cast<float>(filled[i].irradiance[b]);
                map_.radiosity[at][b] = static_cast<float>(filled[i].radiosity[b]);
            }
            map_.light.source[at] = Source::extrapolated;
            map_.chart[at] = filled[i].chart;
        }
    }

    /// Texels outside of charts next to those that were just filled.
    std::vector<TexelPlace> next_ring(const std::vector<TexelPlace>& ring) const {
        std::vector<TexelPlace> next;
        for (const TexelPlace& t : ring)
            for (const TexelPlace& d : texel_neighbours) {
                const TexelPlace n = t + d;
                if (is_inside(n) && source(n) == Source::nothing) next.push_back(n);
            }
        sort_texels(next, [&](const TexelPlace& t) { return index(t); });
        return next;
    }

  private:
    std::size_t index(const TexelPlace& t) const { return map_.light.index(t.x, t.y); }
    Source source(const TexelPlace& t) const { return map_.light.source[index(t)]; }
    bool is_inside(const TexelPlace& t) const {
        return t.x >= 0 && t.y >= 0 && t.x < map_.light.size.width && t.y < map_.light.size.height;
    }
    bool is_known(const TexelPlace& t) const {
        return is_inside(t) && (source(t) == Source::computed || source(t) == Source::extrapolated);
    }

    /// Known texels of a chart around a texel.
    std::vector<std::size_t> known_of(const TexelPlace& t, std::uint32_t chart) const {
        std::vector<std::size_t> out;
        for (const TexelPlace& d : texel_neighbours) {
            const TexelPlace n = t + d;
            if (is_known(n) && map_.chart[index(n)] == chart) out.push_back(index(n));
        }
        return out;
    }

    /// The chart that a texel continues: its own if the texel is covered and a neighbour has it, else the one with the
    /// most votes of neighbours. Those from which lookups read the texel outvote all others, and the four nearest count
    /// twice. None without known neighbours.
    std::uint32_t chart_for(const TexelPlace& t) const {
        constexpr int of_reader = 16;
        std::array<std::pair<std::uint32_t, int>, texel_neighbours.size()> votes;
        std::size_t count = 0;
        const std::uint32_t own = map_.chart[index(t)];
        for (std::size_t k = 0; k < texel_neighbours.size(); ++k) {
            const TexelPlace n = t + texel_neighbours[k];
            if (!is_known(n)) continue;
            const std::uint32_t chart = map_.chart[index(n)];
            if (chart == own) return own;
            const auto end = votes.begin() + static_cast<std::ptrdiff_t>(count);
            const auto vote = std::find_if(votes.begin(), end, [&](const auto& v) { return v.first == chart; });
            if (vote == end) votes[count++] = {chart, 0};
            vote->second += (k < nearest_neighbours ? 2 : 1) * (is_read_from(n, k) ? of_reader : 1);
        }
        const auto end = votes.begin() + static_cast<std::ptrdiff_t>(count);
        const auto best = std::min_element(votes.begin(), end, [](const auto& a, const auto& b) {
            return a.second != b.second ? a.second > b.second : a.first < b.first;
        });
        return best == end ? no_chart : best->first;
    }

    bool is_read_from(const TexelPlace& neighbour, std::size_t k) const {
        return (map_.quarters[index(neighbour)] & reading[k]) != 0;
    }

    /// True if bilinear lookups on another chart than the given one read a texel.
    bool is_read_by_other(const TexelPlace& t, std::uint32_t chart) const {
        for (std::size_t k = 0; k < texel_neighbours.size(); ++k) {
            const TexelPlace n = t + texel_neighbours[k];
            if (is_known(n) && is_read_from(n, k) && map_.chart[index(n)] != chart) return true;
        }
        return false;
    }

    static Spectrum read(const UvLightMap::Values& values, std::size_t at) {
        Spectrum out;
        for (std::size_t b = 0; b < bands; ++b) out[b] = static_cast<double>(values[at][b]);
        return out;
    }

    /// Value of a texel from its known neighbours of one chart.
    Spectrum value(const TexelPlace& t, std::uint32_t chart, const UvLightMap::Values& values, bool linear) const {
        return value_from_neighbours(
            t, linear, [&](const TexelPlace& n) { return is_known(n) && map_.chart[index(n)] == chart; },
            [&](const TexelPlace& n) { return source(n) == Source::computed; },
            [&](const TexelPlace& n) { return read(values, index(n)); });
    }

    UvLightMap& map_;
};

}  // namespace

void fill_gutters(UvLightMap& map, int padding) {
    GutterFiller filler(map);
    std::vector<TexelPlace> ring = filler.first_ring();
    for (int k = 0; k < padding && !ring.empty(); ++k) {
        filler.fill(ring, k == 0);
        ring = filler.next_ring(ring);
    }
}

}  // namespace exitance
