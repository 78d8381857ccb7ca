#include "exitance/transport/light_rooms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/error_share.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/body_surroundings.hpp"
#include "exitance/transport/light_openings.hpp"
#include "exitance/transport/light_portals.hpp"
#include "exitance/transport/room_borders.hpp"
#include "exitance/transport/room_finder.hpp"

namespace exitance {
namespace {

// The numbers below limit the work of finding rooms. They were chosen by trial and not measured by a command.

constexpr double mean_rays = 24;                ///< Rays of an element of mean area.
constexpr unsigned min_rays = 16;               ///< Minimum per element; sufficient if no part is outdoors.
constexpr unsigned max_room_rays = 256;         ///< Maximum per element. Outdoors, a room may have few elements.
constexpr std::size_t rays_outdoors = 1 << 18;  ///< Maximum of rays of all elements together, if there is a sky.

/// Returns the rays of this many coarse elements.
RayBudget rays_for_rooms(const Stage& stage, std::size_t elements, std::size_t pieces) {
    const double fewer = ErrorShare::is_crowd(elements, pieces) ? fewer_rays_in_crowd(elements) : 1;
    RayBudget rays{.average = fewer * mean_rays,
                   .min = static_cast<unsigned>(fewer * min_rays),
                   .max = max_room_rays,
                   .front_alone = true};
    const bool has_sky = !stage.scene.distant().domes.empty();
    while (has_sky && rays.min < max_room_rays && 2 * rays.min * elements <= rays_outdoors) rays.min *= 2;
    return rays;
}

}  // namespace

std::size_t LightRooms::at(RegionId region, const Point& x) const {
    return count() > 0 ? room_of_[locator_->find(region, x).element] : 0;
}

std::size_t LightRooms::of(const ElementTree& tree, ElementId e) const {
    return count() > 0 ? at(tree.region(e), tree.patch(e).at(tree.centre(e))) : 0;
}

double LightRooms::weight(const ElementTree& tree, ElementId e) const {
    return count() > 0 ? mean_area_ / areas_[of(tree, e)] : 1;
}

double LightRooms::importance(const ElementTree& tree, ElementId e) const {
    if (count() == 0) return 1;
    return static_cast<double>(importance_[locator_->find(tree.region(e), tree.patch(e).at(tree.centre(e))).element]);
}

/// Sets the room of every leaf. Numbers rooms by descending area. Sides that no light reaches do not count: errors are
/// not relative to their area.
void LightRooms::set(std::span<const std::size_t> room_of, std::size_t rooms, const Stage& stage,
                     const ElementTree& tree, const LeafNumbering& numbering) {
    std::vector<double> area(rooms), all(rooms);  // m^2
    for (std::size_t i = 0; i < room_of.size(); ++i) {
        const ElementId e = numbering.leaves[i];
        all[room_of[i]] += tree.area(e);
        if (!stage.is_unlit(tree.region(e))) area[room_of[i]] += tree.area(e);
    }
    const auto lit_rooms = static_cast<double>(
        std::max<std::ptrdiff_t>(1, std::count_if(area.begin(), area.end(), [](double a) { return a > 0; })));
    const double mean_area = std::accumulate(area.begin(), area.end(), 0.0) / lit_rooms;
    for (std::size_t room = 0; room < rooms; ++room)
        if (!(area[room] > 0)) area[room] = all[room];
    std::vector<std::size_t> falling(rooms), number(rooms);
    std::iota(falling.begin(), falling.end(), std::size_t{0});
    std::stable_sort(falling.begin(), falling.end(), [&](auto a, auto b) { return area[a] > area[b]; });
    areas_.clear(), mean_area_ = mean_area;
    for (std::size_t k = 0; k < rooms; ++k) {
        number[falling[k]] = k;
        areas_.push_back(area[falling[k]]);
    }
    room_of_.resize(tree.size());
    for (std::size_t i = 0; i < room_of.size(); ++i)
        room_of_[numbering.leaves[i]] = static_cast<std::uint16_t>(number[room_of[i]]);
}

/// Computes the importance of coarse elements: their own weight w_i, plus the weight of the elements of other rooms
/// that receive their light. Element i receives the share F_ij of its light from j and adds F_ij w_i A_i to j. If j is
/// in a brighter room, F_ij is multiplied by the ratio of the rooms' light: an error in the light of the sides of a
/// narrow door is nearly as large, relatively, in the dim room behind it.
/// light  mean light of every room, W/m^2
void LightRooms::weigh(const ElementTree& tree, const LeafNumbering& numbering, const RayRows& rows,
                       std::span<const double> light) {
    const std::size_t n = numbering.leaves.size();
    std::vector<double> sent(n);
    for (std::size_t i = 0; i < n; ++i) {
        const ElementId e = numbering.leaves[i];
        const std::span<const std::uint32_t> hits = rows.hits(i);
        const double each = mean_area_ / areas_[room_of_[e]] * tree.area(e) / static_cast<double>(hits.size());
        const double own = light[room_of_[e]];
        for (std::uint32_t j : hits) {
            if (j == RayRows::missed || room_of_[numbering.leaves[j]] == room_of_[e]) continue;
            const double other = light[room_of_[numbering.leaves[j]]];
            sent[j] += own > 0 && other > own ? each * other / own : each;
        }
    }
    importance_.resize(tree.size());
    piece_importance_.assign(tree.roots().size(), HUGE_VAL);
    Field<ElementId, std::uint32_t> root_of(tree.size());
    for (std::size_t k = 0; k < tree.roots().size(); ++k) root_of[tree.roots()[k]] = static_cast<std::uint32_t>(k);
    for (ElementId e : tree.ids()) {
        if (!tree.parent(e).is_none()) root_of[e] = root_of[tree.parent(e)];
        if (!tree.is_leaf(e)) continue;
        const double own = mean_area_ / areas_[room_of_[e]] + sent[numbering.number[e]] / tree.area(e);
        importance_[e] = static_cast<float>(own);
        piece_importance_[root_of[e]] = std::min(piece_importance_[root_of[e]], own);
    }
}

LightRooms find_light_rooms(const Stage& stage, std::uint64_t seed, const StopRequest& stop) {
    constexpr std::size_t elements = 600;  // number of elements in addition to one per piece
    const std::vector<Piece> pieces = stage.lit_pieces();
    ElementTree tree = stage.make_elements({edge_for_elements(pieces, pieces.size() + elements), 0}, &stop);
    const auto surroundings = std::make_shared<const BodySurroundings>(stage);
    surroundings->refine(tree, &stop);
    auto locator = std::make_shared<const ElementLocator>(tree, stage.scene.regions().size());
    const LeafNumbering numbering(tree);
    const RayBudget rays = rays_for_rooms(stage, numbering.leaves.size(), pieces.size());
    const RayRows rows(stage, {tree, numbering, *locator}, {rays, seed}, &stop);
    const std::vector<std::uint32_t> escaped = rows.escaped();
    const auto [rooms, spaces] = find_room_leaves({stage, tree, numbering, rows, escaped}, seed, stop);
    LightRooms out;
    if (stop.requested()) return out;  // rows that were not cast have no information
    out.spaces_ = spaces;
    const std::vector<double> kept = rows.kept();
    const bool loses = std::any_of(kept.begin(), kept.end(), [](double share) { return share < 1; });
    if (rooms.size() < 2 && !loses && surroundings->are_empty()) return out;
    out.lost_.resize(tree.size());
    for (std::size_t i = 0; i < kept.size(); ++i) out.lost_[numbering.leaves[i]] = static_cast<float>(1 - kept[i]);
    out.locator_ = std::move(locator);
    share_on_node(out.lost_.span()), share_on_node(out.locator_->leaves());
    std::vector<std::size_t> room_of(numbering.leaves.size());
    for (std::size_t room = 0; room < rooms.size(); ++room)
        for (std::uint32_t i : rooms[room]) room_of[i] = room;
    std::vector<double> light;
    if (rooms.size() > 1) {
        out.set(room_of, rooms.size(), stage, tree, numbering);
        for (std::size_t i = 0; i < room_of.size(); ++i) room_of[i] = out.room_of_[numbering.leaves[i]];
        light = coarse_light(stage, out, tree, numbering, rows);
        if (const auto given = given_to_brighter(rows, tree, numbering, light, room_of); given != room_of) {
            out.set(given, rooms.size(), stage, tree, numbering);
            light = coarse_light(stage, out, tree, numbering, rows);
        }
        out.portals_ = find_light_portals(stage, out, tree, numbering, light, seed, stop);
        for (std::size_t i = 0; i < room_of.size(); ++i) room_of[i] = out.room_of_[numbering.leaves[i]];
    }
    const BodySurroundings::Division divided =
        surroundings->divide(room_of, rooms.size(), {stage, tree, numbering, rows, escaped});
    if (divided.rooms < 2) return out;
    if (divided.rooms > rooms.size()) {
        out.surroundings_ = surroundings;
        out.set(divided.room_of, divided.rooms, stage, tree, numbering);
        out.is_surroundings_.assign(divided.rooms, 0);
        for (std::size_t i = 0; i < room_of.size(); ++i)
            if (divided.room_of[i] >= rooms.size()) out.is_surroundings_[out.room_of_[numbering.leaves[i]]] = 1;
        std::vector<std::size_t> before(divided.rooms);
        for (std::size_t i = 0; i < room_of.size(); ++i) before[out.room_of_[numbering.leaves[i]]] = room_of[i];
        if (out.portals_) out.portals_ = out.portals_->renumbered(before);
        light = coarse_light(stage, out, tree, numbering, rows);
    }
    out.weigh(tree, numbering, rows, light);
    return out;
}

}  // namespace exitance
