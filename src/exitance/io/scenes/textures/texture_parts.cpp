#include "exitance/io/scenes/textures/texture_parts.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/io/scenes/textures/texture_cuts.hpp"

namespace exitance {
namespace {

/// Squared relative error of the scene's light below which a face is not cut.
constexpr double min_benefit =  // derived from a gradient on a wall: a part then varies by 2% of its mean reflectance
    1e-6;
/// Limit on the parts of emitting faces: direct light is computed for each emitter.
constexpr std::size_t max_emitting_parts = 128;  // derived from rooms with 128 luminaires, which solve in seconds

/// Areas and light of a scene, for the benefit of cuts.
CutScale scale_of(const SceneDescription& d) {
    double area = 0, reflected = 0, flux = 0;
    std::vector<Point> corners;
    for (const SceneDescription::Face& face : d.faces) {
        corners.clear();
        for (const std::uint32_t c : face.corners) corners.push_back(d.points[c]);
        const double own = norm(area_vector(corners));
        if (!std::isfinite(own)) continue;
        const Material& material = d.materials[face.material];
        area += own, reflected += own * mean(material.reflectance), flux += own * mean(material.exitance);
    }
    constexpr double walls = 6;  // derived from a cube, whose width is the root of a sixth of its area
    return {std::max(min_divisor, std::sqrt(area / walls)), std::max(min_divisor, area),
            std::max(min_divisor, reflected * reflected / std::max(min_divisor, area)), std::max(min_divisor, flux),
            min_benefit};
}

/// A corner of a polygon that is cut: its texture coordinates and position.
struct CutCorner {
    Vec2 place;
    Point point;
    std::uint32_t index = new_point;  ///< Index of a point of the description.

    static constexpr std::uint32_t new_point = 0xffffffff;
};

/// Cuts a convex polygon along an axis into the parts below and above a coordinate. Corners within `tolerance` of the
/// cut belong to both, so that there are no slivers.
void cut_polygon(std::span<const CutCorner> polygon, bool along_s, double at, double tolerance,
                 std::vector<CutCorner>& below, std::vector<CutCorner>& above) {
    const auto height = [&](const CutCorner& c) {
        const double h = (along_s ? c.place.x : c.place.y) - at;
        return std::abs(h) <= tolerance ? 0 : h;
    };
    std::size_t low = 0, high = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const CutCorner &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        const double ha = height(a), hb = height(b);
        low += ha<0, high += ha> 0;
        if (ha <= 0) below.push_back(a);
        if (ha >= 0) above.push_back(a);
        if (!(ha * hb < 0)) continue;
        // Computed from the same end for both neighbours, so that they share the point.
        const bool turns = b.point.x != a.point.x   ? b.point.x < a.point.x
                           : b.point.y != a.point.y ? b.point.y < a.point.y
                                                    : b.point.z < a.point.z;
        const CutCorner &p = turns ? b : a, &q = turns ? a : b;
        const double hp = turns ? hb : ha, hq = turns ? ha : hb, t = hp / (hp - hq);
        CutCorner cut{p.place + t * (q.place - p.place), p.point + t * (q.point - p.point)};
        (along_s ? cut.place.x : cut.place.y) = at;
        below.push_back(cut), above.push_back(cut);
    }
    if (low == 0) below.clear();
    if (high == 0 && low > 0) above.clear();
}

/// A patch with the cuts that would be made if there were no limit.
struct PatchCuts {
    const TexturePatch* patch = nullptr;
    TextureCuts cuts;
    bool emits = false;
    std::size_t taken = 0;  ///< Number of cuts to make.
    Vec2 tolerance;         ///< Tolerance of cuts, in texture coordinates.
};

class FaceCutter {
  public:
    FaceCutter(SceneDescription& description, std::span<const VaryingFace> faces, double whitest)
        : description_(description),
          faces_(faces),
          whitest_(whitest),
          scale_(scale_of(description)),
          all_(find_texture_patches(description, faces)) {}

    CutFaces cut(std::size_t max_parts) {
        for (const std::size_t p : promising_patches(max_parts / 2)) consider(all_.patches[p], max_parts);
        choose(max_parts);
        CutFaces out{std::vector<std::vector<FacePart>>(faces_.size()), std::vector<std::uint8_t>(faces_.size())};
        std::vector<std::uint8_t> is_done(all_.tiles.size());
        for (const PatchCuts& patch : patches_)
            for (const std::uint32_t t : patch.patch->tiles)
                if (patch.taken > 0) out.is_cut[all_.tiles[t].owner] = 1, is_done[t] = 1;
        for (std::uint32_t t = 0; t < all_.tiles.size(); ++t)
            if (out.is_cut[all_.tiles[t].owner] && !is_done[t]) add_whole(all_.tiles[t], out);
        for (const PatchCuts& patch : patches_)
            if (patch.taken > 0) add_parts(patch, out);
        return out;
    }

