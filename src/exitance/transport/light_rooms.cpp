#include "exitance/transport/light_rooms.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "exitance/core/disjoint_sets.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/core/random.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {
namespace {

constexpr double widest_opening = 0.1;  ///< Of the smaller room's walls.
constexpr double narrower = 0.5;        ///< An opening, than cuts on either side of it.
constexpr double beside = 0.2;          ///< Of the smaller room's walls: how far off these are.
constexpr double least_share = 0.05;    ///< Of a room in what is no ground or sky.
constexpr double least_detail = 0.001;  ///< Of a small room beside ground and sky in all elements.
constexpr double far_larger = 20;       ///< Ground and sky than all else, from corner to corner.
constexpr double flattest = 0.1;        ///< A room's height by its length; below, it is a gap.
constexpr double thinnest = 0.03;       ///< How far off what walls see is, by the root of their area; likewise.
constexpr int steps =
    60;  ///< Of light to and fro, half of which stays: what an opening of a twentieth joins differs by a third still.
constexpr std::size_t fewest_walls = 4;  ///< Of a room.
constexpr std::size_t most_rooms = 64;

using Leaves = std::vector<std::uint32_t>;

/// Coarse elements, and which of them light joins.
struct Flow {
    const RayRows& rows;
    std::vector<double> area;
    std::vector<double> start;        ///< What differs from room to room as a rule.
    std::vector<std::uint16_t> part;  ///< Of the scene that a leaf is in, so far.
    bool has_sky = false;             ///< What meets nothing is joined by the sky, as if that were a wall.
};

/// By place: rooms lie apart from, or within one another; and a little by chance.
std::vector<double> starting_light(const ElementTree& tree, const LeafNumbering& numbering, std::uint64_t seed) {
    constexpr Vec3 along{0.73, 0.54, 0.42};  // no direction that people build in
    constexpr double chance = 0.1;
    Box box;
    for (ElementId root : tree.roots()) box.add(tree.patch(root).centre());
    std::vector<double> out;
    for (std::size_t i = 0; i < numbering.leaves.size(); ++i) {
        const Vec3 d = (tree.patch(numbering.leaves[i]).centre() - box.centre()) / std::max(box.diagonal(), 1e-300);
        out.push_back(dot(d, along) + norm(d) + chance * static_cast<double>(hash(seed, i) >> 11) * 0x1p-53);
    }
    return out;
}

/// Of what leaves send to the sky.
double mean_towards_sky(const Flow& flow, const Leaves& leaves, const std::vector<double>& x) {
    double sum = 0, all = 0;
    for (std::uint32_t i : leaves) {
        const auto hits = flow.rows.hits(i);
        const auto lost = static_cast<double>(std::count(hits.begin(), hits.end(), RayRows::missed));
        const double sent = flow.area[i] * lost / static_cast<double>(hits.size());
        sum += sent * x[i], all += sent;
    }
    return all > 0 ? sum / all : 0;
}

/// What is left of light that differs from place to place after it has gone to and fro within a part.
std::vector<double> slow_difference(const Flow& flow, const Leaves& leaves, std::uint16_t part) {
    std::vector<double> x = flow.start, next(flow.area.size());
    for (int step = 0; step < steps; ++step) {
        const double sky = flow.has_sky ? mean_towards_sky(flow, leaves, x) : 0;
        parallel_for(leaves.size(), 256, [&](std::size_t k) {
            const std::uint32_t i = leaves[k];
            double sum = 0;
            std::size_t met = 0;
            for (std::uint32_t j : flow.rows.hits(i)) {
                if (j != RayRows::missed && flow.part[j] == part) sum += x[j], ++met;
                if (j == RayRows::missed && flow.has_sky) sum += sky, ++met;
            }
            next[i] = met > 0 ? 0.5 * (x[i] + sum / static_cast<double>(met)) : x[i];
        });
        double mean = 0, area = 0, largest = 0;
        for (std::uint32_t i : leaves) mean += flow.area[i] * next[i], area += flow.area[i];
        for (std::uint32_t i : leaves) x[i] = next[i] - mean / area, largest = std::max(largest, std::abs(x[i]));
        for (std::uint32_t i : leaves) x[i] /= largest > 0 ? largest : 1;
    }
    return x;
}

/// The opening between the first leaves of an order and the others, m^2, after each of them; by what the leaves on the
/// smaller side see of the other: few rays from the larger one say little.
struct Cuts {
    std::vector<double> area, opening;  ///< Of the first k + 1 leaves.
};

Cuts sweep(const Flow& flow, const Leaves& order, std::uint16_t part) {
    std::vector<std::uint32_t> rank(flow.area.size());
    for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<std::uint32_t>(k);
    const std::size_t n = order.size();
    // Light that a leaf sends to one of higher (lower) rank crosses all cuts in between; what meets nothing leaves by
    // an opening, too.
    std::vector<double> up(n + 1), down(n + 1), lost(n);
    double all_lost = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const auto hits = flow.rows.hits(order[k]);
        const double each = flow.area[order[k]] / static_cast<double>(hits.size());
        for (std::uint32_t j : hits) {
            if (j == RayRows::missed) lost[k] += each;
            if (j == RayRows::missed || flow.part[j] != part) continue;
            const std::size_t other = rank[j];
            if (other > k) up[k] += each, up[other] -= each;
            if (other < k) down[other] += each, down[k] -= each;
        }
        // What sees nothing at all is covered, not outdoors.
        if (std::count(hits.begin(), hits.end(), RayRows::missed) == std::ssize(hits)) lost[k] = 0;
        all_lost += lost[k];
    }
    Cuts out{std::vector<double>(n), std::vector<double>(n)};
    double area = 0, total = 0, u = 0, d = 0, lost_below = 0;
    for (std::uint32_t i : order) total += flow.area[i];
    for (std::size_t k = 0; k < n; ++k) {
        area += flow.area[order[k]], u += up[k], d += down[k], lost_below += lost[k];
        out.area[k] = area;
        out.opening[k] = 2 * area <= total ? u + lost_below : d + all_lost - lost_below;
    }
    return out;
}

