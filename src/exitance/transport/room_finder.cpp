#include "exitance/transport/room_finder.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/base/limits.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

// The numbers below define what counts as a room of its own. They were chosen by trial.

/// A smaller part can be a room, below a sky or above a large ground, if it has at least this share of all elements.
/// Half of it and twice it give the same rooms, measured by `exitance solve office.obj --error 0.02`.
constexpr double min_detail = 0.001;
/// If the scene is at least this many times as large as its rooms, most of its area is ground and sky. Rooms are then
/// not compared with that area.
constexpr double far_larger = 20;
/// Smallest over largest extent of a room. A flatter part is a gap. Half of it and twice it give the same rooms,
/// measured by `exitance solve office.obj --error 0.02`.
constexpr double flattest = 0.1;
/// Volume of a room over area^(3/2). A part with less volume is a gap. Half of it and twice it give the same rooms,
/// measured by `exitance solve office.obj --error 0.02`.
constexpr double thinnest = 0.03;
constexpr std::size_t min_walls = 4;   ///< Minimum number of walls of a room.
constexpr std::size_t max_rooms = 64;  ///< Maximum number of rooms. Further parts stay joined to others.

/// Starting values that differ between rooms: by position along a line, by distance from the centre, and a small random
/// part.
std::vector<double> starting_light(const ElementTree& tree, const LeafNumbering& numbering, std::uint64_t seed) {
    // Any direction, derived from one requirement: it is not parallel to the walls of most buildings.
    constexpr Vec3 along{0.73, 0.54, 0.42};
    // Share of the random part. Chosen: half of it and twice it change the rays by 1%, measured by `exitance solve
    // office.obj --error 0.02`.
    constexpr double chance = 0.1;
    Box box;
    for (ElementId root : tree.roots()) box.add(tree.patch(root).centre());
    std::vector<double> out;
    for (std::size_t i = 0; i < numbering.leaves.size(); ++i) {
        const Vec3 d =
            (tree.patch(numbering.leaves[i]).centre() - box.centre()) / std::max(box.diagonal(), min_divisor);
        out.push_back(dot(d, along) + norm(d) + chance * static_cast<double>(hash(seed, i) >> 11) * 0x1p-53);
    }
    return out;
}

/// Elements that exchange light, and the space that they enclose.
struct Part {
    LeafNumbers leaves;
    double area = 0;          ///< m^2
    double before_backs = 0;  ///< Sum over elements of area times the share of rays that hit backs, m^2.
    double volume = 0;        ///< Sum over elements of area times mean height of the elements it sees, m^3.
    Box box;

    void add(const Part& other) {
        if (other.leaves.empty()) return;
        leaves.insert(leaves.end(), other.leaves.begin(), other.leaves.end());
        area += other.area;
        before_backs += other.before_backs;
        volume += other.volume;
        box.add(other.box.lo), box.add(other.box.hi);
    }
    /// False if the part is a gap, several gaps, a single wall, or faces mainly backs.
    bool may_be_room() const {
        constexpr double power_of_area = 1.5;  // derived from the dimensions of volumes and areas
        const Vec3 size = box.size();
        return leaves.size() >= min_walls && 2 * before_backs <= area &&
               volume >= thinnest * std::pow(area, power_of_area) &&
               std::min({size.x, size.y, size.z}) >= flattest * std::max({size.x, size.y, size.z});
    }
};

