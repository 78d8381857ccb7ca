#include "exitance/measure/light_maps/light_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "exitance/base/parallel.hpp"
#include "exitance/measure/light_maps/tile_baker.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Rings of buried texels that are filled: those read by bilinear lookups on uncovered parts.
constexpr int buried_reach = 1;

/// Makes the triangles and parallelograms of every chart's region.
std::vector<std::vector<TexelOutline>> make_outlines(const Stage& stage, std::span<const Chart> charts) {
    std::vector<std::vector<TexelOutline>> outlines(charts.size());
    for (const Piece& piece : stage.pieces)
        outlines[piece.region.value].emplace_back(charts[piece.region.value], piece.patch);
    return outlines;
}

void store(const BakedTexel& texel, LightMap& map) {
    map.share[texel.index] = static_cast<float>(texel.share);
    map.source[texel.index] = texel.is_open ? LightMap::Source::computed : LightMap::Source::buried;
    for (std::size_t b = 0; b < bands; ++b) map.irradiance[texel.index][b] = static_cast<float>(texel.irradiance[b]);
    if (map.has_directions()) store_directed(texel.directed, texel.index, map);
}

/// Compares the light of curved regions with the solution.
CurvedDifferences compare_curved(const Solution& solution, const CurvedFaces* faces, const LightMaps& light) {
    CurvedSums sums(solution.scene, faces);
    for (const Chart& chart : light.charts) {
        if (!faces || !faces->is_curved(chart.region)) continue;
        const LightMap& map = light.maps[chart.map];
        const double area = norm(cross(chart.du, chart.dv));
        for (int y = chart.y; y < chart.y + chart.height; ++y)
            for (int x = chart.x; x < chart.x + chart.width; ++x) {
                const std::size_t i = map.index(x, y);
                const Spectrum E = map.source[i] == LightMap::Source::computed ? map.at(i) : Spectrum();
                sums.add(chart.region, area * static_cast<double>(map.share[i]), E);
            }
    }
    return sums.compare(solution);
}

/// Evaluates light at the centres of texels at the borders of curved charts.
void fit_curved(const std::vector<std::vector<CurvedTexel>>& curved, const Chart& chart, LightMaps& out) {
    LightMap& map = out.maps[chart.map];
    std::vector<TexelValues*> values{&map.irradiance};
    if (map.has_directions())
        for (TexelValues& directed : map.directed) values.push_back(&directed);
    fit_curved_borders(chart.room, curved[chart.map], {}, values, map);
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
    if (texels > max_texels)
        return Error{ErrorCode::usage,
                     "the maps would have " + std::to_string(std::llround(texels / 1e6)) +
                         " million texels; the limit is 134 million",
                     "--density", "choose a smaller one, or a smaller --padding"};
    out.charts = std::move(*charts);
    for (const MapSize size : pack_charts(out.charts, options.padding, options.most)) {
        LightMap map;
        map.size = size;
        map.irradiance.resize(size.texels());
        if (options.directions != Directions::none)
            for (auto& values : map.directed) values.resize(size.texels());
        map.source.resize(size.texels(), LightMap::Source::nothing);
        map.share.resize(size.texels());
        map.has_emission = options.component != Component::indirect;
        out.maps.push_back(std::move(map));
    }
    return out;
}

}  // namespace

bool is_divisible(const Solution& solution) {
    return !solution.direct_in_elements;
}

Result<void> check_component(const Solution& solution, Component component) {
    if (component == Component::total || is_divisible(solution)) return {};
    return Error{ErrorCode::usage, "the solution holds direct and indirect light as one", "--component",
                 "solve without --output-light elements and without published forms, or leave --component out"};
}

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
    if (const Result<void> fit = check_component(light.solution(), options.component); !fit) return fit.error();
    Result<LightMaps> made = make_empty_maps(light.solution().scene, options);
    if (!made) return made;
    LightMaps& out = *made;
    progress.phase("bake");
    const std::vector<std::vector<TexelOutline>> outlines = make_outlines(light.stage(), out.charts);
    const MeshLight mesh_light(light);
    const MeshTexels mesh(mesh_light, light.stage(), out.charts);
    std::optional<CurvedLight> curved;
    if (options.curved && !options.curved->empty())
        curved.emplace(light, *options.curved, node_texels / out.density, stop);
    const CurvedLight* const curved_light = curved ? &*curved : nullptr;
    const TiltedLight tilted(light, curved_light, options.component, options.directions);
    std::vector<std::vector<CurvedTexel>> curved_texels(out.maps.size());
    for (std::size_t m = 0; curved && m < out.maps.size(); ++m) curved_texels[m].resize(out.maps[m].size.texels());
    const std::vector<ChartTile> tiles = cut_into_tiles(out.charts);
    const auto map_of = [&](std::size_t m) -> const LightMap& { return out.maps[m]; };
    const auto make_baker = [&] {
        return TileBaker(light, outlines, &mesh, curved_light,
                         options.directions == Directions::none ? nullptr : &tilted, options.component, stop);
    };
    const std::size_t at_once = 256 * processes();
    for (std::size_t first = 0; first < tiles.size() && !stop.requested(); first += at_once) {
        progress.advance(static_cast<double>(first) / static_cast<double>(tiles.size()));
        const auto some = std::span(tiles).subspan(first, std::min(at_once, tiles.size() - first));
        const std::vector<std::vector<BakedTexel>> baked = bake_tiles(some, out.charts, map_of, make_baker, stop);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const std::size_t map = out.charts[some[i].chart].map;
            for (const BakedTexel& texel : baked[i]) {
                store(texel, out.maps[map]);
                if (texel.curved.is_curved) curved_texels[map][texel.index] = texel.curved;
            }
        }
    }
    if (stop.requested()) return made;
    if (options.component == Component::total) out.curved = compare_curved(light.solution(), options.curved, out);
    parallel_for(out.charts.size(), 1, [&](std::size_t c) {
        if (curved && curved->is_curved(out.charts[c].region)) fit_curved(curved_texels, out.charts[c], out);
        extrapolate_texels(out.charts[c], buried_reach, out.maps[out.charts[c].map]);
    });
    for (const LightMap& map : out.maps)
        out.texels += static_cast<std::size_t>(
            std::count_if(map.share.begin(), map.share.end(), [](float share) { return share > 0; }));
    return made;
}

}  // namespace exitance
