#include "exitance/transport/room_borders.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {
namespace {

/// Leaves between rooms, such as the sides of a door.
struct LeavesBetween {
    std::vector<std::size_t> leaves;
    /// For each of them the first leaf of its group. The leaves of a group hit one another.
    std::vector<std::uint32_t> group;
};

/// Finds the leaves at borders between rooms, which are of three kinds:
/// - leaves of whose rays more than a tenth end in another room;
/// - leaves most of whose rays end at near things, and at least one in another room;
/// - leaves most of whose rays end at near things, and which a leaf found so far hits.
/// Two leaves most of whose rays end at near things belong to one group if one hits the other.
LeavesBetween leaves_between(const RayRows& rows, const ElementTree& tree, const LeafNumbering& numbering,
                             std::span<const std::size_t> room_of, std::size_t rooms) {
    // A leaf is at a border if a larger share of its rays ends in other rooms. Chosen: half of it and twice it give
    // the same rooms, measured by `exitance solve door.obj --error 0.02`.
    constexpr double firm = 0.1;
    // A ray ends at a near thing if it is shorter than this share of the mean length of rays in its room. Chosen:
    // half of it takes the same number of rays and twice it 2.4 times as many, measured by `exitance solve door.obj
    // --error 0.02`.
    constexpr double near = 0.25;
    const std::size_t n = room_of.size();
    std::vector<double> other(n), length(rooms), area(rooms);
    const auto length_to = [&](std::size_t i, std::uint32_t j) {
        return norm(tree.patch(numbering.leaves[j]).centre() - tree.patch(numbering.leaves[i]).centre());
    };
    for (std::size_t i = 0; i < n; ++i) {
        const ElementId e = numbering.leaves[i];
        double met = 0, sum = 0;
        for (const std::uint32_t j : rows.hits(i))
            if (j != RayRows::missed) ++met, other[i] += room_of[j] != room_of[i] ? 1 : 0, sum += length_to(i, j);
        if (met == 0) continue;
        other[i] /= met;
        length[room_of[i]] += tree.area(e) * sum / met, area[room_of[i]] += tree.area(e);
    }
    const auto sees_near_things = [&](std::size_t i) {
        const double limit = near * length[room_of[i]] / area[room_of[i]];
        int more_near = 0;
        for (const std::uint32_t j : rows.hits(i))
            if (j != RayRows::missed) more_near += length_to(i, j) < limit ? 1 : -1;
        return more_near > 0;
    };
    std::vector<std::uint8_t> is_between(n, 0), is_near(n, 0);
    LeavesBetween out;
    std::vector<std::size_t> wave;
    DisjointSets groups(n);
    const auto add = [&](std::size_t i) {
        if (std::exchange(is_between[i], std::uint8_t{1}) == 0) out.leaves.push_back(i), wave.push_back(i);
    };
    for (std::size_t i = 0; i < n; ++i) {
        is_near[i] = sees_near_things(i) ? 1 : 0;
        if (other[i] > (is_near[i] ? 0 : firm)) add(i);
    }
    while (!wave.empty())
        for (const std::size_t i : std::exchange(wave, {}))
            for (const std::uint32_t j : rows.hits(i))
                if (j != RayRows::missed && is_near[j]) {
                    add(j);
                    if (is_near[i]) groups.unite(static_cast<std::uint32_t>(i), j);
                }
    for (const std::size_t i : out.leaves) out.group.push_back(groups.root(static_cast<std::uint32_t>(i)));
    return out;
}

/// Returns the share of the rays of each leaf between rooms that reach each room, if rays that hit other leaves between
/// rooms go on from there: `rooms` values per leaf.
std::vector<double> shares_by_room(const RayRows& rows, std::span<const std::size_t> between,
                                   std::span<const std::size_t> room_of, std::size_t rooms) {
    constexpr int passes = 32;  // derived from leaves that hit one another with nine tenths of their rays
    constexpr std::size_t within = ~std::size_t{0};
    std::vector<std::size_t> place(room_of.size(), within);
    for (std::size_t k = 0; k < between.size(); ++k) place[between[k]] = k;
    std::vector<double> share(between.size() * rooms), next(share.size());
    for (int pass = 0; pass < passes; ++pass) {
        std::fill(next.begin(), next.end(), 0.0);
        for (std::size_t k = 0; k < between.size(); ++k) {
            const std::span of_leaf = std::span(next).subspan(k * rooms, rooms);
            double met = 0;
            for (const std::uint32_t j : rows.hits(between[k])) {
                if (j == RayRows::missed) continue;
                ++met;
                if (place[j] == within)
                    of_leaf[room_of[j]] += 1;
                else
                    for (std::size_t r = 0; r < rooms; ++r) of_leaf[r] += share[place[j] * rooms + r];
            }
            for (double& of_room : of_leaf) of_room /= std::max(1.0, met);
        }
        share.swap(next);
    }
    return share;
}

}  // namespace

std::vector<std::size_t> given_to_brighter(const RayRows& rows, const ElementTree& tree, const LeafNumbering& numbering,
                                           std::span<const double> light, std::span<const std::size_t> room_of) {
    // A leaf may be given to another room if at least this share of its rays reaches that room. Chosen: half of it
    // takes 7% fewer rays for a 7% larger error, and twice it 61% more rays, measured by `exitance solve door.obj
    // --error 0.02`.
    constexpr double seen = 0.25;
    // Rooms are treated as different only if one is this many times as bright as the other. Errors of the bright room's
    // light are then large in the dark one.
    constexpr double brighter = 4;
    const std::size_t rooms = light.size();
    std::vector<std::size_t> out(room_of.begin(), room_of.end());
    const auto [dimmest, brightest] = std::minmax_element(light.begin(), light.end());
    if (!(*brightest > brighter * *dimmest)) return out;
    const auto [between, group] = leaves_between(rows, tree, numbering, room_of, rooms);
    const std::vector<double> share = shares_by_room(rows, between, room_of, rooms);
    // Few rays of a leaf leave the group, so that their sum over the group decides.
    std::unordered_map<std::uint32_t, std::vector<double>> sums;
    for (std::size_t k = 0; k < between.size(); ++k) {
        std::vector<double>& of_group = sums[group[k]];
        of_group.resize(rooms);
        for (std::size_t r = 0; r < rooms; ++r)
            of_group[r] += tree.area(numbering.leaves[between[k]]) * share[k * rooms + r];
    }
    std::vector<double> area(rooms), moved(rooms);  // m^2
    for (std::size_t i = 0; i < out.size(); ++i) area[room_of[i]] += tree.area(numbering.leaves[i]);
    for (std::size_t k = 0; k < between.size(); ++k) {
        const std::vector<double>& of_group = sums[group[k]];
        const std::size_t i = between[k];
        const double all = std::accumulate(of_group.begin(), of_group.end(), 0.0);
        for (std::size_t r = 0; r < rooms; ++r)
            if (of_group[r] >= seen * all && light[r] > brighter * light[room_of[i]] && light[r] > light[out[i]])
                out[i] = r;
        if (out[i] != room_of[i]) moved[room_of[i]] += tree.area(numbering.leaves[i]);
    }
    // A room that would lose most of its area keeps it. Such a room is a gap, for example behind furniture, and nearly
    // all of its light is at its mouth. Without the mouth, the rest would be nearly dark, and its relative error large.
    constexpr double max_moved = 0.5;
    for (const std::size_t i : between)
        if (moved[room_of[i]] > max_moved * area[room_of[i]]) out[i] = room_of[i];
    return out;
}

}  // namespace exitance
