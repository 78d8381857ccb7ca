#include "exitance/scene/joining/edge_pairs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/scene/joining/cell_keys.hpp"
#include "exitance/scene/joining/hash_chains.hpp"

namespace exitance {
namespace {

/// Cell sizes for lines: of the coordinates of their direction, and of their position as a share of the scene's size
/// (find_extent).
constexpr double direction_cell = 1e-3, place_cell = 1e-4;
constexpr double max_direction_error =  ///< Radians: edges with a larger error of direction are not matched by line.
    1.0 / 16;
constexpr unsigned grades = 8;  ///< Number of cell sizes, see EdgePairs::grade.
/// Direction that distinguishes the two directions of a line and the two sides of a plane. No line of a practical scene
/// is perpendicular to it.
constexpr Vec3 forward{0.5377, 0.7323, 0.4181};
/// Limits on overlapping edges at one position of a line, and on the edges joined to one edge. Only stacks of
/// overlapping faces in one plane exceed them, and which of these faces are joined does not affect the light.
constexpr std::size_t max_open = 128, max_partners = 8;

}  // namespace

EdgePairs::EdgePairs(const FaceMesh& mesh, const Tolerances& tolerances, std::span<const std::uint32_t> faces)
    : mesh_(mesh), tol_(tolerances), faces_(faces), sets_(faces_.size()) {
    std::size_t count = 0;
    for (std::uint32_t f : faces_) count += mesh_.outline(f).size();
    edges_.reserve(count), first_edge_.reserve(faces_.size() + 1);
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        const auto outline = mesh_.outline(faces_[f]);
        first_edge_.push_back(static_cast<std::uint32_t>(edges_.size()));
        for (std::size_t k = 0; k < outline.size(); ++k)
            edges_.push_back({outline[k], outline[(k + 1) % outline.size()], f, none, none});
    }
    first_edge_.push_back(static_cast<std::uint32_t>(edges_.size()));
    pair_whole_edges();
    find_extent();
    pair_parts_of_edges();
}

std::span<const EdgePairs::Split> EdgePairs::splits(std::uint32_t e) const {
    const auto first = std::ranges::lower_bound(splits_, e, {}, &Split::edge);
    const auto last = std::ranges::upper_bound(first, splits_.end(), e, {}, &Split::edge);
    return {first, last};
}

/// True if two faces have the same orientation and the smaller one lies in the larger one's plane. Slivers have no
/// accurate normal, so that within `tol_.place` only the distance counts.
bool EdgePairs::coplanar(std::uint32_t f, std::uint32_t g) const {
    if (f == g) return true;
    Vec3 a = mesh_.area_vector[faces_[f]], b = mesh_.area_vector[faces_[g]];
    if (dot(a, b) <= 0) return false;
    if (squared_norm(a) < squared_norm(b)) std::swap(a, b), std::swap(f, g);
    const Normal n = normalized(a);
    const Point& origin = point(mesh_.outline(faces_[f])[0]);
    double far = 0;
    for (std::uint32_t c : mesh_.outline(faces_[g])) far = std::max(far, std::abs(dot(n, point(c) - origin)));
    return far <= tol_.place || (far <= tol_.plane && norm(cross(n, normalized(b))) <= tol_.tilt);
}

void EdgePairs::pair_whole_edges() {
    HashChains chains(edges_.size());
    const auto key_of = [&](std::uint32_t e) {
        const auto [a, b] = std::minmax(edges_[e].from, edges_[e].to);
        return hash(a, b);
    };
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        if (e + HashChains::ahead < edges_.size()) chains.prefetch(key_of(e + HashChains::ahead));
        const std::uint64_t key = key_of(e);
        for (std::uint32_t o = chains.first(key); o != HashChains::end; o = chains.next(o)) {
            const bool against = edges_[o].from == edges_[e].to && edges_[o].to == edges_[e].from;
            const bool along = edges_[o].from == edges_[e].from && edges_[o].to == edges_[e].to;
            if ((against || along) && edges_[e].twin == none) edges_[e].twin = o;
            if (!against || edges_[o].partner != none) continue;
            const std::uint32_t f = edges_[e].face, g = edges_[o].face;
            if (material(f) != material(g) || !coplanar(f, g)) continue;
            edges_[e].partner = o;
            edges_[o].partner = e;
            sets_.unite(f, g);
            break;
        }
        chains.add(key);
    }
}

/// Sets centre_ and size_ to the centre and the extent of the edges, without the outer 1/32 at either end of each axis.
/// Otherwise a few distant points would make all other lines fall into few cells.
void EdgePairs::find_extent() {
    constexpr std::size_t samples = 4096;
    const std::size_t step = edges_.size() / samples + 1;
    std::vector<double> at;
    Vec3 reach{0, 0, 0};
    for (std::size_t a = 0; a < 3; ++a) {
        at.clear();
        for (std::size_t e = 0; e < edges_.size(); e += step) at.push_back(point(edges_[e].from)[a]);
        std::sort(at.begin(), at.end());
        const std::size_t skipped = at.size() / 32;
        centre_[a] = 0.5 * (at[skipped] + at[at.size() - 1 - skipped]);
        reach[a] = at[at.size() - 1 - skipped] - at[skipped];
    }
    size_ = norm(reach);
    if (size_ > 0) return;
    Box box;
    for (const Edge& e : edges_) box.add(point(e.from));
    size_ = box.diagonal();
}

