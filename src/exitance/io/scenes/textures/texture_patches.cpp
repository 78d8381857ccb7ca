#include "exitance/io/scenes/textures/texture_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/base/triangulation.hpp"

namespace exitance {
namespace {

/// Tolerance of planes and texture coordinates, as a share of a face's size.
constexpr double affine_tolerance = 1e-5;  // derived from single precision, in which files store coordinates

/// Texture coordinates as an affine function of the position in a plane.
struct AffinePlaces {
    Point origin;
    Normal n;
    Vec3 along_s, along_t;  ///< Gradients, 1/m.
    Vec2 base;

    Vec2 at(const Point& p) const { return base + Vec2{dot(along_s, p - origin), dot(along_t, p - origin)}; }
    double height(const Point& p) const { return dot(n, p - origin); }
};

/// Fits the function to the largest triangle that contains the first corner. Empty if no such triangle has an area.
std::optional<AffinePlaces> fit(std::span<const Point> corners, std::span<const Vec2> places) {
    double largest = 0;
    std::array<std::size_t, 3> best{};
    for (std::size_t i = 1; i < corners.size(); ++i)
        for (std::size_t j = i + 1; j < corners.size(); ++j)
            if (const double area = norm(cross(corners[i] - corners[0], corners[j] - corners[0])); area > largest)
                largest = area, best = {0, i, j};
    if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
    const auto [o, i, j] = best;
    const Vec3 a = corners[i] - corners[o], b = corners[j] - corners[o], normal = cross(a, b);
    const double area = squared_norm(normal);
    const Vec3 first = cross(b, normal) / area, second = cross(normal, a) / area;
    const Vec2 u = places[i] - places[o], v = places[j] - places[o];
    return AffinePlaces{corners[o], normalized(normal), u.x * first + v.x * second, u.y * first + v.y * second,
                        places[o]};
}

/// Extent of points along an axis.
template <class T, class Axis>
double extent(std::span<const T> points, Axis&& axis) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const T& p : points) low = std::min(low, axis(p)), high = std::max(high, axis(p));
    return high - low;
}

double size_of(std::span<const Vec2> places) {
    return std::max(extent(places, [](const Vec2& p) { return p.x; }),
                    extent(places, [](const Vec2& p) { return p.y; }));
}

double size_of(std::span<const Point> corners) {
    return std::max({extent(corners, [](const Point& p) { return p.x; }),
                     extent(corners, [](const Point& p) { return p.y; }),
                     extent(corners, [](const Point& p) { return p.z; })});
}

/// True if the function has the height 0 and the texture coordinates of all corners, within the tolerance.
bool fits(const AffinePlaces& function, std::span<const Point> corners, std::span<const Vec2> places) {
    const double in_space = affine_tolerance * size_of(corners), in_picture = affine_tolerance * size_of(places);
    for (std::size_t k = 0; k < corners.size(); ++k)
        if (std::abs(function.height(corners[k])) > in_space ||
            length(function.at(corners[k]) - places[k]) > in_picture)
            return false;
    return true;
}

/// True if an outline has an area in the picture, relative to its squared size.
bool has_area(std::span<const Vec2> places) {
    double sum = 0;
    for (std::size_t i = 2; i < places.size(); ++i)
        sum += 0.5 * cross(places[i - 1] - places[0], places[i] - places[0]);
    const double size = size_of(places);
    return std::isfinite(sum) && std::abs(sum) > affine_tolerance * size * size;
}

class PatchFinder {
  public:
    PatchFinder(const SceneDescription& description, std::span<const VaryingFace> faces)
        : description_(description), faces_(faces) {}

    TexturePatches find() {
        for (std::uint32_t f = 0; f < faces_.size(); ++f) add_tiles(f);
        join();
        return std::move(out_);
    }

  private:
    std::vector<Point> corners_of(std::uint32_t f) const {
        std::vector<Point> out;
        for (const std::uint32_t c : description_.faces[faces_[f].face].corners) out.push_back(description_.points[c]);
        return out;
    }
    /// Texture coordinates in which a face is cut; those in its plane (metres) if it has none.
    std::vector<Vec2> frame_of(std::uint32_t f, std::span<const Point> corners) const {
        const FaceColours& colours = faces_[f].colours;
        if (colours.reflectance.picture) return colours.reflectance.places;
        if (colours.exitance.picture) return colours.exitance.places;
        if (colours.coverage.picture) return colours.coverage.places;
        const Normal s = normalized(corners[1] - corners[0]), n = normalized(area_vector(corners));
        std::vector<Vec2> out;
        for (const Point& p : corners) out.push_back({dot(s, p - corners[0]), dot(cross(n, s), p - corners[0])});
        return out;
    }