  private:
    /// Returns the patches whose potential is at least `min_benefit`, ascending; at most `max_patches`, those of
    /// largest potential.
    std::vector<std::size_t> promising_patches(std::size_t max_patches) const {
        std::vector<std::pair<double, std::size_t>> found;  // potential with negative sign, and index of the patch
        for (std::size_t p = 0; p < all_.patches.size(); ++p)
            if (const double use = potential_of(all_.patches[p]); use >= min_benefit) found.emplace_back(-use, p);
        std::sort(found.begin(), found.end());
        found.resize(std::min(found.size(), max_patches));
        std::vector<std::size_t> out;
        for (const auto& [use, p] : found) out.push_back(p);
        std::sort(out.begin(), out.end());
        return out;
    }

    /// Finds the cuts of a patch.
    void consider(const TexturePatch& patch, std::size_t max_cuts) {
        const double potential = potential_of(patch);
        // More cells where more parts are possible.
        constexpr double cells_per_part = 16, min_cells = 32, max_cells = 256;  // derived from cells of 1/16 of a part
        const double side = std::clamp(cells_per_part * std::sqrt(potential / min_benefit), min_cells, max_cells);
        const ColourGrid grid =
            sample_patch(description_, faces_, all_, patch, static_cast<std::size_t>(side), whitest_);
        const TextureTile& tile = all_.tiles[patch.largest];
        const Vec2 metres = metres_of(tile);
        PatchCuts found;
        found.patch = &patch, found.emits = grid.emits();
        found.cuts = cut_texture(grid, scale_, max_cuts, metres.x, metres.y);
        // derived from the narrowest faces that rays in single precision hit reliably
        constexpr double tolerance = 1e-4;
        found.tolerance = {tolerance * (grid.columns().back() - grid.columns().front()),
                           tolerance * (grid.rows().back() - grid.rows().front())};
        if (!found.cuts.cuts.empty()) patches_.push_back(std::move(found));
    }

    /// Benefit of a single cut that would remove all variation of a patch, estimated from 32 x 32 samples.
    double potential_of(const TexturePatch& patch) const {
        double area = 0, squares = 0, emitted = 0, holes = 0;
        Spectrum sum, flux;
        for (const std::uint32_t t : patch.tiles) {
            const TextureTile& tile = all_.tiles[t];
            const ColourRange &r = faces_[tile.owner].colour.reflectance, &m = faces_[tile.owner].colour.exitance;
            area += tile.area, sum += tile.area * r.mean, flux += tile.area * m.mean;
            holes += tile.area * faces_[tile.owner].colour.coverage;
            squares += tile.area * mean(r.mean * r.mean + r.deviation * r.deviation);
            emitted += tile.area * mean(m.mean * m.mean + m.deviation * m.deviation);
        }
        const double near = std::min(1.0, std::sqrt(area) / scale_.length);
        const double variance = std::max(0.0, squares - mean(sum * sum) / area);
        const double moved = std::sqrt(std::max(0.0, emitted * area - mean(flux * flux))) * near / scale_.flux;
        const double shape = holes * (1 - holes / area);  // largest possible variance of coverage, times the area
        return (variance / scale_.reflected + std::max(0.0, shape) / scale_.area) * near + moved * moved;
    }

    /// Lengths of a unit of both texture coordinates on a tile, m.
    Vec2 metres_of(const TextureTile& tile) const {
        const auto& corners = description_.faces[faces_[tile.owner].face].corners;
        const auto point = [&](std::size_t k) { return description_.points[corners[tile.corners[k]]]; };
        double largest = 0;
        Vec2 out{1, 1};
        for (std::size_t k = 2; k < tile.corners.size(); ++k) {
            const Vec2 u = tile.places[k - 1] - tile.places[0], v = tile.places[k] - tile.places[0];
            const double area = cross(u, v);
            if (std::abs(area) <= largest) continue;
            largest = std::abs(area);
            const Vec3 a = point(k - 1) - point(0), b = point(k) - point(0);
            out = {norm((v.y / area) * a - (u.y / area) * b), norm((u.x / area) * b - (v.x / area) * a)};
        }
        return out;
    }

    /// Selects the most beneficial cuts of all patches, up to the maximum number of parts.
    void choose(std::size_t max_parts) {
        struct Offer {
            double benefit;
            std::size_t patch, cut;
        };
        std::vector<Offer> offers;
        for (std::size_t p = 0; p < patches_.size(); ++p)
            for (std::size_t c = 0; c < patches_[p].cuts.cuts.size(); ++c)
                offers.push_back({patches_[p].cuts.cuts[c].benefit, p, c});
        std::sort(offers.begin(), offers.end(), [](const Offer& a, const Offer& b) {
            if (a.benefit != b.benefit) return a.benefit > b.benefit;
            return a.patch != b.patch ? a.patch < b.patch : a.cut < b.cut;
        });
        std::size_t parts = 0, emitting = 0;
        for (const Offer& offer : offers) {
            PatchCuts& patch = patches_[offer.patch];
            // The first cut of a face makes two parts.
            const std::size_t more = patch.taken == 0 ? 2 : 1;
            if (parts + more > max_parts || (patch.emits && emitting + more > max_emitting_parts)) continue;
            if (patch.taken != offer.cut) continue;  // an earlier cut of this patch was rejected
            parts += more, emitting += patch.emits ? more : 0, ++patch.taken;
        }
    }

