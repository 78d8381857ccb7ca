#include "exitance/what_if/daylight/glare_view.hpp"

#include <algorithm>
#include <set>

#include "exitance/measure/glare/daylight_glare_rules.hpp"
#include "exitance/measure/glare/near_directions.hpp"
#include "exitance/measure/glare/view_triangle.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

/// Largest extent of the triangles of a view, radians: half of a step between parts of one source.
constexpr double max_extent = 0.05;

}  // namespace

/// A visible triangle of a surface or of a patch.
struct GlareView::Piece {
    std::uint32_t patch = 0;
    Normal towards;
    double solid_angle = 0, transmission = 0;
};

GlareView::GlareView(const DaylightTransport& transport, const SkyPatches& patches, const BrightElements& bright,
                     const SurfacePoint& eye)
    : eye_(eye), patches_(patches.size()) {
    join(visible_pieces(transport, patches, bright));
}

std::vector<GlareView::Piece> GlareView::visible_pieces(const DaylightTransport& transport, const SkyPatches& patches,
                                                        const BrightElements& bright) const {
    const Occluders& occluders = transport.stage().occluders;
    const Scene& scene = transport.stage().scene;
    const double beyond_panes = 2 * (norm(eye_.x - scene.box().centre()) + scene.size());
    std::vector<Piece> out;
    const auto add = [&](const ViewTriangle& t, const Normal& towards, double distance, std::size_t patch) {
        const double passing = luminous_sum(transmission_between(scene.panes(), eye_.x, eye_.x + distance * towards));
        if (passing > 0) out.push_back({static_cast<std::uint32_t>(patch), towards, t.solid_angle(), passing});
    };
    std::vector<PieceId> distant, near;
    for (const PieceId piece : occluders.distant_pieces()) distant.push_back(piece);
    for (const RegionId region : scene.regions().ids())
        for (const PieceId piece : occluders.pieces(region)) near.push_back(piece);
    for (const auto& triangles : visible_triangles(occluders, eye_, distant, max_extent))
        for (const ViewTriangle& t : triangles) {
            const Normal towards = t.middle();
            add(t, towards, beyond_panes, patches.of(towards));
        }
    const std::vector<std::vector<ViewTriangle>> seen = visible_triangles(occluders, eye_, near, max_extent);
    for (std::size_t i = 0; i < near.size(); ++i) {
        const ConvexPiece& piece = occluders.pieces()[near[i]];
        for (const ViewTriangle& t : seen[i]) {
            const Normal towards = t.middle();
            const double distance = dot(piece.plane.n, t.corners[0]) / dot(piece.plane.n, towards);
            const std::optional<std::size_t> leaf = transport.leaf_at(piece.region, eye_.x + distance * towards);
            if (leaf && bright.is_ever_bright(*leaf)) add(t, towards, distance, patches.size() + *leaf);
        }
    }
    std::stable_sort(out.begin(), out.end(), [](const Piece& a, const Piece& b) { return a.patch < b.patch; });
    return out;
}

/// Makes a part of every set of near pieces of one patch, and finds which parts are near each other.
void GlareView::join(const std::vector<Piece>& pieces) {
    std::vector<Normal> directions;
    for (const Piece& piece : pieces) directions.push_back(piece.towards);
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> near = near_pairs(directions, glare_joining_angle);
    DisjointSets sets(pieces.size());
    for (const auto& [a, b] : near)
        if (pieces[a].patch == pieces[b].patch) sets.unite(a, b);
    std::vector<std::uint32_t> part_of(pieces.size());
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        const std::uint32_t first = sets.root(i);
        if (first == i)
            part_of[i] = static_cast<std::uint32_t>(parts_.size()), parts_.emplace_back().patch = pieces[i].patch;
        part_of[i] = part_of[first];
        Part& part = parts_[part_of[i]];
        const Piece& piece = pieces[i];
        part.solid_angle += piece.solid_angle, part.transmission += piece.solid_angle * piece.transmission;
        part.centre += piece.solid_angle * piece.transmission * piece.towards;
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> adjacent;
    for (const auto& [a, b] : near)
        if (part_of[a] != part_of[b])
            adjacent.insert({std::max(part_of[a], part_of[b]), std::min(part_of[a], part_of[b])});
    auto next = adjacent.begin();
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
        parts_[p].transmission /= parts_[p].solid_angle;
        for (; next != adjacent.end() && next->first == p; ++next) neighbours_.push_back(next->second);
        parts_[p].next = static_cast<std::uint32_t>(neighbours_.size());
        sky_parts_ += parts_[p].patch < patches_;
    }
}

/// Sets the luminances of the parts above the threshold, and lists these.
void GlareView::collect(std::span<const float> sky, std::span<const BrightElements::Entry> elements, double threshold,
                        Workspace& w) const {
    w.lit.clear();
    w.luminance.assign(parts_.size(), 0.0F);
    const auto add = [&](std::size_t p, float outside) {
        const double luminance = parts_[p].transmission * double(outside);
        if (!(luminance > threshold)) return;
        w.luminance[p] = static_cast<float>(luminance), w.lit.push_back(static_cast<std::uint32_t>(p));
    };
    std::size_t p = 0;
    for (; p < sky_parts_; ++p) add(p, sky[parts_[p].patch]);
    for (const BrightElements::Entry& entry : elements) {
        const std::size_t patch = patches_ + entry.leaf;
        while (p < parts_.size() && parts_[p].patch < patch) ++p;
        for (; p < parts_.size() && parts_[p].patch == patch; ++p) add(p, entry.luminance);
        if (p == parts_.size()) break;
    }
}

double GlareView::terms(std::span<const float> sky, std::span<const BrightElements::Entry> elements, double threshold,
                        Workspace& w) const {
    collect(sky, elements, threshold, w);
    w.sets.make_room(parts_.size());
    const auto is_peak = [&](std::uint32_t p) { return double(w.luminance[p]) >= peak_luminance; };
    for (const std::uint32_t p : w.lit) {
        w.sets.isolate(p);
        for (std::uint32_t k = p == 0 ? 0 : parts_[p - 1].next; k < parts_[p].next; ++k)
            if (const std::uint32_t q = neighbours_[k]; w.luminance[q] > 0 && is_peak(p) == is_peak(q))
                w.sets.unite(p, q);
    }
    struct Sum {
        double light = 0, solid_angle = 0;
        Vec3 centre;
    };
    std::vector<std::pair<std::uint32_t, Sum>> sums;
    for (const std::uint32_t p : w.lit) {
        const std::uint32_t first = w.sets.root(p);
        auto at = std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == first; });
        if (at == sums.end()) at = sums.insert(sums.end(), {first, {}});
        const double L = double(w.luminance[p]);
        at->second.light += L * parts_[p].solid_angle, at->second.solid_angle += parts_[p].solid_angle;
        at->second.centre += L / parts_[p].transmission * parts_[p].centre;
    }
    double out = 0;
    for (const auto& [first, sum] : sums) {
        const double P = daylight_position(eye_.n, sum.centre), L = sum.light / sum.solid_angle;
        out += L * L * sum.solid_angle / (P * P);
    }
    return out;
}

}  // namespace exitance
