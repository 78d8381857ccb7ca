#include "exitance/measure/light_maps/uv_light_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "exitance/base/limits.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/measure/light_maps/tile_baker.hpp"

namespace exitance {
namespace {

/// Linear parts of the texture coordinates as charts, with their triangles.
struct LinearCharts {
    std::vector<Chart> charts;
    std::vector<std::vector<TexelOutline>> outlines;
    std::vector<std::uint32_t> chart_of;  ///< For each of `charts`, the chart of the layout.
};

/// Makes the linear map of one triangle from positions in texels to space. Its texels are not set.
Chart linear_map(const UvTriangle& triangle, const std::array<Vec2, 3>& place, RegionId region) {
    const Vec2 p = place[1] - place[0], q = place[2] - place[0];
    const Vec3 a = triangle.corner[1] - triangle.corner[0], b = triangle.corner[2] - triangle.corner[0];
    const double area = cross(p, q);
    Chart chart;
    chart.region = region;
    chart.du = (q.y * a - p.y * b) / area, chart.dv = (p.x * b - q.x * a) / area;
    chart.skew = dot(chart.du, chart.dv);
    chart.origin = triangle.corner[0] + (0.5 - place[0].x) * chart.du + (0.5 - place[0].y) * chart.dv;
    return chart;
}

/// Joins triangles of one region on which the texture coordinates are the same linear function.
class ChartMaker {
  public:
    ChartMaker(const Scene& scene, const UvSet& set, const UvLayout& layout, std::span<const UvLightMap> maps)
        : scene_(scene), set_(set), layout_(layout), maps_(maps) {}

    LinearCharts make() {
        std::vector<std::uint32_t> order;
        for (std::uint32_t t = 0; t < set_.triangles.size(); ++t)
            if (layout_.chart[t] != UvLayout::no_chart) order.push_back(t);
        std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) {
            return std::pair(layout_.chart[a], region(a)) < std::pair(layout_.chart[b], region(b));
        });
        for (const std::uint32_t t : order) add(t);
        finish();
        return std::move(out_);
    }

  private:
    RegionId region(std::uint32_t t) const { return scene_.surfaces()[set_.triangles[t].surface].region; }

    void add(std::uint32_t t) {
        const std::uint32_t map = layout_.objects[set_.triangles[t].object].map;
        const MapSize size = maps_[map].light.size;
        std::array<Vec2, 3> place = layout_.places[t];
        for (Vec2& p : place) p = {p.x * size.width, p.y * size.height};
        std::size_t at = find(t, place);
        if (at == out_.charts.size()) {
            out_.charts.push_back(linear_map(set_.triangles[t], place, region(t)));
            out_.charts.back().map = map;
            out_.chart_of.push_back(layout_.chart[t]);
            triangles_.emplace_back();
        }
        triangles_[at].push_back(place);
    }

    /// The recent chart that maps the triangle's corners to their places; the number of charts if there is none.
    std::size_t find(std::uint32_t t, const std::array<Vec2, 3>& place) const {
        constexpr std::size_t recent = 8;
        constexpr double same = 0.01;  ///< texels
        const std::size_t count = out_.charts.size();
        for (std::size_t c = count; c-- > count - std::min(count, recent);) {
            const Chart& chart = out_.charts[c];
            if (chart.region != region(t) || out_.chart_of[c] != layout_.chart[t]) return count;
            bool fits = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2 error = chart.place(set_.triangles[t].corner[k]) - place[k];
                fits &= std::max(std::abs(error.x), std::abs(error.y)) < same;
            }
            if (fits) return c;
        }
        return count;
    }

    /// Sets the texels of all charts, clipped to their maps.
    void finish() {
        out_.outlines.resize(out_.charts.size());
        for (std::size_t c = 0; c < out_.charts.size(); ++c) {
            Chart& chart = out_.charts[c];
            const MapSize size = maps_[chart.map].light.size;
            Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};
            for (const std::array<Vec2, 3>& place : triangles_[c])
                for (const Vec2& p : place)
                    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)}, hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
            const auto texel = [](double x, int most) { return static_cast<int>(std::clamp(x, 0.0, 1.0 * most)); };
            chart.x = texel(std::floor(lo.x), size.width), chart.y = texel(std::floor(lo.y), size.height);
            chart.width = texel(std::ceil(hi.x), size.width) - chart.x;
            chart.height = texel(std::ceil(hi.y), size.height) - chart.y;
            chart.origin += static_cast<double>(chart.x) * chart.du + static_cast<double>(chart.y) * chart.dv;
            const Vec2 corner{1.0 * chart.x, 1.0 * chart.y};
            for (std::array<Vec2, 3> place : triangles_[c]) {
                for (Vec2& p : place) p = p - corner;
                out_.outlines[c].emplace_back(place);
            }
        }
    }

    const Scene& scene_;
    const UvSet& set_;
    const UvLayout& layout_;
    std::span<const UvLightMap> maps_;
    LinearCharts out_;
    std::vector<std::vector<std::array<Vec2, 3>>> triangles_;
};