/// Elements that light joins, and what they enclose.
struct Part {
    Leaves leaves;
    double area = 0;    ///< m^2
    double volume = 0;  ///< Areas times how high what they see is above them, m^3.
    Box box;

    void add(const Part& other) {
        if (other.leaves.empty()) return;
        leaves.insert(leaves.end(), other.leaves.begin(), other.leaves.end());
        area += other.area;
        volume += other.volume;
        box.add(other.box.lo), box.add(other.box.hi);
    }
    /// Not so a gap, several gaps, or a single wall.
    bool may_be_room() const {
        const Vec3 size = box.size();
        return leaves.size() >= fewest_walls && volume >= thinnest * std::pow(area, 1.5) &&
               std::min({size.x, size.y, size.z}) >= flattest * std::max({size.x, size.y, size.z});
    }
};

/// Splits a scene into parts.
class RoomFinder {
  public:
    RoomFinder(const RayRows& rows, const ElementTree& tree, const LeafNumbering& numbering, std::uint64_t seed,
               bool has_sky)
        : flow_{rows, leaf_areas(tree, numbering), starting_light(tree, numbering, seed),
                std::vector<std::uint16_t>(numbering.leaves.size()), has_sky},
          tree_(tree),
          numbering_(numbering) {}

    /// The rooms, the largest first; each leaf in one of them.
    std::vector<Part> find(const StopRequest& stop) {
        std::vector<Part> open = joined_by_light();
        while (!open.empty() && parts_.size() + open.size() < most_rooms && !stop.requested()) {
            Part part = std::move(open.back());
            open.pop_back();
            Part rest;
            if (cut_at_opening(part, rest))
                open.push_back(std::move(part)), open.push_back(std::move(rest));
            else
                parts_.push_back(std::move(part));
        }
        for (Part& part : open) parts_.push_back(std::move(part));
        sort();
        while (parts_.size() > 1 && !counts(parts_.back())) join_smallest();
        return std::move(parts_);
    }

  private:
    Part part_of(Leaves leaves) const {
        Part part;
        part.leaves = std::move(leaves);
        std::vector<std::uint8_t> within(flow_.area.size());
        for (std::uint32_t i : part.leaves) within[i] = 1;
        for (std::uint32_t i : part.leaves) {
            part.area += flow_.area[i];
            part.volume += flow_.area[i] * height_seen(i, within);
            for (const Point& p : tree_.outline(numbering_.leaves[i])) part.box.add(p);
        }
        return part;
    }

    /// How high the elements of a part that one of them sees are above its plane, on average over its rays, metres. Of
    /// what gaps see through their mouths some is far away, but says nothing of the gaps.
    double height_seen(std::uint32_t i, const std::vector<std::uint8_t>& within) const {
        const Patch& patch = tree_.patch(numbering_.leaves[i]);
        const Normal n = patch.normal();
        double sum = 0;
        std::size_t met = 0;
        for (std::uint32_t j : flow_.rows.hits(i))
            if (j != RayRows::missed && within[j])
                sum += std::max(0.0, dot(n, tree_.patch(numbering_.leaves[j]).centre() - patch.centre())), ++met;
        return met > 0 ? sum / static_cast<double>(met) : std::sqrt(flow_.area[i]);
    }

