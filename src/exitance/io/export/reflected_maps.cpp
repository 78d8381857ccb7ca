#include "exitance/io/export/reflected_maps.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/scenes/textures/texture_area.hpp"
#include "exitance/measure/light_maps/texel_cover.hpp"

namespace exitance {
namespace {

/// Converts red, green and blue of a picture to bands.
Spectrum spread(const std::array<double, 3>& rgb) {
    Spectrum out;
    if (bands == 1) return Spectrum((rgb[0] + rgb[1] + rgb[2]) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = rgb[b * 3 / bands];
    return out;
}

/// Accumulates reflectances in the texels of one map.
class ReflectanceMap {
  public:
    ReflectanceMap(const LightMap& map) : map_(map), sum_(map.size.texels()), weight_(map.size.texels()) {}

    /// Adds one triangle of a face: its corners, and their texture coordinates in the picture.
    void add(const Chart& chart, const std::array<Point, 3>& corner, const std::array<Vec2, 3>& place,
             const SceneTextures::Coat& coat, const TextureArea& picture, const Spectrum& reflectance) {
        const Patch patch{corner[0], corner[1] - corner[0], corner[2] - corner[0], Patch::Shape::triangle};
        if (!(patch.area() > 0)) return;
        const TexelOutline outline(chart, patch);
        const int x = std::max(0, static_cast<int>(std::floor(outline.lo.x)));
        const int y = std::max(0, static_cast<int>(std::floor(outline.lo.y)));
        const int width = std::min(chart.width, static_cast<int>(std::ceil(outline.hi.x))) - x;
        const int height = std::min(chart.height, static_cast<int>(std::ceil(outline.hi.y))) - y;
        if (width <= 0 || height <= 0) return;
        cutter_.cut(std::span(&outline, 1), {x, y, width, height}, covers_, places_);
        const auto in_picture = [&](Vec2 at) {
            const Vec2 uv = patch.coordinates(chart.at(at));
            return place[0] + uv.x * (place[1] - place[0]) + uv.y * (place[2] - place[0]);
        };
        // Each texel has sixteen sample points, each averaged over a quarter of the texel's width.
        const Vec2 right = in_picture({1, 0}) - in_picture({0, 0}), down = in_picture({0, 1}) - in_picture({0, 0});
        const double size = 0.25 * std::max(std::hypot(right.x * picture.width(), right.y * picture.height()),
                                            std::hypot(down.x * picture.width(), down.y * picture.height()));
        const std::array<double, 3> mean = picture.mean();
        const auto wrap_s = TextureArea::wrap_of(coat.wrap_s), wrap_t = TextureArea::wrap_of(coat.wrap_t);
        for (const TexelCover& cover : covers_) {
            std::array<double, 3> colour{};
            for (std::size_t k = 0; k < texel_points; ++k) {
                const std::array<double, 3> at =
                    picture.smoothed(in_picture(places_[cover.first + k]), size, wrap_s, wrap_t);
                for (std::size_t c = 0; c < 3; ++c) colour[c] += at[c] / texel_points;
            }
            for (std::size_t c = 0; c < 3; ++c) colour[c] /= std::max(mean[c], 1e-6);
            Spectrum local = reflectance * spread(colour);
            constexpr double max_reflectance = 0.95;
            for (double& value : local.value) value = std::min(value, max_reflectance);
            const std::size_t i = map_.index(chart.x + cover.x, chart.y + cover.y);
            sum_[i] += cover.share * local, weight_[i] += cover.share;
        }
    }

    Spectrum at(std::size_t i, const Spectrum& otherwise) const {
        return weight_[i] > 0 ? sum_[i] / weight_[i] : otherwise;
    }

  private:
    const LightMap& map_;
    std::vector<Spectrum> sum_;
    std::vector<double> weight_;
    TexelCutter cutter_;
    std::vector<TexelCover> covers_;
    std::vector<Vec2> places_;
};

void add_textures(const Scene& scene, const LightMaps& light, const SceneTextures& textures,
                  std::vector<ReflectanceMap>& maps) {
    std::vector<TextureArea> pictures;
    for (const SceneTextures::Picture& picture : textures.pictures)
        pictures.push_back(TextureArea::of(picture.pixels, srgb_curve()));
    for (SurfaceId s : scene.surfaces().ids()) {
        const Surface& face = scene.surfaces()[s];
        const SceneTextures::Coat& coat = textures.coats[face.material];
        if (coat.picture < 0 || textures.places[coat.set].empty()) continue;
        const Chart& chart = light.charts[face.region.value];
        const std::span<const Point> outline = scene.outline(s);
        for (const auto& [i, j, k] : triangulate(outline, face.normal)) {
            const std::vector<Vec2>& places = textures.places[coat.set];
            maps[chart.map].add(
                chart, {outline[i], outline[j], outline[k]},
                {places[face.first_corner + i], places[face.first_corner + j], places[face.first_corner + k]}, coat,
                pictures[static_cast<std::size_t>(coat.picture)], scene.materials()[coat.whole].reflectance);
        }
    }
}

}  // namespace

LightMaps reflected_maps(const Scene& scene, const LightMaps& light, const SceneTextures* textures) {
    LightMaps out = light;
    std::vector<ReflectanceMap> maps(out.maps.begin(), out.maps.end());
    if (textures) add_textures(scene, light, *textures, maps);
    for (std::size_t m = 0; m < out.maps.size(); ++m) {
        LightMap& map = out.maps[m];
        for_each_texel(light, m, [&](const Chart& chart, std::size_t i) {
            const Spectrum reflected = maps[m].at(i, scene.material(chart.region).reflectance) * map.at(i);
            for (std::size_t b = 0; b < bands; ++b) map.irradiance[i][b] = static_cast<float>(reflected[b]);
            // Mark texels beyond a border for extrapolation, so that they continue the texture.
            if (textures && map.source[i] == LightMap::Source::extrapolated)
                map.source[i] = map.share[i] > 0 ? LightMap::Source::buried : LightMap::Source::nothing;
        });
    }
    if (textures)
        parallel_for(out.charts.size(), 1,
                     [&](std::size_t c) { extrapolate_texels(out.charts[c], 1, out.maps[out.charts[c].map]); });
    return out;
}

}  // namespace exitance
