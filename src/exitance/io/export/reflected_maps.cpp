#include "exitance/io/export/reflected_maps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/core/parallel.hpp"
#include "exitance/geometry/triangulation.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/reconstruct/light_maps/texel_cover.hpp"

namespace exitance {
namespace {

using Rgb = std::array<float, 3>;

/// A picture in linear light at its own size and at halves of it, down to one pixel.
class Pyramid {
  public:
    explicit Pyramid(const TexturePixels& picture) {
        Level first{picture.width, picture.height, std::vector<Rgb>(picture.width * picture.height)};
        const ByteCurve& curve = srgb_curve();
        for (std::size_t i = 0; i < first.pixels.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                first.pixels[i][c] = static_cast<float>(curve.value[picture.rgb[3 * i + c]]);
        levels_.push_back(std::move(first));
        while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(half(levels_.back()));
    }

    std::array<double, 3> mean() const { return bilinear(levels_.back(), {0.5, 0.5}, 10497, 10497); }

    /// The colour at a place, smoothed over `size` pixels of the picture.
    std::array<double, 3> at(Vec2 place, double size, const SceneTextures::Coat& coat) const {
        const double level = std::clamp(std::log2(std::max(size, 1.0)), 0.0, static_cast<double>(levels_.size() - 1));
        return bilinear(levels_[static_cast<std::size_t>(std::lround(level))], place, coat.wrap_s, coat.wrap_t);
    }
    double width() const { return static_cast<double>(levels_.front().width); }
    double height() const { return static_cast<double>(levels_.front().height); }

  private:
    struct Level {
        std::size_t width, height;
        std::vector<Rgb> pixels;
    };

    static Level half(const Level& in) {
        Level out{(in.width + 1) / 2, (in.height + 1) / 2, {}};
        for (std::size_t y = 0; y < out.height; ++y)
            for (std::size_t x = 0; x < out.width; ++x) {
                Rgb sum{};
                for (const std::size_t v : {2 * y, std::min(2 * y + 1, in.height - 1)})
                    for (const std::size_t u : {2 * x, std::min(2 * x + 1, in.width - 1)})
                        for (std::size_t c = 0; c < 3; ++c) sum[c] += 0.25f * in.pixels[v * in.width + u][c];
                out.pixels.push_back(sum);
            }
        return out;
    }

    /// Which pixel a number beyond the borders means; `way` is glTF's number: clamp, mirror or else repeat.
    static std::size_t wrapped(double i, std::size_t count, int way) {
        constexpr int clamp = 33071, mirror = 33648;
        const auto n = static_cast<double>(count);
        if (!std::isfinite(i)) return 0;
        if (way == clamp) return static_cast<std::size_t>(std::clamp(i, 0.0, n - 1));
        double at = std::fmod(i, 2 * n);
        if (at < 0) at += 2 * n;
        if (at >= n) at = way == mirror ? 2 * n - 1 - at : at - n;
        return static_cast<std::size_t>(std::clamp(at, 0.0, n - 1));
    }

    static std::array<double, 3> bilinear(const Level& level, Vec2 place, int wrap_s, int wrap_t) {
        const double u = place.x * static_cast<double>(level.width) - 0.5, i = std::floor(u);
        const double v = place.y * static_cast<double>(level.height) - 0.5, j = std::floor(v);
        std::array<double, 3> sum{};
        for (int b = 0; b < 2; ++b)
            for (int a = 0; a < 2; ++a) {
                const double weight = (a == 0 ? i + 1 - u : u - i) * (b == 0 ? j + 1 - v : v - j);
                const Rgb& pixel = level.pixels[wrapped(j + b, level.height, wrap_t) * level.width +
                                                wrapped(i + a, level.width, wrap_s)];
                for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * static_cast<double>(pixel[c]);
            }
        return sum;
    }

    std::vector<Level> levels_;
};

/// What red, green and blue of a picture mean for each band.
Spectrum spread(const std::array<double, 3>& rgb) {
    Spectrum out;
    if (bands == 1) return Spectrum((rgb[0] + rgb[1] + rgb[2]) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = rgb[b * 3 / bands];
    return out;
}

/// Sums reflectances over the texels of one map.
class ReflectanceMap {
  public:
    ReflectanceMap(const LightMap& map) : map_(map), sum_(map.size.texels()), weight_(map.size.texels()) {}

    /// One triangle of a face: `corner` of it, and the places of these in the picture.
    void add(const Chart& chart, const std::array<Point, 3>& corner, const std::array<Vec2, 3>& place,
             const SceneTextures::Coat& coat, const Pyramid& picture, const Spectrum& reflectance) {
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
        // Sixteen points a texel: each stands for a quarter of its width.
        const Vec2 right = in_picture({1, 0}) - in_picture({0, 0}), down = in_picture({0, 1}) - in_picture({0, 0});
        const double size = 0.25 * std::max(std::hypot(right.x * picture.width(), right.y * picture.height()),
                                            std::hypot(down.x * picture.width(), down.y * picture.height()));
        const std::array<double, 3> mean = picture.mean();
        for (const TexelCover& cover : covers_) {
            std::array<double, 3> colour{};
            for (std::size_t k = 0; k < texel_points; ++k) {
                const std::array<double, 3> at = picture.at(in_picture(places_[cover.first + k]), size, coat);
                for (std::size_t c = 0; c < 3; ++c) colour[c] += at[c] / texel_points;
            }
            for (std::size_t c = 0; c < 3; ++c) colour[c] /= std::max(mean[c], 1e-6);
            Spectrum local = reflectance * spread(colour);
            constexpr double most = 0.95;
            for (double& value : local.value) value = std::min(value, most);
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
    std::vector<Pyramid> pyramids;
    for (const SceneTextures::Picture& picture : textures.pictures) pyramids.emplace_back(picture.pixels);
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
                pyramids[static_cast<std::size_t>(coat.picture)], scene.material(s).reflectance);
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
            // What is beyond a border is to go on with the texture.
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
