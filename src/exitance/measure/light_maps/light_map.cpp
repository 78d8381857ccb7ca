#include "exitance/measure/light_maps/light_map.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "exitance/base/parallel.hpp"
#include "exitance/evaluate/open_points.hpp"
#include "exitance/measure/light_maps/mesh_texels.hpp"
#include "exitance/measure/light_maps/texel_cover.hpp"
#include "exitance/measure/pictures/tile_light.hpp"

namespace exitance {
namespace {

/// Rings of buried texels that are filled: those read by bilinear lookups on uncovered parts.
constexpr int buried_reach = 1;
constexpr double most_texels = 134217728;  ///< 2^27 texels, about 2.5 GB.

/// A part of a chart that is baked as a unit.
struct Tile {
    std::size_t chart = 0;
    Chart::Rectangle rectangle;  ///< In texels of the chart.
};

std::vector<Tile> cut_into_tiles(std::span<const Chart> charts) {
    std::vector<Tile> tiles;
    for (std::size_t c = 0; c < charts.size(); ++c)
        for (int y = 0; y < charts[c].height; y += tile_side)
            for (int x = 0; x < charts[c].width; x += tile_side)
                tiles.push_back(
                    {c, {x, y, std::min(tile_side, charts[c].width - x), std::min(tile_side, charts[c].height - y)}});
    return tiles;
}

/// Bakes tiles one after the other. One per thread.
class TileBaker {
  public:
    TileBaker(const RadiosityFunction& light, std::span<const std::vector<TexelOutline>> outlines,
              const MeshTexels& mesh, const StopRequest& stop)
        : stage_(light.stage()),
          finder_(light.places()),
          outlines_(outlines),
          mesh_(mesh),
          light_(light, texel_points, 0, 1, SpotPoints::mirrored) {
        light_.use(mesh.light());
        light_.use(stop);
    }

    void bake(const Tile& tile, const Chart& chart, LightMap& map) {
        cutter_.cut(outlines_[tile.chart], tile.rectangle, covers_, places_);
        mesh_.integrate(tile.chart, tile.rectangle, integrals_);
        points_.clear(), spots_.clear();
        for (const TexelCover& cover : covers_) {
            const std::size_t texel = map.index(chart.x + cover.x, chart.y + cover.y);
            map.share[texel] = static_cast<float>(cover.share);
            map.source[texel] = LightMap::Source::buried;
            Spot spot{chart.region, cover.x - tile.rectangle.x, cover.y - tile.rectangle.y,
                      static_cast<std::uint32_t>(texel), static_cast<std::uint32_t>(points_.size())};
            add_open_points(chart, cover);
            spot.count = static_cast<std::uint32_t>(points_.size()) - spot.first;
            if (!integrals_.empty())
                spot.meshed =
                    integrals_[static_cast<std::size_t>(spot.y * tile.rectangle.width + spot.x)].mean(cover.share);
            if (spot.count > 0) spots_.push_back(spot);
        }
        light_.evaluate(points_, spots_);
        for (const Spot& spot : spots_) {
            for (std::size_t b = 0; b < bands; ++b)
                map.irradiance[spot.pixel][b] = static_cast<float>(std::max(0.0, spot.irradiance[b]));
            map.source[spot.pixel] = LightMap::Source::computed;
        }
    }

  private:
    /// Adds the uncovered points of a texel. If the first four are all covered or all uncovered, so are the others.
    void add_open_points(const Chart& chart, const TexelCover& cover) {
        constexpr std::size_t first_points = 4;
        const Normal& n = stage_.scene.regions()[chart.region].plane.n;
        std::size_t found = 0;
        for (std::size_t k = 0; k < texel_points; ++k) {
            if (k == first_points && found == 0) return;
            const Point x = finder_.find(chart.at(places_[cover.first + k]), n).x;
            if ((k >= first_points && found == k) || is_in_open(stage_, x, n, chart.region))
                points_.push_back(x), ++found;
        }
    }