    void add_tiles(std::uint32_t f) {
        const std::vector<Point> corners = corners_of(f);
        const double area = norm(area_vector(corners));
        if (!(area > 0) || !std::isfinite(area)) return;
        const std::vector<Vec2> places = frame_of(f, corners);
        if (!has_area(places)) return;
        std::vector<std::vector<std::uint32_t>> pieces;
        if (corners.size() == 3) {
            pieces = {{0, 1, 2}};
        } else {
            const Normal n = normalized(area_vector(corners));
            const std::optional<AffinePlaces> function = fit(corners, places);
            if (function && fits(*function, corners, places) && fits_exitance(f, corners)) {
                pieces = convex_pieces(corners, n);
            } else {
                for (const auto& [i, j, k] : triangulate(corners, n)) pieces.push_back({i, j, k});
            }
        }
        add_tiles(f, corners, places, pieces, area);
    }

    bool fits_exitance(std::uint32_t f, std::span<const Point> corners) const {
        const FacePicture& exitance = faces_[f].colours.exitance;
        if (!exitance.picture) return true;
        const std::optional<AffinePlaces> function = fit(corners, exitance.places);
        return function && fits(*function, corners, exitance.places);
    }

    void add_tiles(std::uint32_t f, std::span<const Point> corners, std::span<const Vec2> places,
                   std::span<const std::vector<std::uint32_t>> pieces, double area) {
        const std::size_t before = out_.tiles.size();
        double sum = 0;
        for (const std::vector<std::uint32_t>& piece : pieces) {
            TextureTile tile;
            tile.owner = f, tile.corners = piece;
            std::vector<Point> outline;
            for (const std::uint32_t c : piece) outline.push_back(corners[c]), tile.places.push_back(places[c]);
            tile.area = norm(area_vector(outline));
            sum += tile.area;
            out_.tiles.push_back(std::move(tile));
        }
        // Pieces of an outline that intersects itself overlap, so that the sum of their areas is too large. If the
        // outline is not planar, the sum is only a little larger, which is acceptable.
        constexpr double bent = 0.02;  // relative difference; derived from triangles that meet at up to ten degrees
        if (std::abs(sum - area) > bent * area) out_.tiles.resize(before);
    }

    std::vector<Point> outline_of(const TextureTile& tile) const {
        std::vector<Point> out;
        const auto& corners = description_.faces[faces_[tile.owner].face].corners;
        for (const std::uint32_t c : tile.corners) out.push_back(description_.points[corners[c]]);
        return out;
    }
    static std::vector<Vec2> places_of(const FacePicture& picture, const TextureTile& tile) {
        std::vector<Vec2> out;
        for (const std::uint32_t c : tile.corners) out.push_back(picture.places[c]);
        return out;
    }

    /// True if two tiles show one picture continuously.
    bool continues(const TextureTile& a, const TextureTile& b) const {
        const VaryingFace &fa = faces_[a.owner], &fb = faces_[b.owner];
        const SceneDescription::Face &da = description_.faces[fa.face], &db = description_.faces[fb.face];
        if (da.material != db.material || da.group != db.group) return false;
        if (!fa.colours.corner_factors.empty() || !fb.colours.corner_factors.empty()) return false;
        const auto alike = [](const FacePicture& p, const FacePicture& q) {
            return p.picture == q.picture && p.wrap_s == q.wrap_s && p.wrap_t == q.wrap_t;
        };
        if (!alike(fa.colours.reflectance, fb.colours.reflectance) ||
            !alike(fa.colours.exitance, fb.colours.exitance) || !alike(fa.colours.coverage, fb.colours.coverage))
            return false;
        const std::vector<Point> here = outline_of(a), there = outline_of(b);
        const std::optional<AffinePlaces> function = fit(here, a.places);
        if (!function || !fits(*function, there, b.places)) return false;
        if (!(dot(area_vector(here), area_vector(there)) > 0)) return false;
        if (!fa.colours.exitance.picture) return true;
        const std::optional<AffinePlaces> exitance = fit(here, places_of(fa.colours.exitance, a));
        return exitance && fits(*exitance, there, places_of(fb.colours.exitance, b));
    }

    /// An edge of a tile between two positions, in ascending order.
    struct Edge {
        std::array<double, 6> ends;
        std::uint32_t tile;
        bool operator<(const Edge& o) const { return ends != o.ends ? ends < o.ends : tile < o.tile; }
    };

