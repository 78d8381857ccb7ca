#include "exitance/evaluate/unlit_sides.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/direct/small_sources.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/gather/path_tracer.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/scene/other_side.hpp"

namespace exitance {
namespace {

constexpr unsigned places = 16;  ///< Number of tested places on a side of a sheet.
/// Number of tested places on another large region, of which light may reach only a part, such as the ground before an
/// open door. Derived from parts of a fiftieth, of which fewer than 1 in 100 are missed.
constexpr unsigned places_on_large = 256;

/// A region with all of its pieces.
struct Side {
    RegionId region;
    bool is_sheet;
    double area = 0;
    std::vector<const Patch*> pieces = {};

    /// A point for three numbers in [0, 1), uniform in area.
    Point at(double which, double u, double v) const {
        double left = which * area;
        std::size_t k = 0;
        while (k + 1 < pieces.size() && left >= pieces[k]->area()) left -= pieces[k++]->area();
        return pieces[k]->at(uniform_in_shape(pieces[k]->shape, u, v));
    }
};

/// Sides of sheets, and other large regions.
std::vector<Side> sides_to_examine(const Stage& stage) {
    // Share of all area, derived from errors, which a region of that size changes by a fortieth.
    constexpr double min_share = 0.05;
    const Field<RegionId, RegionId> other = other_sides_of_regions(stage.scene);
    const auto is_sheet = [&](RegionId r) { return other.size() > 0 && !other[r].is_none(); };
    std::vector<Side> out;
    for (const Piece& piece : stage.pieces) {
        // Light from behind a diffusing pane counts as its own.
        if (!stage.scene.behind(piece.region).is_none()) continue;
        if (stage.scene.material(piece.region).emits()) continue;
        if (!is_sheet(piece.region) && stage.scene.regions()[piece.region].area < min_share * stage.area) continue;
        if (out.empty() || out.back().region != piece.region) out.push_back({piece.region, is_sheet(piece.region)});
        out.back().pieces.push_back(&piece.patch);
        out.back().area += piece.patch.area();
    }
    return out;
}

/// Returns whether any light reaches a side. Tries paths first: they find light nearly everywhere, whereas exact direct
/// light may be thousands of times more expensive.
bool is_lit(const Stage& stage, const PathTracer& tracer, const Side& side, unsigned paths, std::uint64_t seed) {
    const Normal& n = stage.scene.regions()[side.region].plane.n;
    const ScrambledSobol where(hash(seed, static_cast<std::uint64_t>(Stream::reference), side.region.value));
    std::vector<std::pair<Point, unsigned>> open;
    const unsigned count = side.is_sheet ? places : places_on_large;
    for (unsigned i = 0; i < count; ++i) {
        const Point x = side.at(where(i, 0), where(i, 1), where(i, 2));
        if (!stage.occluders.is_covered(x, n, side.region)) open.emplace_back(x, i);
    }
    for (const auto& [x, i] : open) {
        RandomStream random(seed, Stream::reference, side.region.value, i);
        const ScrambledSobol directions(hash(random.key(), 1u));
        for (unsigned p = 0; p < paths; ++p)
            if (max(tracer.path({x, n, side.region}, directions(p, 0), directions(p, 1), random)) > 0) return true;
    }
    PlaceLight::Workspace workspace;
    // derived from the purpose: only whether there is any light matters
    constexpr LightAccuracy any_light{.relative = 0.01};
    return std::any_of(open.begin(), open.end(), [&](const auto& place) {
        return max(stage.place_light.at(place.first, n, side.region, any_light, workspace).irradiance) > 0;
    });
}

/// A place that a small source lights.
struct LitPlace {
    Point x;
    RegionId region;
};

/// Finds sides that are lit although no path found light: a patch of sun behind a small window is met by few paths, and
/// then a whole room of sheets would count as unlit. A side is lit if a small source lights it, or if a path from it
/// has a vertex that sees a place that a small source lights.
class LitPlaces {
  public:
    LitPlaces(const Stage& stage, std::uint64_t seed) : stage_(stage), seed_(seed) {
        for (const Piece& piece : stage.pieces) of_region_[piece.region].push_back(&piece.patch);
    }