    const Stage& stage_;
    const PlaceFinder& finder_;
    std::span<const std::vector<TexelOutline>> outlines_;
    const MeshTexels& mesh_;
    TileLight light_;
    TexelCutter cutter_;
    std::vector<MeshTexels::Integral> integrals_;
    std::vector<TexelCover> covers_;
    std::vector<Vec2> places_;
    std::vector<Point> points_;
    std::vector<Spot> spots_;
};

/// Makes the triangles and parallelograms of every chart's region.
std::vector<std::vector<TexelOutline>> make_outlines(const Stage& stage, std::span<const Chart> charts) {
    std::vector<std::vector<TexelOutline>> outlines(charts.size());
    for (const Piece& piece : stage.pieces)
        outlines[piece.region.value].emplace_back(charts[piece.region.value], piece.patch);
    return outlines;
}

Result<LightMaps> make_empty_maps(const Scene& scene, const BakeOptions& options) {
    LightMaps out;
    out.density = options.density > 0 ? options.density : automatic_density(scene);
    out.padding = options.padding;
    const int longest = options.most - 2 * options.padding;
    Result<std::vector<Chart>> charts = make_charts(scene, out.density, longest);
    if (!charts) return charts.error();
    double texels = 0;
    for (const Chart& chart : *charts)
        texels += (chart.width + 2.0 * options.padding) * (chart.height + 2.0 * options.padding);
    if (texels > most_texels)
        return Error{ErrorCode::usage,
                     "the maps would have " + std::to_string(std::llround(texels / 1e6)) +
                         " million texels, the most is 134 million",
                     "--density", "choose a smaller one, or a smaller --padding"};
    out.charts = std::move(*charts);
    for (const MapSize size : pack_charts(out.charts, options.padding, options.most)) {
        LightMap map;
        map.size = size;
        map.irradiance.resize(size.texels());
        map.source.resize(size.texels(), LightMap::Source::nothing);
        map.share.resize(size.texels());
        out.maps.push_back(std::move(map));
    }
    return out;
}

}  // namespace

double automatic_density(const Scene& scene) {
    constexpr double max_texels = 1e6, usual_density = 64, texels_along_scene = 512;
    double area = 0;
    for (const Region& region : scene.regions()) area += region.area;
    double density = usual_density;
    while (2 * density * scene.size() <= texels_along_scene) density *= 2;
    while (density * density * area > max_texels) density /= 2;
    return density;
}

Result<LightMaps> bake_light_maps(const RadiosityFunction& light, const BakeOptions& options, Progress& progress,
                                  const StopRequest& stop) {
    Result<LightMaps> made = make_empty_maps(light.solution().scene, options);
    if (!made) return made;
    LightMaps& out = *made;
    progress.phase("bake");
    const std::vector<std::vector<TexelOutline>> outlines = make_outlines(light.stage(), out.charts);
    const MeshLight mesh_light(light);
    const MeshTexels mesh(mesh_light, light.stage(), out.charts);
    const std::vector<Tile> tiles = cut_into_tiles(out.charts);
    constexpr std::size_t at_once = 256, grain = 4;
    for (std::size_t first = 0; first < tiles.size() && !stop.requested(); first += at_once) {
        progress.advance(static_cast<double>(first) / static_cast<double>(tiles.size()));
        parallel_ranges(std::min(at_once, tiles.size() - first), grain, [&](std::size_t begin, std::size_t end) {
            TileBaker baker(light, outlines, mesh, stop);
            for (std::size_t i = first + begin; i < first + end && !stop.requested(); ++i) {
                const Chart& chart = out.charts[tiles[i].chart];
                baker.bake(tiles[i], chart, out.maps[chart.map]);
            }
        });
    }
    if (stop.requested()) return made;
    parallel_for(out.charts.size(), 1,
                 [&](std::size_t c) { extrapolate_texels(out.charts[c], buried_reach, out.maps[out.charts[c].map]); });
    for (const LightMap& map : out.maps)
        out.texels += static_cast<std::size_t>(
            std::count_if(map.share.begin(), map.share.end(), [](float share) { return share > 0; }));
    return made;
}

}  // namespace exitance