    /// Joins tiles with a common edge to patches.
    void join() {
        std::vector<Edge> edges;
        for (std::uint32_t t = 0; t < out_.tiles.size(); ++t) {
            const std::vector<Point> outline = outline_of(out_.tiles[t]);
            for (std::size_t k = 0; k < outline.size(); ++k) {
                const Point &p = outline[k], &q = outline[(k + 1) % outline.size()];
                std::array<double, 3> a = {p.x, p.y, p.z}, b = {q.x, q.y, q.z};
                if (b < a) std::swap(a, b);
                edges.push_back({{a[0], a[1], a[2], b[0], b[1], b[2]}, t});
            }
        }
        std::sort(edges.begin(), edges.end());
        DisjointSets sets(out_.tiles.size());
        // A tile is compared with at most the next seven at the same edge.
        constexpr std::size_t max_faces = 8;
        for (std::size_t first = 0; first < edges.size(); ++first)
            for (std::size_t k = first + 1; k < std::min(edges.size(), first + max_faces); ++k) {
                if (edges[k].ends != edges[first].ends) break;
                if (continues(out_.tiles[edges[first].tile], out_.tiles[edges[k].tile]))
                    sets.unite(edges[first].tile, edges[k].tile);
            }
        std::vector<std::uint32_t> patch_of(out_.tiles.size());
        for (std::uint32_t t = 0; t < out_.tiles.size(); ++t) {
            const std::uint32_t root = sets.root(t);
            if (root == t)
                patch_of[t] = static_cast<std::uint32_t>(out_.patches.size()), out_.patches.push_back({{}, t});
            TexturePatch& patch = out_.patches[patch_of[root]];
            patch.tiles.push_back(t);
            if (out_.tiles[t].area > out_.tiles[patch.largest].area) patch.largest = t;
        }
    }

    const SceneDescription& description_;
    std::span<const VaryingFace> faces_;
    TexturePatches out_;
};

/// An affine function of texture coordinates, from its values at three of a tile's corners.
template <class T>
class AffineOfPlaces {
  public:
    AffineOfPlaces(std::span<const Vec2> places, std::span<const T> values) : origin_(places[0]), base_(values[0]) {
        double largest = 0;
        for (std::size_t i = 1; i < places.size(); ++i)
            for (std::size_t j = i + 1; j < places.size(); ++j) {
                const Vec2 a = places[i] - origin_, b = places[j] - origin_;
                const double area = cross(a, b);
                if (std::abs(area) <= largest) continue;
                largest = std::abs(area);
                along_s_ = (b.y / area) * (values[i] - base_) - (a.y / area) * (values[j] - base_);
                along_t_ = (a.x / area) * (values[j] - base_) - (b.x / area) * (values[i] - base_);
            }
    }
    T at(const Vec2& p) const { return base_ + (p.x - origin_.x) * along_s_ + (p.y - origin_.y) * along_t_; }

  private:
    Vec2 origin_;
    T base_, along_s_{}, along_t_{};
};

/// Divides every interval equally, so that there are at least `min_cells` cells.
std::vector<double> divided(const std::vector<double>& borders, std::size_t min_cells) {
    const std::size_t cells = borders.size() - 1, by = (min_cells + cells - 1) / cells;
    std::vector<double> out;
    for (std::size_t i = 0; i < cells; ++i)
        for (std::size_t k = 0; k < by; ++k)
            out.push_back(borders[i] +
                          static_cast<double>(k) / static_cast<double>(by) * (borders[i + 1] - borders[i]));
    out.push_back(borders.back());
    return out;
}

/// Samples the colours of one patch.
class PatchSampler {
  public:
    PatchSampler(const VaryingFace& face, const TextureTile& tile, const Material& material)
        : colours_(face.colours), tile_(tile), material_(material) {}

    /// Borders of cells between two texture coordinates.
    std::vector<double> borders(bool along_s, double low, double high, std::size_t max_cells) const {
        constexpr std::size_t min_cells = 32;  // derived from the samples of a face's mean
        std::vector<double> out = {low, high};
        for (const FacePicture* shown : {&colours_.reflectance, &colours_.exitance, &colours_.coverage}) {
            if (!shown->picture || !is_in_frame(*shown)) continue;
            std::vector<double> found = shown->picture->borders(along_s, low, high, max_cells);
            if (found.size() > out.size()) out = std::move(found);
        }
        const bool is_smooth =
            !colours_.corner_factors.empty() || (colours_.exitance.picture && !is_in_frame(colours_.exitance));
        return is_smooth ? divided(out, min_cells) : out;
    }

    std::vector<ColourGrid::Cell> cells(std::span<const double> columns, std::span<const double> rows,
                                        std::span<const double> areas, double whitest) const {
        std::vector<ColourGrid::Cell> out(areas.size());
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = {areas[k], material_.reflectance, material_.exitance};
        multiply(colours_.reflectance, columns, rows, out, &ColourGrid::Cell::reflectance);
        multiply(colours_.exitance, columns, rows, out, &ColourGrid::Cell::exitance);
        if (colours_.coverage.picture) {
            // Holes are in the texture coordinates of the base colour.
            const std::vector<TextureArea::Colour> means = colours_.coverage.picture->cell_means(
                columns, rows, colours_.coverage.wrap_s, colours_.coverage.wrap_t);
            for (std::size_t k = 0; k < out.size(); ++k) out[k].coverage = means[k][0];
        }
        if (!colours_.corner_factors.empty()) multiply_factors(columns, rows, out);
        for (ColourGrid::Cell& cell : out)
            for (double& v : cell.reflectance.value) v = std::min(v, whitest);
        return out;
    }