/// Sums the light of a map's texels, weighted by area.
class TexelSums {
  public:
    /// `has_curved`: true if some regions are curved.
    TexelSums(UvLightMap& map, bool has_curved)
        : map_(map),
          open_(map.light.size.texels()),
          largest_(open_.size()),
          is_shared_(open_.size()),
          curved_(has_curved ? open_.size() : 0) {}

    void add(const BakedTexel& texel, const Material& material, std::uint32_t chart) {
        const std::size_t i = texel.index;
        const auto share = static_cast<float>(texel.share);
        if (map_.chart[i] != UvLayout::no_chart && map_.chart[i] != chart) is_shared_[i] = true;
        map_.light.share[i] += share;
        if (share > largest_[i]) largest_[i] = share, map_.chart[i] = chart;
        if (!texel.is_open) return;
        open_[i] += share;
        if (texel.curved.is_curved) {
            curved_[i].x += share * texel.curved.x, curved_[i].y += share * texel.curved.y;
            curved_[i].is_curved = true;
        }
        const Spectrum emitted = map_.light.has_emission ? material.exitance : Spectrum();
        const Spectrum radiosity = emitted + material.reflectance * texel.irradiance;
        if (map_.light.has_directions()) {
            DirectedIrradiance directed = texel.directed;
            directed *= texel.share, directed += directed_at(map_.light, i);
            store_directed(directed, i, map_.light);
        }
        for (std::size_t b = 0; b < bands; ++b) {
            map_.light.irradiance[i][b] += share * static_cast<float>(texel.irradiance[b]);
            map_.radiosity[i][b] += share * static_cast<float>(radiosity[b]);
        }
    }

    /// Divides the sums by the areas.
    void finish() {
        map_.shared_texels = static_cast<std::size_t>(std::count(is_shared_.begin(), is_shared_.end(), true));
        for (std::size_t i = 0; i < open_.size(); ++i) {
            LightMap& light = map_.light;
            if (light.share[i] == 0) continue;
            light.share[i] = std::min(light.share[i], 1.f);
            light.source[i] = open_[i] > 0 ? LightMap::Source::computed : LightMap::Source::buried;
            if (open_[i] == 0) continue;
            for (std::size_t b = 0; b < bands; ++b)
                light.irradiance[i][b] /= open_[i], map_.radiosity[i][b] /= open_[i];
            if (light.has_directions()) {
                DirectedIrradiance directed = directed_at(light, i);
                directed *= 1 / static_cast<double>(open_[i]);
                store_directed(directed, i, light);
            }
            if (!curved_.empty()) curved_[i].x /= open_[i], curved_[i].y /= open_[i];
        }
        if (curved_.empty()) return;
        for (std::size_t i = 0; i < open_.size(); ++i) curved_[i].is_curved &= !is_shared_[i];
        std::vector<TexelValues*> values{&map_.light.irradiance, &map_.radiosity};
        if (map_.light.has_directions())
            for (TexelValues& directed : map_.light.directed) values.push_back(&directed);
        const Chart::Rectangle whole{0, 0, map_.light.size.width, map_.light.size.height};
        fit_curved_borders(whole, curved_, map_.chart, values, map_.light);
    }