    void sort() {
        std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.area > b.area; });
    }

    /// What no light joins is apart from the beginning; what cannot be a room belongs to the largest of these.
    std::vector<Part> joined_by_light() {
        const std::size_t n = flow_.area.size();
        DisjointSets sets(n);
        std::uint32_t under_sky = RayRows::missed;
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j : flow_.rows.hits(i)) {
                if (j != RayRows::missed) sets.unite(i, j);
                if (j != RayRows::missed || !flow_.has_sky) continue;
                if (under_sky != RayRows::missed) sets.unite(i, under_sky);
                under_sky = i;
            }
        std::vector<Leaves> by_root(n);
        for (std::uint32_t i = 0; i < n; ++i) by_root[sets.root(i)].push_back(i);
        Part outer;
        std::vector<Part> out;
        for (Leaves& leaves : by_root) {
            if (leaves.empty()) continue;
            Part part = part_of(std::move(leaves));
            part.may_be_room() ? out.push_back(std::move(part)) : outer.add(part);
        }
        std::stable_sort(out.begin(), out.end(), [](const Part& a, const Part& b) { return a.area < b.area; });
        if (out.empty()) {
            if (flow_.has_sky) total_ = outer.area, whole_ = outer.box;  // ground, with or without anything on it
            return {std::move(outer)};
        }
        out.back().add(outer);
        for (std::size_t k = 0; k < out.size(); ++k) {
            for (std::uint32_t i : out[k].leaves) flow_.part[i] = static_cast<std::uint16_t>(std::min(k, most_rooms));
            if (k + 1 < out.size()) inner_.add(out[k].box.lo), inner_.add(out[k].box.hi);
        }
        fresh_ = static_cast<std::uint16_t>(std::min(out.size(), most_rooms) + 1);
        total_ = outer.area;
        for (const Part& part : out) total_ += part.area;
        whole_ = out.back().box;
        for (const Part& part : out) whole_.add(part.box.lo), whole_.add(part.box.hi);
        return out;
    }

    /// Has a part its share in the area that is no ground or sky?
    bool counts(const Part& part) const {
        if (!part.may_be_room()) return false;
        if (part.area >= least_share * total_) return true;
        if (static_cast<double>(part.leaves.size()) < least_detail * static_cast<double>(flow_.area.size()))
            return false;
        Box inner = inner_;
        inner.add(part.box.lo), inner.add(part.box.hi);
        return whole_.diagonal() >= far_larger * inner.diagonal();
    }

    /// Moves what lies behind an opening from `part` to `rest`, if there is one.
    bool cut_at_opening(Part& part, Part& rest) {
        const std::uint16_t own = flow_.part[part.leaves[0]];
        Leaves order = part.leaves;
        const std::vector<double> x = slow_difference(flow_, order, own);
        std::sort(order.begin(), order.end(), [&](auto i, auto j) { return x[i] != x[j] ? x[i] < x[j] : i < j; });
        const Cuts cuts = sweep(flow_, order, own);
        const std::size_t cut = find_opening(cuts);
        if (cut == 0) return false;
        const bool first_is_small = 2 * cuts.area[cut - 1] <= cuts.area.back();
        const auto middle = order.begin() + static_cast<std::ptrdiff_t>(cut);
        Part first = part_of({order.begin(), middle}), second = part_of({middle, order.end()});
        Part &small = first_is_small ? first : second, &large = first_is_small ? second : first;
        if (!counts(small)) return false;
        inner_.add(small.box.lo), inner_.add(small.box.hi);
        for (std::uint32_t i : small.leaves) flow_.part[i] = fresh_;
        ++fresh_;
        part = std::move(large), rest = std::move(small);
        return true;
    }

    /// After how many leaves of an order to cut it, so that most lies behind the opening; 0: there is none.
    static std::size_t find_opening(const Cuts& cuts) {
        const std::size_t n = cuts.area.size();
        const double total = cuts.area.back();
        std::size_t best = 0;
        double most = 0;
        for (std::size_t k = 0; k + 1 < n; ++k) {
            const double smaller = std::min(cuts.area[k], total - cuts.area[k]);
            if (smaller <= most || cuts.opening[k] >= widest_opening * smaller || !is_narrow(cuts, k, smaller))
                continue;
            best = k + 1, most = smaller;
        }
        return best;
    }

    /// Is the cut narrower than those beside it? Along a corridor all are alike.
    static bool is_narrow(const Cuts& cuts, std::size_t k, double smaller) {
        for (const double off : {-beside, beside}) {
            const auto at = std::lower_bound(cuts.area.begin(), cuts.area.end(), cuts.area[k] + off * smaller);
            const auto other = static_cast<std::size_t>(at - cuts.area.begin());
            if (other + 1 < cuts.area.size() && other != k && cuts.opening[other] * narrower < cuts.opening[k])
                return false;
        }
        return true;
    }

    void join_smallest();

    Flow flow_;
    const ElementTree& tree_;
    const LeafNumbering& numbering_;
    std::vector<Part> parts_;
    Box inner_, whole_;  ///< Around all rooms but the largest, and around everything.
    double total_ = 0;
    std::uint16_t fresh_ = 1;  ///< Number of the next part.
};