EdgePairs::LineErrors EdgePairs::line_errors(std::uint32_t edge) const {
    const Point &p = point(edges_[edge].from), &q = point(edges_[edge].to);
    const double direction = 2 * tol_.place / norm(q - p);
    return {direction, tol_.place + std::max(norm(p - centre_), norm(q - centre_)) * direction};
}

/// Index of the smallest cell size for which the error of an edge's line is at most an eighth of a cell. Each grade is
/// eight times as coarse as the previous one. Nearly all edges have grade 0; others are short compared with the scene.
unsigned EdgePairs::grade(std::uint32_t edge) const {
    const auto [direction, foot] = line_errors(edge);
    unsigned grade = 0;
    for (double cell = 1; grade + 1 < grades; cell *= 8, ++grade)
        if (8 * direction <= cell * direction_cell && 8 * foot <= cell * place_cell * size_) break;
    return grade;
}

/// Calls take(key) for the line through an edge, keyed by cells of its direction and of its point nearest to the
/// centre. Near the wall of a cell the neighbour's key is passed as well, so that edges on one line always have a key
/// in common.
template <class Take>
void EdgePairs::each_line_key(std::uint32_t edge, unsigned grade, const Take& take) const {
    const Point& p = point(edges_[edge].from);
    Vec3 d = normalized(point(edges_[edge].to) - p);
    const double coarser = std::ldexp(1.0, 3 * static_cast<int>(grade));
    if (dot(d, forward) < 0) d = -d;
    const Vec3 foot = (p - centre_) - dot(p - centre_, d) * d;
    const LineErrors error = line_errors(edge);
    const auto direction = [&](double x) { return CellCoordinate{x, coarser * direction_cell, error.direction}; };
    const auto place = [&](double x) { return CellCoordinate{x, coarser * place_cell * size_, error.foot}; };
    each_cell_key<6>(
        grade, {direction(d.x), direction(d.y), direction(d.z), place(foot.x), place(foot.y), place(foot.z)}, take);
}

/// Records the ends of `other` that are in the interior of edge e, whose unit direction is d.
void EdgePairs::split_at_ends(std::uint32_t e, std::uint32_t other, const Vec3& d, double length) {
    for (std::uint32_t corner : {edges_[other].from, edges_[other].to}) {
        const double at = dot(point(corner) - point(edges_[e].from), d);
        if (at > tol_.place && at < length - tol_.place) splits_.push_back({e, at, corner});
    }
}

/// Pairs two edges of one line if they have opposite directions and overlap, and their faces are coplanar. Returns
/// whether it did.
bool EdgePairs::pair_parts(std::uint32_t e, std::uint32_t f) {
    if (material(edges_[e].face) != material(edges_[f].face)) return false;
    const Point &p = point(edges_[e].from), &r = point(edges_[f].from);
    const Vec3 a = point(edges_[e].to) - p, b = point(edges_[f].to) - r;
    const double length = norm(a);
    if (dot(a, b) >= 0) return false;
    const Vec3 d = a / length;
    const Vec3 w0 = r - p, w1 = point(edges_[f].to) - p;
    const double t0 = dot(w0, d), t1 = dot(w1, d);
    if (std::min(length, t0) - std::max(0.0, t1) <= 2 * tol_.place) return false;
    const double off = std::max(squared_norm(w0 - t0 * d), squared_norm(w1 - t1 * d));
    if (off > tol_.place * tol_.place || !coplanar(edges_[e].face, edges_[f].face)) return false;
    sets_.unite(edges_[e].face, edges_[f].face);
    split_at_ends(e, f, d, length);
    split_at_ends(f, e, normalized(b), norm(b));
    return true;
}

/// Mean number of intervals that cover a point.
double EdgePairs::crowding(const std::vector<Interval>& intervals) {
    double lo = HUGE_VAL, hi = -HUGE_VAL, covered = 0;
    for (const Interval& i : intervals) {
        lo = std::min(lo, i.lo), hi = std::max(hi, i.hi);
        covered += i.hi - i.lo;
    }
    return covered / (hi - lo);
}

std::vector<EdgePairs::Interval> EdgePairs::intervals_along(const Vec3& d, std::span<const std::uint32_t> group) const {
    const Point origin = point(edges_[group[0]].from);
    std::vector<Interval> out;
    for (const std::uint32_t e : group) {
        const double s = dot(point(edges_[e].from) - origin, d), t = dot(point(edges_[e].to) - origin, d);
        const bool against = dot(point(edges_[e].to) - point(edges_[e].from), forward) < 0;
        const bool behind = dot(mesh_.area_vector[faces_[edges_[e].face]], forward) < 0;
        out.push_back({std::min(s, t) - tol_.place, std::max(s, t) + tol_.place, e, against, behind});
    }
    return out;
}