  private:
    UvLightMap& map_;
    std::vector<float> open_;          ///< Uncovered area of each texel's parts.
    std::vector<float> largest_;       ///< Area of the largest part.
    std::vector<bool> is_shared_;      ///< True if several charts have parts in a texel.
    std::vector<CurvedTexel> curved_;  ///< Texels of curved regions; empty if no region is curved.
};

/// Number of texels along a side of a square map for a density: a power of two.
int side_of(double density, double area, double map_area, int most) {
    int side = 16;
    while (side < most && !(side * std::sqrt(map_area) >= density * std::sqrt(area))) side *= 2;
    return side;
}

Result<void> make_empty_maps(const Scene& scene, const UvBakeOptions& options, UvLightMaps& out) {
    std::vector<double> area(out.layout.maps), map_area(out.layout.maps);
    for (const UvObject& object : out.layout.objects)
        area[object.map] += object.area, map_area[object.map] += object.map_area;
    constexpr int max_automatic = 4096;
    double texels = 0, covered = 0;
    for (std::size_t m = 0; m < out.layout.maps; ++m) {
        MapSize size = options.size;
        if (size.width == 0) {
            const bool is_given = options.density > 0;
            const double density = is_given ? options.density : automatic_density(scene);
            const int side = side_of(density, area[m], map_area[m], is_given ? 2 * options.most : max_automatic);
            if (side > options.most)
                return Error{ErrorCode::usage,
                             "map " + std::to_string(m) + " needs more than " + std::to_string(options.most) +
                                 " texels along a side",
                             "--density", "choose a smaller one, or --size"};
            size = {side, side};
        }
        texels += static_cast<double>(size.texels());
        if (texels > max_texels)
            return Error{ErrorCode::usage, "the maps would have more than the limit of 134 million texels", "--density",
                         "choose a smaller one, or a smaller --size"};
        covered += static_cast<double>(size.texels()) * map_area[m];
        if (covered > max_texels)
            return Error{ErrorCode::usage,
                         "charts overlap so often that " + std::to_string(std::llround(covered / 1e6)) +
                             " million texels would be baked; the limit is 134 million",
                         "--uv", "choose coordinates without overlaps, or a smaller --size"};
        UvLightMap map;
        map.light.size = size;
        map.light.irradiance.resize(size.texels()), map.radiosity.resize(size.texels());
        if (options.directions != Directions::none)
            for (auto& field : map.light.directed) field.resize(size.texels());
        map.light.source.resize(size.texels(), LightMap::Source::nothing);
        map.light.share.resize(size.texels());
        map.light.has_emission = options.component != Component::indirect;
        map.chart.resize(size.texels(), UvLayout::no_chart), map.quarters.resize(size.texels());
        map.density = std::sqrt(static_cast<double>(size.texels()) * map_area[m] / std::max(area[m], min_divisor));
        out.maps.push_back(std::move(map));
    }
    return {};
}

/// Texels per metre of the finest map.
double largest_density(const UvLightMaps& light) {
    double largest = 0;
    for (const UvLightMap& map : light.maps) largest = std::max(largest, map.density);
    return largest;
}

/// Bakes all charts and adds their light to the sums, in the order of the charts.
void bake_charts(const RadiosityFunction& light, const LinearCharts& linear, const UvBakeOptions& options,
                 UvLightMaps& out, Progress& progress, const StopRequest& stop) {
    const CurvedFaces* const faces = options.curved;
    std::optional<CurvedLight> curved;
    if (faces && !faces->empty()) curved.emplace(light, *faces, node_texels / largest_density(out), stop);
    const CurvedLight* const curved_light = curved ? &*curved : nullptr;
    const TiltedLight tilted(light, curved_light, options.component, options.directions);
    CurvedSums curved_sums(light.solution().scene, faces);
    std::vector<TexelSums> sums;
    for (UvLightMap& map : out.maps) sums.emplace_back(map, curved.has_value());
    const std::vector<ChartTile> tiles = cut_into_tiles(linear.charts);
    const auto map_of = [&](std::size_t m) -> const LightMap& { return out.maps[m].light; };
    const auto make_baker = [&] {
        return TileBaker(light, linear.outlines, nullptr, curved_light,
                         options.directions == Directions::none ? nullptr : &tilted, options.component, stop);
    };
    constexpr std::size_t at_once = 1024;
    for (std::size_t first = 0; first < tiles.size() && !stop.requested(); first += at_once) {
        progress.advance(static_cast<double>(first) / static_cast<double>(tiles.size()));
        const std::size_t count = std::min(at_once, tiles.size() - first);
        const std::vector<std::vector<BakedTexel>> baked =
            bake_tiles(std::span(tiles).subspan(first, count), linear.charts, map_of, make_baker, stop);
        if (stop.requested()) return;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t c = tiles[first + i].chart;
            const Material& material = light.solution().scene.material(linear.charts[c].region);
            const double area = norm(cross(linear.charts[c].du, linear.charts[c].dv));
            for (const BakedTexel& texel : baked[i]) {
                sums[linear.charts[c].map].add(texel, material, linear.chart_of[c]);
                curved_sums.add(linear.charts[c].region, area * texel.share, texel.irradiance);
            }
        }
    }
    for (TexelSums& sum : sums) sum.finish();
    if (options.component == Component::total) out.curved = curved_sums.compare(light.solution());
}

