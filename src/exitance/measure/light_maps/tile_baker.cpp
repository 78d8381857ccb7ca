#include "exitance/measure/light_maps/tile_baker.hpp"

#include <algorithm>

#include "exitance/processes/exchange_archived.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {

std::vector<ChartTile> cut_into_tiles(std::span<const Chart> charts) {
    std::vector<ChartTile> tiles;
    for (std::size_t c = 0; c < charts.size(); ++c)
        for (int y = 0; y < charts[c].height; y += tile_side)
            for (int x = 0; x < charts[c].width; x += tile_side)
                tiles.push_back(
                    {c, {x, y, std::min(tile_side, charts[c].width - x), std::min(tile_side, charts[c].height - y)}});
    return tiles;
}

TileBaker::TileBaker(const RadiosityFunction& light, std::span<const std::vector<TexelOutline>> outlines,
                     const MeshTexels* mesh, const CurvedLight* curved, const TiltedLight* tilted, Component component,
                     const StopRequest& stop)
    : stage_(light.stage()),
      finder_(light.places()),
      outlines_(outlines),
      mesh_(mesh),
      curved_(curved),
      tilted_(tilted),
      component_(component),
      exact_share_(light.exact_share()),
      stop_(stop),
      light_(light, texel_points, 0, 1, SpotPoints::mirrored) {
    if (mesh) light_.use(mesh->light());
    light_.use(stop);
    if (component != Component::total) light_.add_all_direct();
}

std::span<const BakedTexel> TileBaker::bake(const ChartTile& tile, const Chart& chart, const LightMap& map) {
    cutter_.cut(outlines_[tile.chart], tile.rectangle, covers_, places_);
    integrals_.clear();
    if (mesh_) mesh_->integrate(tile.chart, tile.rectangle, integrals_);
    points_.clear(), spots_.clear(), texels_.clear(), places_of_texels_.clear(), last_place_.clear();
    if (tilted_) tilted_->start(chart, tile.rectangle.x, tile.rectangle.y, tilted_work_);
    std::array<std::uint32_t, static_cast<std::size_t>(tile_side * tile_side)> texel_of;
    const bool is_curved = curved_ && curved_->is_curved(chart.region);
    for (const TexelCover& cover : covers_) {
        Spot spot{chart.region, cover.x - tile.rectangle.x, cover.y - tile.rectangle.y,
                  static_cast<std::uint32_t>(map.index(chart.x + cover.x, chart.y + cover.y)),
                  static_cast<std::uint32_t>(points_.size())};
        texel_of[static_cast<std::size_t>(spot.y * tile_side + spot.x)] = static_cast<std::uint32_t>(texels_.size());
        texels_.push_back({spot.pixel, cover.share, false, {}, {}, {}});
        find_open_points(chart, cover);
        if (tilted_) places_of_texels_.insert(places_of_texels_.end(), open_.begin(), open_.end());
        last_place_.push_back(places_of_texels_.size());
        if (is_curved) {
            bake_curved(chart, cover, texels_.back());
            continue;
        }
        for (const MeasuredPlace& place : open_) points_.push_back(place.x);
        spot.count = static_cast<std::uint32_t>(points_.size()) - spot.first;
        if (!integrals_.empty())
            spot.meshed =
                integrals_[static_cast<std::size_t>(spot.y * tile.rectangle.width + spot.x)].mean(cover.share);
        if (spot.count > 0) spots_.push_back(spot);
    }
    light_.evaluate(points_, spots_);
    for (const Spot& spot : spots_) {
        BakedTexel& texel = texels_[texel_of[static_cast<std::size_t>(spot.y * tile_side + spot.x)]];
        texel.is_open = true;
        const Spectrum light = component_of(spot);
        for (std::size_t b = 0; b < bands; ++b) texel.irradiance[b] = std::max(0.0, light[b]);
    }
    if (tilted_) find_directions(chart);
    return texels_;
}

/// Sets the directed light of all texels that have light.
void TileBaker::find_directions(const Chart& chart) {
    std::size_t first = 0;
    for (std::size_t t = 0; t < texels_.size(); ++t) {
        const auto open = std::span(places_of_texels_).subspan(first, last_place_[t] - first);
        first = last_place_[t];
        if (!texels_[t].is_open || open.empty() || stop_.requested()) continue;
        for (MeasuredPlace& place : open) place.region = chart.region;
        texels_[t].directed = tilted_->at(covers_[t].x, covers_[t].y, open, texels_[t].irradiance, tilted_work_);
    }
}

/// Returns the component of a spot's light. The sum of direct and indirect light is that of all light, since all of
/// them are computed at the same points.
Spectrum TileBaker::component_of(const Spot& spot) const {
    if (component_ == Component::total) return spot.irradiance;
    const Spectrum direct = spot.irradiance - spot.elements;
    return component_ == Component::direct ? direct : spot.elements - (Spectrum(1) - exact_share_) * direct;
}

/// Finds the uncovered points of a texel. If the first four are all covered or all uncovered, so are the others.
void TileBaker::find_open_points(const Chart& chart, const TexelCover& cover) {
    constexpr std::size_t first_points = 4;
    const Normal& n = stage_.scene.regions()[chart.region].plane.n;
    open_.clear();
    for (std::size_t k = 0; k < texel_points; ++k) {
        if (k == first_points && open_.empty()) return;
        const MeasuredPlace place = finder_.find(chart.at(places_[cover.first + k]), n);
        if ((k >= first_points && open_.size() == k) || is_in_open(stage_, place.x, n, chart.region))
            open_.push_back(place);
    }
}

/// Sets the light of a texel on a curved region.
void TileBaker::bake_curved(const Chart& chart, const TexelCover& cover, BakedTexel& texel) {
    if (open_.empty() || stop_.requested()) return;
    for (MeasuredPlace& place : open_) place.region = chart.region;
    texel.is_open = true;
    const bool is_whole = cover.share == 1 && open_.size() == texel_points;
    const auto [irradiance, count] = curved_->mean_at(open_, is_whole, component_, curved_work_);
    for (std::size_t b = 0; b < bands; ++b) texel.irradiance[b] = std::max(0.0, irradiance[b]);
    Vec2 middle;
    for (std::size_t k = 0; k < count; ++k)
        middle = middle + (1.0 / static_cast<double>(count)) * chart.place(open_[k].x);
    texel.curved = {static_cast<float>(middle.x - cover.x - 0.5), static_cast<float>(middle.y - cover.y - 0.5), true};
}

std::vector<std::vector<BakedTexel>> bake_tiles(std::span<const ChartTile> tiles, std::span<const Chart> charts,
                                                const std::function<const LightMap&(std::size_t)>& map_of,
                                                const std::function<TileBaker()>& make_baker, const StopRequest& stop) {
    constexpr std::size_t grain = 4;
    std::vector<std::vector<BakedTexel>> out(tiles.size());
    parallel_own_ranges(tiles.size(), grain,
                        [&](std::size_t begin, std::size_t end) {
                            TileBaker baker = make_baker();
                            for (std::size_t i = begin; i < end && !stop.requested(); ++i) {
                                const Chart& chart = charts[tiles[i].chart];
                                const std::span<const BakedTexel> texels =
                                    baker.bake(tiles[i], chart, map_of(chart.map));
                                out[i].assign(texels.begin(), texels.end());
                            }
                        },
                        {"tiles"});
    exchange_archived(
        std::span(out), grain, [](auto& archive, std::vector<BakedTexel>& texels) { archive(texels); }, "tiles");
    return out;
}

}  // namespace exitance