/// Splits a scene into parts.
class RoomFinder {
  public:
    RoomFinder(const CoarseElements& in, std::uint64_t seed)
        : scene_(in.stage.scene),
          flow_{in.rows, leaf_areas(in.tree, in.numbering), starting_light(in.tree, in.numbering, seed), {}, {}, {}},
          tree_(in.tree),
          numbering_(in.numbering),
          has_sky_(!in.stage.scene.distant().domes.empty()) {
        const std::size_t n = flow_.area.size();
        flow_.part.resize(n), flow_.to_sky.resize(n), flow_.lost.resize(n);
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::span<const std::uint32_t> hits = in.rows.hits(i);
            const auto missed = static_cast<std::uint32_t>(std::count(hits.begin(), hits.end(), RayRows::missed));
            if (has_sky_)
                flow_.to_sky[i] = in.escaped[i];
            else if (missed < hits.size())  // otherwise something covers the leaf
                flow_.lost[i] = missed;
            if (share_to_sky(flow_, i) < outdoors) indoor_area_ += flow_.area[i];
        }
    }

    RoomLeaves find(const StopRequest& stop) {
        std::vector<Part> open = joined_by_light();
        while (!open.empty() && parts_.size() + open.size() < max_rooms && !stop.requested()) {
            Part part = std::move(open.back());
            open.pop_back();
            Part rest;
            if (cut_at_opening(part, rest))
                open.push_back(std::move(part)), open.push_back(std::move(rest));
            else
                parts_.push_back(std::move(part));
        }
        for (Part& part : open) parts_.push_back(std::move(part));
        RoomLeaves out{.rooms = {}, .spaces = spaces_};
        sort();
        while (const Part* part = smallest_indoors()) {
            if (part == &parts_.front() || counts(*part)) break;
            join(static_cast<std::size_t>(part - parts_.data()));
        }
        if (parts_.size() > 1) place_blind_leaves();
        for (Part& part : parts_) out.rooms.push_back(std::move(part.leaves));
        return out;
    }

  private:
    Part part_of(LeafNumbers leaves) {
        Part part;
        part.leaves = std::move(leaves);
        within_.resize(flow_.area.size(), 0);
        for (std::uint32_t i : part.leaves) within_[i] = 1;
        std::vector<double> height(part.leaves.size());
        const auto find_heights = [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) height[k] = height_seen(part.leaves[k]);
        };
        constexpr std::size_t grain = 256;
        height.size() > grain ? parallel_ranges(height.size(), grain, find_heights) : find_heights(0, height.size());
        for (std::size_t k = 0; k < height.size(); ++k) {
            const std::uint32_t i = part.leaves[k];
            part.area += flow_.area[i];
            part.before_backs += has_sky_ ? flow_.area[i] * share_on_backs(i) : 0;
            part.volume += flow_.area[i] * height[k];
            for (const Point& p : tree_.outline(numbering_.leaves[i])) part.box.add(p);
        }
        for (std::uint32_t i : part.leaves) within_[i] = 0;
        return part;
    }

    double share_on_backs(std::uint32_t i) const {
        const std::span<const std::uint32_t> hits = flow_.rows.hits(i);
        const auto missed = static_cast<double>(std::count(hits.begin(), hits.end(), RayRows::missed));
        return missed / static_cast<double>(hits.size()) - share_to_sky(flow_, i);
    }

    /// Mean height, over an element's rays, of the elements within its part that it sees above its plane, metres.
    /// Elements outside the part, seen through the mouth of a gap, are ignored: they say nothing about the gap.
    double height_seen(std::uint32_t i) const {
        const Patch& patch = tree_.patch(numbering_.leaves[i]);
        const Normal n = patch.normal();
        double sum = 0;
        std::size_t met = 0;
        for (std::uint32_t j : flow_.rows.hits(i))
            if (j != RayRows::missed && within_[j])
                sum += std::max(0.0, dot(n, tree_.patch(numbering_.leaves[j]).centre() - patch.centre())), ++met;
        return met > 0 ? sum / static_cast<double>(met) : std::sqrt(flow_.area[i]);
    }

    void sort() {
        std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.area > b.area; });
    }

    /// Parts between which no light passes. Those that cannot be rooms are added to the largest part.
    std::vector<Part> joined_by_light() {
        const std::size_t n = flow_.area.size();
        DisjointSets sets(n);
        std::uint32_t under_sky = RayRows::missed;
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j : flow_.rows.hits(i))
                if (j != RayRows::missed) sets.unite(i, j);
            if (flow_.to_sky[i] == 0) continue;
            if (under_sky != RayRows::missed) sets.unite(i, under_sky);
            under_sky = i;
        }
        std::vector<LeafNumbers> by_root(n);
        for (std::uint32_t i = 0; i < n; ++i) by_root[sets.root(i)].push_back(i);
        Part outer;
        std::vector<Part> out;
        for (LeafNumbers& leaves : by_root) {
            if (leaves.empty()) continue;
            Part part = part_of(std::move(leaves));
            part.may_be_room() ? out.push_back(std::move(part)) : outer.add(part);
        }
        std::stable_sort(out.begin(), out.end(), [](const Part& a, const Part& b) { return a.area < b.area; });
        if (out.empty()) {
            // the scene is a ground, with or without objects on it
            if (has_sky_) total_ = outer.area, whole_ = outer.box;
            return {std::move(outer)};
        }
        spaces_ = count_spaces(out);
        out.back().add(outer);
        for (std::size_t k = 0; k < out.size(); ++k) {
            for (std::uint32_t i : out[k].leaves) flow_.part[i] = static_cast<std::uint16_t>(std::min(k, max_rooms));
            if (k + 1 < out.size()) inner_.add(out[k].box.lo), inner_.add(out[k].box.hi);
        }
        fresh_ = static_cast<std::uint16_t>(std::min(out.size(), max_rooms) + 1);
        total_ = outer.area;
        for (const Part& part : out) total_ += part.area;
        whole_ = out.back().box;
        for (const Part& part : out) whole_.add(part.box.lo), whole_.add(part.box.hi);
        return out;
    }

    /// True if at least four walls lie entirely within a part. A pocket between intersecting polygons has no such
    /// walls, even if it is split into many elements.
    bool has_own_walls(const Part& part) const {
        const auto region_of = [&](std::uint32_t i) { return tree_.region(numbering_.leaves[i]).value; };
        std::unordered_map<std::uint32_t, std::ptrdiff_t> outside;  // number of leaves of each wall outside the part
        for (const std::uint32_t i : part.leaves) --outside[region_of(i)];
        for (std::uint32_t i = 0; i < flow_.area.size(); ++i)
            if (const auto at = outside.find(region_of(i)); at != outside.end()) ++at->second;
        const auto own =
            std::count_if(outside.begin(), outside.end(), [](const auto& wall) { return wall.second == 0; });
        return own >= static_cast<std::ptrdiff_t>(min_walls);
    }

    /// True if the sky is above a part. Such a part is judged separately, independent of its shape and size.
    bool is_outdoors(const Part& part) const {
        double to_sky = 0;
        for (const std::uint32_t i : part.leaves) to_sky += flow_.area[i] * share_to_sky(flow_, i);
        return has_sky_ && to_sky >= outdoors * part.area;
    }

    /// True if a part is large enough to be a room of its own.
    bool counts(const Part& part) const {
        if (!part.may_be_room()) return false;
        if (part.area >= min_room_share * total_) return true;
        if (static_cast<double>(part.leaves.size()) < min_detail * static_cast<double>(flow_.area.size())) return false;
        if (!has_own_walls(part)) return false;
        if (has_sky_ && part.area >= min_room_share * indoor_area_) return true;
        Box inner = inner_;
        inner.add(part.box.lo), inner.add(part.box.hi);
        return whole_.diagonal() >= far_larger * inner.diagonal();
    }

    /// Moves the elements behind an opening from `part` to `rest`; returns false if there is no opening.
    bool cut_at_opening(Part& part, Part& rest) {
        const std::uint16_t own = flow_.part[part.leaves[0]];
        const std::optional<OpeningBetween> opening = find_opening(flow_, part.leaves, own);
        if (!opening) return false;
        Part small = part_of(opening->small), large = part_of(opening->large);
        const bool room_is_large = is_outdoors(small) && !is_outdoors(large);
        const Part& room = room_is_large ? large : small;
        if (!counts(room)) return false;
        inner_.add(room.box.lo), inner_.add(room.box.hi);
        for (std::uint32_t i : small.leaves) flow_.part[i] = fresh_;
        ++fresh_;
        part = std::move(large), rest = std::move(small);
        return true;
    }

    double count_spaces(const std::vector<Part>& parts) const;
    std::vector<std::uint8_t> blind_leaves() const;
    void place_blind_leaves();
    const Part* smallest_indoors() const;
    void join(std::size_t number);

    const Scene& scene_;
    Flow flow_;
    const ElementTree& tree_;
    const LeafNumbering& numbering_;
    bool has_sky_;
    std::vector<Part> parts_;
    std::vector<std::uint8_t> within_;  ///< For every leaf, 1 while it belongs to the part that is being made.
    Box inner_, whole_;                 ///< Bounds of all rooms but the largest, and of the whole scene.
    double total_ = 0;                  ///< Area of the scene, m^2.
    double spaces_ = 1;                 ///< See `LightRooms::spaces`.
    double indoor_area_ = 0;            ///< Area of the elements that see little of the sky, m^2.
    std::uint16_t fresh_ = 1;           ///< Number of the next part.
};