/// Finds the quarters of texels that a triangle of their chart touches.
void mark_quarters(const TexelOutline& outline, const Chart& chart, std::uint32_t name, UvLightMap& map) {
    constexpr double touching = 1e-9;  ///< Share of a quarter: less is rounding.
    std::vector<Vec2> polygon, rest;
    const int x1 = std::min(chart.width, static_cast<int>(std::ceil(outline.hi.x)));
    const int y1 = std::min(chart.height, static_cast<int>(std::ceil(outline.hi.y)));
    for (int y = std::max(0, static_cast<int>(std::floor(outline.lo.y))); y < y1; ++y)
        for (int x = std::max(0, static_cast<int>(std::floor(outline.lo.x))); x < x1; ++x) {
            const std::size_t i = map.light.index(chart.x + x, chart.y + y);
            if (map.chart[i] != name || map.quarters[i] == 0xf) continue;
            for (int q = 0; q < 4; ++q) {
                polygon.clear();
                for (std::size_t k = 0; k < outline.corners; ++k) polygon.push_back(2 * outline.corner[k]);
                clip_to_texel(polygon, 2 * x + q % 2, 2 * y + q / 2, rest);
                double area = 0;
                for (std::size_t k = 2; k < polygon.size(); ++k)
                    area += 0.5 * cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
                if (area > touching) map.quarters[i] = static_cast<std::uint8_t>(map.quarters[i] | 1 << q);
            }
        }
}

void mark_quarters(const LinearCharts& linear, UvLightMaps& out) {
    for (UvLightMap& map : out.maps)
        for (std::size_t i = 0; i < map.quarters.size(); ++i) map.quarters[i] = map.light.share[i] == 1 ? 0xf : 0;
    for (std::size_t c = 0; c < linear.charts.size(); ++c)
        for (const TexelOutline& outline : linear.outlines[c])
            mark_quarters(outline, linear.charts[c], linear.chart_of[c], out.maps[linear.charts[c].map]);
}

}  // namespace

Result<UvLightMaps> bake_uv_light_maps(const RadiosityFunction& light, const UvSet& set, const UvBakeOptions& options,
                                       Progress& progress, const StopRequest& stop) {
    UvLightMaps out;
    out.padding = options.padding;
    if (const Result<void> fit = check_component(light.solution(), options.component); !fit) return fit.error();
    out.layout = lay_out(set);
    const Scene& scene = light.solution().scene;
    if (const Result<void> made = make_empty_maps(scene, options, out); !made) return made.error();
    progress.phase("bake");
    const LinearCharts linear = ChartMaker(scene, set, out.layout, out.maps).make();
    bake_charts(light, linear, options, out, progress, stop);
    if (stop.requested()) return out;
    mark_quarters(linear, out);
    parallel_for(out.maps.size(), 1, [&](std::size_t m) { fill_gutters(out.maps[m], options.padding); });
    for (const UvLightMap& map : out.maps)
        out.texels += static_cast<std::size_t>(
            std::count_if(map.light.share.begin(), map.light.share.end(), [](float share) { return share > 0; }));
    return out;
}

}  // namespace exitance