    std::vector<CutCorner> polygon_of(const TextureTile& tile) const {
        std::vector<CutCorner> out;
        const auto& corners = description_.faces[faces_[tile.owner].face].corners;
        for (std::size_t k = 0; k < tile.corners.size(); ++k) {
            const std::uint32_t point = corners[tile.corners[k]];
            out.push_back({tile.places[k], description_.points[point], point});
        }
        return out;
    }

    void add_whole(const TextureTile& tile, CutFaces& out) {
        const VaryingFace& face = faces_[tile.owner];
        const Material& material = description_.materials[description_.faces[face.face].material];
        const PartColour colour = part_colour(material, face.colours, tile.corners, whitest_);
        const bool stays = colour.coverage >= 0.5;
        out.misplaced += tile.area * (stays ? 1 - colour.coverage : colour.coverage);
        if (stays) add(tile, polygon_of(tile), colour, out);
    }

    void add(const TextureTile& tile, std::span<const CutCorner> polygon, const PartColour& colour, CutFaces& out) {
        FacePart part{{}, colour};
        std::vector<Point> outline;
        for (const CutCorner& c : polygon) outline.push_back(c.point);
        part.area = norm(area_vector(outline));
        constexpr double none = 1e-12;  // derived from rounding: share of a tile's area
        if (!(part.area > none * tile.area)) return;
        for (const CutCorner& c : polygon) {
            part.corners.push_back(
                c.index == CutCorner::new_point ? static_cast<std::uint32_t>(description_.points.size()) : c.index);
            if (c.index == CutCorner::new_point) description_.points.push_back(c.point);
        }
        out.parts[tile.owner].push_back(std::move(part));
    }

    /// Chooses the parts that remain when the others become holes: those with the smallest share of holes, until their
    /// area equals the area outside of holes.
    static std::vector<std::uint8_t> staying_parts(const std::vector<TexturePart>& parts,
                                                   const std::vector<std::uint8_t>& is_cut, double& misplaced) {
        std::vector<std::size_t> left, open = {0};
        double wanted = 0, kept = 0;
        while (!open.empty()) {
            const std::size_t p = open.back();
            open.pop_back();
            if (is_cut[p]) {
                open.push_back(parts[p].children + 1), open.push_back(parts[p].children);
            } else {
                left.push_back(p), wanted += parts[p].area * parts[p].colour.coverage;
            }
        }
        std::stable_sort(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
            return parts[a].colour.coverage > parts[b].colour.coverage;
        });
        std::vector<std::uint8_t> stays(parts.size());
        for (const std::size_t p : left) {
            const double area = parts[p].area, coverage = parts[p].colour.coverage;
            stays[p] = coverage >= 1 || (coverage > 0 && kept + 0.5 * area <= wanted);
            kept += stays[p] ? area : 0, misplaced += area * (stays[p] ? 1 - coverage : coverage);
        }
        return stays;
    }

    void add_parts(const PatchCuts& patch, CutFaces& out) {
        const std::vector<TexturePart>& parts = patch.cuts.parts;
        std::vector<std::uint8_t> is_cut(parts.size());
        for (std::size_t c = 0; c < patch.taken; ++c) is_cut[patch.cuts.cuts[c].part] = 1;
        const std::vector<std::uint8_t> stays = staying_parts(parts, is_cut, out.misplaced);
        for (const std::uint32_t t : patch.patch->tiles) {
            struct Open {
                std::size_t part;
                std::vector<CutCorner> polygon;
            };
            std::vector<Open> open;
            open.push_back({0, polygon_of(all_.tiles[t])});
            while (!open.empty()) {
                const Open next = std::move(open.back());
                open.pop_back();
                const TexturePart& part = parts[next.part];
                if (!is_cut[next.part]) {
                    if (stays[next.part]) add(all_.tiles[t], next.polygon, part.colour, out);
                    continue;
                }
                std::vector<CutCorner> below, above;
                cut_polygon(next.polygon, part.along_s, part.at, part.along_s ? patch.tolerance.x : patch.tolerance.y,
                            below, above);
                if (above.size() > 2) open.push_back({part.children + 1, std::move(above)});
                if (below.size() > 2) open.push_back({part.children, std::move(below)});
            }
        }
    }

    SceneDescription& description_;
    std::span<const VaryingFace> faces_;
    double whitest_;
    CutScale scale_;
    TexturePatches all_;
    std::vector<PatchCuts> patches_;
};

}  // namespace

std::size_t default_texture_parts(std::size_t faces) {
    constexpr std::size_t in_any_scene = 500, faces_per_part = 4;  // derived from solve times, see formats/scenes.md
    return in_any_scene + faces / faces_per_part;
}

CutFaces cut_textured_faces(SceneDescription& description, std::span<const VaryingFace> faces, double whitest,
                            std::size_t max_parts) {
    if (faces.empty() || max_parts < 2)
        return {std::vector<std::vector<FacePart>>(faces.size()), std::vector<std::uint8_t>(faces.size())};
    return FaceCutter(description, faces, whitest).cut(max_parts);
}

}  // namespace exitance
