#include "exitance/evaluate/unlit_sides.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/gather/path_tracer.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/scene/other_side.hpp"

namespace exitance {
namespace {

constexpr unsigned places = 16;  ///< Number of tested places on a side.

/// All pieces of a region.
struct Side {
    RegionId region;
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

std::vector<Side> sides_of_sheets(const Stage& stage) {
    const Field<RegionId, RegionId> other = other_sides_of_regions(stage.scene);
    std::vector<Side> out;
    if (other.size() == 0) return out;
    for (const Piece& piece : stage.pieces) {
        // Light from behind a diffusing pane counts as its own.
        if (!stage.scene.behind(piece.region).is_none()) continue;
        if (other[piece.region].is_none() || stage.scene.material(piece.region).emits()) continue;
        if (out.empty() || out.back().region != piece.region) out.push_back({piece.region});
        out.back().pieces.push_back(&piece.patch);
        out.back().area += piece.patch.area();
    }
    return out;
}

/// True if some light reaches a side. Paths come first: they find light nearly everywhere, whereas exact direct light
/// may cost thousands of times as much.
bool is_lit(const Stage& stage, const PathTracer& tracer, const Side& side, unsigned paths, std::uint64_t seed) {
    const Normal& n = stage.scene.regions()[side.region].plane.n;
    const ScrambledSobol where(hash(seed, static_cast<std::uint64_t>(Stream::reference), side.region.value));
    std::vector<std::pair<Point, unsigned>> open;
    for (unsigned i = 0; i < places; ++i) {
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
    constexpr LightAccuracy any_light{.relative = 0.01};  // derived from the question: is there any light?
    return std::any_of(open.begin(), open.end(), [&](const auto& place) {
        return max(stage.place_light.at(place.first, n, side.region, any_light, workspace).irradiance) > 0;
    });
}

}  // namespace

Field<RegionId, std::uint8_t> find_unlit_sides(const Stage& stage, std::uint64_t seed, const StopRequest& stop) {
    const std::vector<Side> sides = sides_of_sheets(stage);
    if (sides.empty() || !stage.scene.has_light()) return {};
    // Paths of all sides together: about as many rays as a quick solve.
    constexpr double all = 1 << 18;
    const PathTracer tracer(stage);
    std::vector<std::uint8_t> unlit(sides.size());
    const auto look = [&](std::size_t k) {
        if (stop.requested()) return;
        const double share = std::sqrt(sides[k].area / stage.area / static_cast<double>(sides.size()));
        const double paths = std::clamp(all / places * share, 2.0, calibrated::most_sheet_paths);
        unlit[k] = !is_lit(stage, tracer, sides[k], static_cast<unsigned>(paths), seed);
    };
    shared_ranges(
        sides.size(), 4,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) look(k);
        },
        [&](std::size_t k) -> std::uint8_t& { return unlit[k]; }, {"unlit sides"});
    if (stop.requested()) return {};
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