  private:
    /// True if the patch is cut in the texture coordinates of a picture.
    bool is_in_frame(const FacePicture& picture) const {
        for (std::size_t k = 0; k < tile_.corners.size(); ++k)
            if (!(picture.places[tile_.corners[k]] == tile_.places[k])) return false;
        return true;
    }

    void multiply(const FacePicture& face, std::span<const double> columns, std::span<const double> rows,
                  std::vector<ColourGrid::Cell>& out, Spectrum ColourGrid::Cell::*value) const {
        if (!face.picture) return;
        if (is_in_frame(face)) {
            const std::vector<TextureArea::Colour> means =
                face.picture->cell_means(columns, rows, face.wrap_s, face.wrap_t);
            for (std::size_t k = 0; k < out.size(); ++k) out[k].*value *= factor_of(means[k], *face.picture);
            return;
        }
        std::vector<Vec2> places;
        for (const std::uint32_t c : tile_.corners) places.push_back(face.places[c]);
        const AffineOfPlaces<Vec2> place(tile_.places, std::span<const Vec2>(places));
        const std::size_t nx = columns.size() - 1;
        for (std::size_t k = 0; k < out.size(); ++k) {
            const std::size_t i = k % nx, j = k / nx;
            const Vec2 low = place.at({columns[i], rows[j]}), high = place.at({columns[i + 1], rows[j + 1]});
            const double size = std::max(std::abs(high.x - low.x) * face.picture->width(),
                                         std::abs(high.y - low.y) * face.picture->height());
            out[k].*value *=
                factor_of(face.picture->smoothed(0.5 * (low + high), size, face.wrap_s, face.wrap_t), *face.picture);
        }
    }

    void multiply_factors(std::span<const double> columns, std::span<const double> rows,
                          std::vector<ColourGrid::Cell>& out) const {
        std::vector<Spectrum> factors;
        for (const std::uint32_t c : tile_.corners) factors.push_back(colours_.corner_factors[c]);
        const AffineOfPlaces<Spectrum> factor(tile_.places, std::span<const Spectrum>(factors));
        const std::size_t nx = columns.size() - 1;
        for (std::size_t k = 0; k < out.size(); ++k) {
            const std::size_t i = k % nx, j = k / nx;
            Spectrum here = factor.at({0.5 * (columns[i] + columns[i + 1]), 0.5 * (rows[j] + rows[j + 1])});
            // The middle of a cell on the border may be outside of the triangle.
            for (double& v : here.value) v = std::clamp(v, 0.0, 1.0);
            out[k].reflectance *= here;
        }
    }

    const FaceColours& colours_;
    const TextureTile& tile_;
    const Material& material_;
};

}  // namespace

TexturePatches find_texture_patches(const SceneDescription& description, std::span<const VaryingFace> faces) {
    return PatchFinder(description, faces).find();
}

ColourGrid sample_patch(const SceneDescription& description, std::span<const VaryingFace> faces,
                        const TexturePatches& all, const TexturePatch& patch, std::size_t max_cells, double whitest) {
    const TextureTile& largest = all.tiles[patch.largest];
    const VaryingFace& face = faces[largest.owner];
    const Material& material = description.materials[description.faces[face.face].material];
    Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
    std::vector<std::vector<Vec2>> polygons;
    double area = 0, covered = 0;
    for (const std::uint32_t t : patch.tiles) {
        polygons.push_back(all.tiles[t].places);
        area += all.tiles[t].area;
        for (const Vec2& p : all.tiles[t].places)
            low = {std::min(low.x, p.x), std::min(low.y, p.y)}, high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const PatchSampler sampler(face, largest, material);
    std::vector<double> columns = sampler.borders(true, low.x, high.x, max_cells);
    std::vector<double> rows = sampler.borders(false, low.y, high.y, max_cells);
    std::vector<double> areas = covered_areas(polygons, columns, rows);
    for (const double a : areas) covered += a;
    // A patch that has no area in the picture is not cut.
    constexpr double rounding = 1e-9;  // derived from the rounding of sums of differences
    const bool has_area = covered > rounding * (high.x - low.x) * (high.y - low.y);
    for (double& a : areas) a *= has_area ? area / covered : 0;
    const std::vector<ColourGrid::Cell> cells = sampler.cells(columns, rows, areas, whitest);
    return {std::move(columns), std::move(rows), cells, material.emits()};
}

}  // namespace exitance