/// Pairs the edges on one line, and those that only share its cell, by a sweep along the line. For edges that are short
/// compared with the scene the line is so uncertain that a cell may contain whole rows of them; those are swept along a
/// coordinate axis that separates them better.
void EdgePairs::pair_on_line(std::span<const std::uint32_t> group) {
    // most lines have only the two edges of a box's corner, for which sorting is slower
    constexpr std::size_t max_direct = 8;
    if (group.size() <= max_direct) {
        for (std::size_t i = 0; i < group.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) pair_parts(group[j], group[i]);
        return;
    }
    const Edge& first = edges_[group[0]];
    std::vector<Interval> intervals = intervals_along(normalized(point(first.to) - point(first.from)), group);
    constexpr double max_crowding = 32;
    if (double least = crowding(intervals); least > max_crowding)
        for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
            std::vector<Interval> other = intervals_along(axis, group);
            if (const double here = crowding(other); here < least) least = here, intervals = std::move(other);
        }
    std::sort(intervals.begin(), intervals.end(),
              [](const Interval& a, const Interval& b) { return a.lo != b.lo ? a.lo < b.lo : a.edge < b.edge; });
    // Open intervals by side of the face and direction of the edge: edges are only paired on one side and with opposite
    // directions.
    std::array<std::array<std::vector<Interval>, 2>, 2> open;
    for (const Interval& i : intervals) {
        const auto drop_ended = [&](std::vector<Interval>& some) {
            std::erase_if(some, [&](const Interval& o) { return o.hi <= i.lo; });
        };
        std::vector<Interval>&own = open[i.behind][i.against], &across = open[i.behind][!i.against];
        drop_ended(across);
        std::size_t partners = 0;
        for (std::size_t k = across.size(); k > 0 && partners < max_partners; --k)
            partners += pair_parts(across[k - 1].edge, i.edge);
        if (own.size() == max_open) drop_ended(own);
        if (own.size() < max_open) own.push_back(i);
    }
}

/// Appends the unpaired edges between the end points of `edge`, including itself.
void EdgePairs::add_unpaired_twins(std::uint32_t edge, std::vector<std::uint32_t>& out) const {
    for (std::uint32_t e = edge; e != none; e = edges_[e].twin)
        if (edges_[e].partner == none) out.push_back(e);
}

/// Unpaired edges with the keys of their lines. Of edges between the same two points, which pair_whole_edges has
/// compared, only the last is included. Edges that share no key with another edge are excluded by a table of counts
/// before anything is stored or sorted; most unpaired edges of curved surfaces are of this kind. Very short edges,
/// whose direction is too uncertain, are excluded too.
std::vector<EdgePairs::LineEntry> EdgePairs::line_entries() const {
    std::vector<char> stands(edges_.size(), true);
    for (const Edge& e : edges_)
        if (e.twin != none) stands[e.twin] = false;
    struct Entrant {
        std::uint32_t edge;
        unsigned grade;
    };
    std::vector<Entrant> entrants;
    std::array<bool, grades> is_there{};
    std::vector<std::uint32_t> twins;
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        if (!stands[e] || line_errors(e).direction > max_direction_error) continue;
        twins.clear();
        add_unpaired_twins(e, twins);
        if (twins.empty()) continue;
        entrants.push_back({e, grade(e)});
        is_there[entrants.back().grade] = true;
    }
    const auto each_entry = [&](const auto& take) {
        for (const auto [e, finest] : entrants)
            // Edges also get keys of coarser grades, to be compared with the shorter edges there.
            for (unsigned g = finest; g < grades; ++g)
                if (is_there[g])
                    each_line_key(e, g, [&, e = e](std::uint64_t key) {
                        take(LineEntry{static_cast<std::uint32_t>(key), e});
                    });
    };
    std::vector<std::uint8_t> held(std::bit_ceil(4 * entrants.size() + 1));
    const auto slot = [&](const LineEntry& entry) -> std::uint8_t& { return held[entry.key & (held.size() - 1)]; };
    std::size_t met = 0;  // number of entries that share their key with another entry
    each_entry([&](const LineEntry& entry) {
        std::uint8_t& n = slot(entry);
        met += n == 0 ? 0 : n == 1 ? 2 : 1;
        n = std::min(n + 1, 2);
    });
    std::vector<LineEntry> entries;
    entries.reserve(met);
    each_entry([&](const LineEntry& entry) {
        if (slot(entry) > 1) entries.push_back(entry);
    });
    return entries;
}

void EdgePairs::pair_parts_of_edges() {
    std::vector<LineEntry> entries = line_entries();
    std::sort(entries.begin(), entries.end());
    std::vector<std::uint32_t> group;
    for (std::size_t i = 0, j; i < entries.size(); i = j) {
        group.clear();
        for (j = i; j < entries.size() && entries[j].key == entries[i].key; ++j)
            add_unpaired_twins(entries[j].edge, group);
        if (j - i == 1) continue;
        std::sort(group.begin(), group.end());
        pair_on_line(group);
    }
    std::sort(splits_.begin(), splits_.end());
    splits_.erase(std::unique(splits_.begin(), splits_.end()), splits_.end());
}

}  // namespace exitance