    /// Returns, for each of the given sides, 1 if it is lit.
    std::vector<std::uint8_t> are_lit(std::span<const Side* const> sides) {
        std::vector<std::vector<Vertex>> paths(sides.size());
        parallel_ranges(sides.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) paths[i] = vertices_from(*sides[i]);
        });
        find_places(paths);
        std::vector<std::uint8_t> out(sides.size());
        parallel_ranges(sides.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                out[i] = lit_regions_.contains(sides[i]->region) ||
                         std::any_of(lit_.begin(), lit_.end(),
                                     [&](const LitPlace& place) { return is_seen(place, paths[i]); });
        });
        return out;
    }

  private:
    using Vertex = LitPlace;  // a place from which light may come

    const Normal& normal_of(RegionId region) const { return stage_.scene.regions()[region].plane.n; }
    bool reflects(RegionId region) const { return max(stage_.scene.material(region).reflectance) > 0; }

    /// Places on a side, and the surfaces that a path from each of them meets.
    std::vector<Vertex> vertices_from(const Side& side) const {
        constexpr unsigned max_reflections = 4;
        std::vector<Vertex> out;
        RandomStream random(seed_, Stream::visibility, side.region.value, 0);
        for (unsigned i = 0; i < places; ++i) {
            const double which = random.uniform(), u = random.uniform(), v = random.uniform();
            Vertex at{side.at(which, u, v), side.region};
            if (stage_.occluders.is_covered(at.x, normal_of(at.region), at.region)) continue;
            for (unsigned k = 0; k <= max_reflections; ++k) {
                out.push_back(at);
                const double a = random.uniform(), b = random.uniform();
                const Vec3 w = cosine_direction(Frame(normal_of(at.region)), a, b);
                RayHit hit;
                stage_.tracer.nearest(std::span(&w, 1), at.x, at.region, std::span(&hit, 1));
                if (hit.surface.is_none() || !hit.front || !reflects(hit.region)) break;
                at = {at.x + hit.distance * w, hit.region};
            }
        }
        return out;
    }

    /// Finds the lit places of all regions that have a vertex, and keeps enough of them to test which sides see them.
    void find_places(std::span<const std::vector<Vertex>> paths) {
        std::vector<RegionId> regions;
        for (const std::vector<Vertex>& path : paths)
            for (const Vertex& vertex : path) regions.push_back(vertex.region);
        std::sort(regions.begin(), regions.end());
        regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
        std::vector<std::vector<LitPlace>> found(regions.size());
        parallel_ranges(regions.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) found[i] = places_on(regions[i]);
        });
        for (const std::vector<LitPlace>& of_region : found)
            lit_.insert(lit_.end(), of_region.begin(), of_region.end());
        for (const LitPlace& place : lit_) lit_regions_.insert(place.region);
        constexpr std::size_t max_places = 64;
        if (lit_.size() <= max_places) return;
        for (std::size_t i = 0; i < max_places; ++i) lit_[i] = lit_[i * lit_.size() / max_places];
        lit_.resize(max_places);
    }

    std::vector<LitPlace> places_on(RegionId region) const {
        std::vector<LitPlace> out;
        SmallSources::Workspace room;
        for (const Patch* patch : of_region_.at(region)) {
            std::vector<Point> outline;
            for (int i = 0; i < patch->corner_count(); ++i) outline.push_back(patch->corner(i));
            for (const Point& x :
                 SmallSources(stage_.direct).lit_places({outline, normal_of(region), region, {}, {}}, room))
                out.push_back({x, region});
        }
        return out;
    }

    bool is_seen(const LitPlace& place, std::span<const Vertex> from) const {
        return reflects(place.region) && std::any_of(from.begin(), from.end(), [&](const Vertex& vertex) {
                   const Vec3 d = place.x - vertex.x;
                   if (!(dot(d, normal_of(vertex.region)) > 0 && dot(d, normal_of(place.region)) < 0)) return false;
                   RayHit hit;
                   stage_.tracer.nearest(std::span(&d, 1), vertex.x, vertex.region, std::span(&hit, 1));
                   return hit.region == place.region && hit.front;
               });
    }

    const Stage& stage_;
    std::uint64_t seed_;
    std::map<RegionId, std::vector<const Patch*>> of_region_;
    std::vector<LitPlace> lit_;
    std::set<RegionId> lit_regions_;
};

/// Corrects `unlit` where small sources are the only light. Of thousands of sides the largest are examined: they hold
/// the area by which errors are judged.
void light_seen_sides(const Stage& stage, const std::vector<Side>& sides, std::uint64_t seed,
                      std::vector<std::uint8_t>& unlit) {
    constexpr std::size_t max_sides = 4096;
    std::vector<std::size_t> dark;
    for (std::size_t k = 0; k < sides.size(); ++k)
        if (unlit[k]) dark.push_back(k);
    std::stable_sort(dark.begin(), dark.end(),
                     [&](std::size_t a, std::size_t b) { return sides[a].area > sides[b].area; });
    dark.resize(std::min(dark.size(), max_sides));
    if (dark.empty()) return;
    std::vector<const Side*> dark_sides;
    for (const std::size_t k : dark) dark_sides.push_back(&sides[k]);
    const std::vector<std::uint8_t> lit = LitPlaces(stage, seed).are_lit(dark_sides);
    for (std::size_t i = 0; i < dark.size(); ++i) unlit[dark[i]] = !lit[i];
}

}  // namespace

Field<RegionId, std::uint8_t> find_unlit_sides(const Stage& stage, std::uint64_t seed, const StopRequest& stop) {
    const std::vector<Side> sides = sides_to_examine(stage);
    if (sides.empty() || !stage.scene.has_light()) return {};
    // Paths of all sides together: about as many rays as a quick solve.
    constexpr double all = 1 << 18;
    const PathTracer tracer(stage);
    std::vector<std::uint8_t> unlit(sides.size());
    const auto look = [&](std::size_t k) {
        if (stop.requested()) return;
        const double share = std::sqrt(sides[k].area / stage.area / static_cast<double>(sides.size()));
        const double paths = std::clamp(all / places * share, 2.0, calibrated::max_sheet_paths);
        unlit[k] = !is_lit(stage, tracer, sides[k], static_cast<unsigned>(paths), seed);
    };
    shared_ranges(
        sides.size(), 4,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) look(k);
        },
        [&](std::size_t k) -> std::uint8_t& { return unlit[k]; }, {"unlit sides"});
    if (stop.requested()) return {};
    light_seen_sides(stage, sides, seed, unlit);
    Field<RegionId, std::uint8_t> out(stage.scene.regions().size());
    std::size_t count = 0;
    for (std::size_t k = 0; k < sides.size(); ++k) {
        out[sides[k].region] = unlit[k];
        count += unlit[k];
    }
    // If no side is lit, there is no other light to which errors could be relative.
    return count > 0 && count < out.size() ? out : Field<RegionId, std::uint8_t>();
}

}  // namespace exitance