/// Returns `LightRooms::spaces` of parts between which no light passes. Dark ones, such as the insides of furniture and
/// the space between thick walls, do not count, nor do the outdoors.
double RoomFinder::count_spaces(const std::vector<Part>& parts) const {
    const auto emits = [&](std::uint32_t i) {
        return scene_.materials()[scene_.regions()[tree_.region(numbering_.leaves[i])].material].emits();
    };
    double sum = 0, squares = 0;  // m^2, m^4
    for (const Part& part : parts) {
        const bool is_lit = !scene_.lights().empty() || std::any_of(part.leaves.begin(), part.leaves.end(), emits);
        if (is_lit && !is_outdoors(part)) sum += part.area, squares += part.area * part.area;
    }
    return squares > 0 ? sum * sum / squares : 1;
}

/// For every leaf, 1 if none of its rays hits a front or reaches a sky.
std::vector<std::uint8_t> RoomFinder::blind_leaves() const {
    std::vector<std::uint8_t> out(numbering_.leaves.size());
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::span<const std::uint32_t> seen = flow_.rows.hits(i);
        const bool meets_no_front =
            std::all_of(seen.begin(), seen.end(), [](std::uint32_t j) { return j == RayRows::missed; });
        out[i] = meets_no_front && flow_.to_sky[i] == 0 ? 1 : 0;
    }
    return out;
}