/// Joins a part to the one that it exchanges most light with.
void RoomFinder::join_smallest() {
    const Part& small = parts_.back();
    const std::uint16_t own = flow_.part[small.leaves[0]];
    std::vector<double> to(fresh_);
    for (std::uint32_t i : small.leaves)
        for (std::uint32_t j : flow_.rows.hits(i))
            if (j != RayRows::missed && flow_.part[j] != own)
                to[flow_.part[j]] += flow_.area[i] / static_cast<double>(flow_.rows.hits(i).size());
    const auto most = std::max_element(parts_.begin(), parts_.end() - 1, [&](const Part& a, const Part& b) {
        return to[flow_.part[a.leaves[0]]] < to[flow_.part[b.leaves[0]]];
    });
    for (std::uint32_t i : small.leaves) flow_.part[i] = flow_.part[most->leaves[0]];
    most->add(small);
    parts_.pop_back();
    sort();
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

/// What areas of coarse elements count by themselves, and by what they send elsewhere: i counts w_i A_i, and F_ij of
/// its light comes from j.
void LightRooms::weigh(const ElementTree& tree, const LeafNumbering& numbering, const RayRows& rows) {
    const std::size_t n = numbering.leaves.size();
    std::vector<double> sent(n);
    for (std::size_t i = 0; i < n; ++i) {
        const ElementId e = numbering.leaves[i];
        const std::span<const std::uint32_t> hits = rows.hits(i);
        const double each = mean_area_ / areas_[room_of_[e]] * tree.area(e) / static_cast<double>(hits.size());
        for (std::uint32_t j : hits)
            if (j != RayRows::missed && room_of_[numbering.leaves[j]] != room_of_[e]) sent[j] += each;
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
    constexpr std::size_t elements = 600;  // beyond those that the pieces are
    const std::vector<Piece> pieces = stage.lit_pieces();
    auto tree = std::make_shared<const ElementTree>(
        stage.make_elements({edge_for_elements(pieces, pieces.size() + elements), 0}));
    auto locator = std::make_shared<const ElementLocator>(*tree, stage.scene.regions().size());
    const LeafNumbering numbering(*tree);
    const RayRows rows(stage, *tree, numbering, *locator,
                       {.average = 24, .least = 16, .most = 256, .front_alone = true}, seed);
    const DistantLight& outside = stage.scene.distant();
    const bool has_sky = !outside.domes.empty();
    const std::vector<Part> parts = RoomFinder(rows, *tree, numbering, seed, has_sky).find(stop);
    LightRooms out;
    out.lost_.resize(tree->size());
    const std::vector<double> kept = rows.kept();
    for (std::size_t i = 0; i < kept.size(); ++i) out.lost_[numbering.leaves[i]] = static_cast<float>(1 - kept[i]);
    if (parts.size() < 2 || stop.requested()) {
        out.tree_ = std::move(tree), out.locator_ = std::move(locator);
        return out;
    }
    out.room_of_.resize(tree->size());
    for (std::size_t room = 0; room < parts.size(); ++room) {
        out.areas_.push_back(parts[room].area);
        out.mean_area_ += parts[room].area / static_cast<double>(parts.size());
        for (std::uint32_t i : parts[room].leaves) out.room_of_[numbering.leaves[i]] = static_cast<std::uint16_t>(room);
    }
    out.weigh(*tree, numbering, rows);
    out.tree_ = std::move(tree), out.locator_ = std::move(locator);
    return out;
}

}  // namespace exitance