/// Assigns leaves without visible fronts to parts. No ray from below a lamp on a shelf hits a front, but light of the
/// room enters at the edges. Such a leaf joins the part of the largest other leaf in the smallest inner element that
/// contains both, or in their region. If there is none, no light reaches the leaf, and it joins the largest part.
void RoomFinder::place_blind_leaves() {
    struct Largest {
        double area = 0;
        std::uint16_t part = 0;

        void add(const Largest& other) {
            if (other.area > area) *this = other;
        }
    };
    const std::vector<std::uint8_t> blind = blind_leaves();
    const std::uint16_t largest_part = flow_.part[parts_.front().leaves.front()];
    Field<ElementId, Largest> below(tree_.size());
    std::unordered_map<std::uint32_t, Largest> of_region;
    for (std::size_t i = 0; i < numbering_.leaves.size(); ++i)
        if (!blind[i]) below[numbering_.leaves[i]] = {flow_.area[i], flow_.part[i]};
    for (std::size_t k = tree_.size(); k-- > 0;) {  // children before parents
        const ElementId e(k), parent = tree_.parent(e);
        (parent.is_none() ? of_region[tree_.region(e).value] : below[parent]).add(below[e]);
    }
    for (std::size_t i = 0; i < numbering_.leaves.size(); ++i) {
        if (!blind[i]) continue;
        ElementId e = numbering_.leaves[i];
        while (!e.is_none() && below[e].area == 0) e = tree_.parent(e);
        const Largest& found = e.is_none() ? of_region[tree_.region(numbering_.leaves[i]).value] : below[e];
        flow_.part[i] = found.area > 0 ? found.part : largest_part;
    }
    std::vector<LeafNumbers> leaves(fresh_);
    for (std::uint32_t i = 0; i < flow_.part.size(); ++i) leaves[flow_.part[i]].push_back(i);
    parts_.clear();
    for (LeafNumbers& of_part : leaves)
        if (!of_part.empty()) parts_.push_back(part_of(std::move(of_part)));
    sort();
}

/// The smallest part that is not outdoors; null if there is none.
const Part* RoomFinder::smallest_indoors() const {
    const auto at = std::find_if(parts_.rbegin(), parts_.rend(), [&](const Part& part) { return !is_outdoors(part); });
    return at == parts_.rend() ? nullptr : &*at;
}

/// Merges a part with the other part that it exchanges most light with.
void RoomFinder::join(std::size_t number) {
    const Part small = std::move(parts_[number]);
    parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(number));
    const std::uint16_t own = flow_.part[small.leaves[0]];
    std::vector<double> to(fresh_);
    for (std::uint32_t i : small.leaves)
        for (std::uint32_t j : flow_.rows.hits(i))
            if (j != RayRows::missed && flow_.part[j] != own)
                to[flow_.part[j]] += flow_.area[i] / static_cast<double>(flow_.rows.hits(i).size());
    const auto most = std::max_element(parts_.begin(), parts_.end(), [&](const Part& a, const Part& b) {
        return to[flow_.part[a.leaves[0]]] < to[flow_.part[b.leaves[0]]];
    });
    for (std::uint32_t i : small.leaves) flow_.part[i] = flow_.part[most->leaves[0]];
    most->add(small);
    sort();
}

}  // namespace

RoomLeaves find_room_leaves(const CoarseElements& in, std::uint64_t seed, const StopRequest& stop) {
    const auto find = [&] { return RoomFinder(in, seed).find(stop); };
    if (processes() == 1) return find();
    // Each step depends on the one before, so the first process does all and sends the result.
    RoomLeaves found;
    ArchiveWriter writer;
    if (is_first_process()) found = find(), writer(found.rooms, found.spaces);
    const std::string bytes = as_first(writer.take(), "rooms");
    ArchiveReader reader(bytes);
    reader(found.rooms, found.spaces);
    EXI_CHECK(reader.good() && reader.left() == 0);
    return found;
}

}  // namespace exitance
