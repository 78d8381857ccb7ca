#include "exitance/scene/regions.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "exitance/core/disjoint_sets.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/core/random.hpp"
#include "exitance/scene/border.hpp"
#include "exitance/scene/cell_keys.hpp"
#include "exitance/scene/common_area.hpp"
#include "exitance/scene/hash_chains.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// Cells that lines are told by: of the coordinates of their direction, and of their place in sizes of the scene.
constexpr double direction_cell = 1e-3, place_cell = 1e-4;
constexpr unsigned grades = 4;  ///< Of coarseness, see Joiner::grade.

/// How far an edge reaches along a direction.
struct Interval {
    double lo, hi;
    std::uint32_t edge;
};

/// How many of the others an interval meets, about, were they spread evenly.
double crowding(const std::vector<Interval>& intervals) {
    double lo = intervals[0].lo, hi = intervals[0].hi, sum = 0;
    for (const Interval& i : intervals) lo = std::min(lo, i.lo), hi = std::max(hi, i.hi), sum += i.hi - i.lo;
    return sum / (hi - lo);
}

/// The first unpaired edge between two points under one of the keys of its line.
struct LineEntry {
    std::uint64_t key;
    std::uint32_t edge;
};

/// One attempt at joining a set of faces. Edges are numbered over the corners of these faces.
class Joiner {
  public:
    Joiner(const FaceMesh& mesh, const Tolerances& tolerances, std::vector<std::uint32_t> faces)
        : mesh_(mesh), tol_(tolerances), faces_(std::move(faces)), sets_(faces_.size()) {
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
    }

    void pair_whole_edges();
    void pair_parts_of_edges();
    /// Appends the sets whose union is a proper polygon to `out`. Of the others, faces that cover an earlier one go to
    /// `covering`, the rest to `failed`.
    void collect(std::vector<JoinedFaces>& out, std::vector<std::uint32_t>& covering,
                 std::vector<std::uint32_t>& failed);

  private:
    struct Edge {
        std::uint32_t from, to, face, partner;
        std::uint32_t twin;  ///< The edge before this one between the same two points, either way round, or none.
    };
    struct Split {
        std::uint32_t edge, point;
        double at;
        auto operator<=>(const Split&) const = default;
    };

    const Point& point(std::uint32_t i) const { return mesh_.points[i]; }
    std::uint32_t material(std::uint32_t f) const { return mesh_.material[faces_[f]]; }
    bool coplanar(std::uint32_t f, std::uint32_t g) const;
    std::vector<LineEntry> line_entries() const;
    unsigned grade(std::uint32_t edge) const;
    void add_line_keys(std::uint32_t edge, unsigned grade, const Point& centre, double size,
                       std::vector<LineEntry>& out) const;
    void add_unpaired_twins(std::uint32_t edge, std::vector<std::uint32_t>& out) const;
    std::vector<Interval> intervals_along(const Vec3& d, std::span<const std::uint32_t> group) const;
    void pair_on_line(std::span<const std::uint32_t> group);
    void pair_parts(std::uint32_t e, std::uint32_t f);
    void split_at_ends(std::uint32_t e, std::uint32_t other, const Vec3& d, double length);
    std::vector<BorderEdge> border(std::span<const std::uint32_t> set) const;
    bool is_flat(std::span<const std::uint32_t> set, const Vec3& area_vector) const;
    bool is_one_convex_loop(const std::vector<std::vector<std::uint32_t>>& loops, const Vec3& area_vector) const;
    std::vector<std::uint32_t> covering_faces(std::span<const std::uint32_t> set, const Normal& n) const;
    struct Union {
        JoinedFaces joined;
        std::vector<std::uint32_t> covering;
    };
    bool is_plain_triangle(std::uint32_t f) const;
    Union unite(std::span<const std::uint32_t> set) const;

    const FaceMesh& mesh_;
    const Tolerances& tol_;
    std::vector<std::uint32_t> faces_;
    DisjointSets sets_;
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> first_edge_;
    std::vector<Split> splits_;
};

/// Same orientation, and the smaller face lies in the larger one's plane. Slivers have no normal worth the name, so
/// that their distance decides alone.
bool Joiner::coplanar(std::uint32_t f, std::uint32_t g) const {
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

void Joiner::pair_whole_edges() {
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

/// How coarse the cells must be for the line through an edge to be told within an eighth of one: each grade is eight
/// times as coarse as the one before it. Nearly all edges are of grade 0; those above are short beside the scene.
unsigned Joiner::grade(std::uint32_t edge) const {
    const double length = norm(point(edges_[edge].to) - point(edges_[edge].from));
    const double error = 8 * 2 * tol_.place / length;  // of the direction; of the place, in sizes of the scene, as much
    unsigned grade = 0;
    for (double cell = place_cell; cell < error && grade + 1 < grades; cell *= 8) ++grade;
    return grade;
}

/// Keys of the line through an edge: cells of its direction and of its point nearest to the scene's centre. Near a
/// cell's wall the neighbour's key is given as well, so that edges of one line always have a key in common.
void Joiner::add_line_keys(std::uint32_t edge, unsigned grade, const Point& centre, double size,
                           std::vector<LineEntry>& out) const {
    const Point& p = point(edges_[edge].from);
    Vec3 d = point(edges_[edge].to) - p;
    const double length = norm(d), coarser = std::ldexp(1.0, 3 * static_cast<int>(grade));
    d = d / length;
    if (dot(d, Vec3{0.5377, 0.7323, 0.4181}) < 0) d = -d;  // no line of a practical scene is at a right angle to this
    const Vec3 foot = (p - centre) - dot(p - centre, d) * d;
    const double direction_error = 2 * tol_.place / length, foot_error = tol_.place + size * direction_error;
    const auto direction = [&](double x) { return CellCoordinate{x, coarser * direction_cell, direction_error}; };
    const auto place = [&](double x) { return CellCoordinate{x, coarser * place_cell * size, foot_error}; };
    each_cell_key<6>(grade,
                     {direction(d.x), direction(d.y), direction(d.z), place(foot.x), place(foot.y), place(foot.z)},
                     [&](std::uint64_t key) {
                         out.push_back({key, edge});
                     });
}

/// Marks where the ends of `other` lie inside edge e, whose unit direction is d.
void Joiner::split_at_ends(std::uint32_t e, std::uint32_t other, const Vec3& d, double length) {
    for (std::uint32_t corner : {edges_[other].from, edges_[other].to}) {
        const double at = dot(point(corner) - point(edges_[e].from), d);
        if (at > tol_.place && at < length - tol_.place) splits_.push_back({e, corner, at});
    }
}

/// Pairs two edges of one line that run against each other and overlap.
void Joiner::pair_parts(std::uint32_t e, std::uint32_t f) {
    const Point &p = point(edges_[e].from), &r = point(edges_[f].from);
    const Vec3 a = point(edges_[e].to) - p, b = point(edges_[f].to) - r;
    const double length = norm(a);
    if (dot(a, b) >= 0) return;
    const Vec3 d = a / length;
    const Vec3 w0 = r - p, w1 = point(edges_[f].to) - p;
    const double t0 = dot(w0, d), t1 = dot(w1, d);
    if (std::min(length, t0) - std::max(0.0, t1) <= 2 * tol_.place) return;
    const double off = std::max(squared_norm(w0 - t0 * d), squared_norm(w1 - t1 * d));
    if (off > tol_.place * tol_.place || !coplanar(edges_[e].face, edges_[f].face)) return;
    sets_.unite(edges_[e].face, edges_[f].face);
    split_at_ends(e, f, d, length);
    split_at_ends(f, e, normalized(b), norm(b));
}

std::vector<Interval> Joiner::intervals_along(const Vec3& d, std::span<const std::uint32_t> group) const {
    const Point origin = point(edges_[group[0]].from);
    std::vector<Interval> out;
    for (const std::uint32_t e : group) {
        const double s = dot(point(edges_[e].from) - origin, d), t = dot(point(edges_[e].to) - origin, d);
        out.push_back({std::min(s, t) - tol_.place, std::max(s, t) + tol_.place, e});
    }
    return out;
}

/// Sweeps along a line over the edges on it and those that only share its cell. Edges that are short for the size of
/// the scene tell their lines so badly that a cell may hold whole rows of them: those are swept along an axis that
/// tells them apart.
void Joiner::pair_on_line(std::span<const std::uint32_t> group) {
    constexpr std::size_t few = 8;  // most lines carry the two edges of a box's corner: not worth sorting
    const auto pair = [&](std::uint32_t e, std::uint32_t f) {
        if (material(edges_[e].face) == material(edges_[f].face)) pair_parts(e, f);
    };
    if (group.size() <= few) {
        for (std::size_t i = 0; i < group.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) pair(group[j], group[i]);
        return;
    }
    const Edge& first = edges_[group[0]];
    std::vector<Interval> intervals = intervals_along(normalized(point(first.to) - point(first.from)), group);
    constexpr double crowded = 32;
    if (crowding(intervals) > crowded)
        for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
            std::vector<Interval> other = intervals_along(axis, group);
            if (crowding(other) < crowding(intervals)) intervals = std::move(other);
        }
    std::sort(intervals.begin(), intervals.end(),
              [](const Interval& a, const Interval& b) { return a.lo != b.lo ? a.lo < b.lo : a.edge < b.edge; });
    std::vector<Interval> open;
    for (const Interval& i : intervals) {
        std::erase_if(open, [&](const Interval& o) { return o.hi <= i.lo; });
        for (const Interval& o : open) pair(o.edge, i.edge);
        open.push_back(i);
    }
}

/// The unpaired edges between the two points of one, that one included.
void Joiner::add_unpaired_twins(std::uint32_t edge, std::vector<std::uint32_t>& out) const {
    for (std::uint32_t e = edge; e != none; e = edges_[e].twin)
        if (edges_[e].partner == none) out.push_back(e);
}

/// Unpaired edges by their lines; of those between the same two points, which pair_whole_edges has compared, the last
/// stands for all. Edges with a line to themselves, as nearly all are that curved surfaces leave unpaired, are not
/// among them: a table of counts tells, before anything is sorted.
std::vector<LineEntry> Joiner::line_entries() const {
    Box box;
    for (const Edge& e : edges_) box.add(point(e.from));
    std::vector<char> is_last(edges_.size(), true);
    std::size_t count = 0;
    std::vector<std::uint32_t> twins;
    std::vector<LineEntry> entries;
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
        if (edges_[e].twin != none) is_last[edges_[e].twin] = false;
    const double size = box.diagonal();
    std::array<bool, grades> is_there{};
    for (std::uint32_t e = 0; e < edges_.size(); ++e) is_there[grade(e)] = true;
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        if (!is_last[e]) continue;
        twins.clear();
        add_unpaired_twins(e, twins);
        if (twins.empty()) continue;
        // An edge meets the shorter ones among their cells.
        for (unsigned g = grade(e); g < grades; ++g)
            if (is_there[g]) add_line_keys(e, g, box.centre(), size, entries), ++count;
    }
    std::vector<std::uint8_t> held(std::bit_ceil(4 * count + 1));
    const auto slot = [&](const LineEntry& entry) -> std::uint8_t& { return held[entry.key & (held.size() - 1)]; };
    for (const LineEntry& entry : entries) slot(entry) = std::min(slot(entry) + 1, 2);
    std::erase_if(entries, [&](const LineEntry& entry) { return slot(entry) < 2; });
    return entries;
}

void Joiner::pair_parts_of_edges() {
    std::vector<LineEntry> entries = line_entries();
    std::sort(entries.begin(), entries.end(),
              [](const LineEntry& a, const LineEntry& b) { return a.key != b.key ? a.key < b.key : a.edge < b.edge; });
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

/// The edges of a set of faces, split at T-vertices, those taken out that have a partner within the set.
std::vector<BorderEdge> Joiner::border(std::span<const std::uint32_t> set) const {
    std::vector<BorderEdge> out;
    for (std::uint32_t f : set)
        for (std::uint32_t e = first_edge_[f]; e < first_edge_[f + 1]; ++e) {
            if (edges_[e].partner != none) continue;
            auto split = std::lower_bound(splits_.begin(), splits_.end(), Split{e, 0, -1},
                                          [](const Split& a, const Split& b) { return a.edge < b.edge; });
            std::vector<std::pair<double, std::uint32_t>> inside;
            for (; split != splits_.end() && split->edge == e; ++split) inside.push_back({split->at, split->point});
            std::sort(inside.begin(), inside.end());
            std::uint32_t from = edges_[e].from;
            for (const auto& [at, point] : inside) out.push_back({from, point}), from = point;
            out.push_back({from, edges_[e].to});
        }
    return out;
}

bool Joiner::is_flat(std::span<const std::uint32_t> set, const Vec3& area_vector) const {
    const Normal n = normalized(area_vector);
    const Point& origin = point(mesh_.outline(faces_[set[0]])[0]);
    double lo = 0, hi = 0;
    for (std::uint32_t f : set)
        for (std::uint32_t c : mesh_.outline(faces_[f])) {
            const double height = dot(n, point(c) - origin);
            lo = std::min(lo, height), hi = std::max(hi, height);
        }
    return hi - lo <= 2 * std::max(tol_.plane, tol_.place);
}

/// Faces of a set that cover a part of an earlier one, ascending.
std::vector<std::uint32_t> Joiner::covering_faces(std::span<const std::uint32_t> set, const Normal& n) const {
    const Frame frame(n);
    std::vector<FlatBox> boxes(set.size());
    const auto corners = [&](std::size_t i) {
        std::vector<Point> out;
        for (std::uint32_t c : mesh_.outline(faces_[set[i]])) out.push_back(point(c));
        return out;
    };
    for (std::size_t i = 0; i < set.size(); ++i)
        for (std::uint32_t c : mesh_.outline(faces_[set[i]]))
            boxes[i].add({dot(point(c), frame.u), dot(point(c), frame.v)});
    std::vector<std::uint32_t> out;
    each_overlap(boxes, tol_.place, [&](std::uint32_t i, std::uint32_t j) {
        if (common_area(corners(i), corners(j), n, tol_.place) > 0) out.push_back(set[j]);
    });
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// How often a union of faces covers a point is how often its border winds around it. Hence faces whose border is one
/// convex loop cover nothing twice, and need not be compared with each other.
bool Joiner::is_one_convex_loop(const std::vector<std::vector<std::uint32_t>>& loops, const Vec3& area_vector) const {
    if (loops.size() != 1) return false;
    std::vector<Point> corners;
    for (std::uint32_t c : loops[0]) corners.push_back(point(c));
    return is_convex(corners, normalized(area_vector));
}

/// Most faces of curved surfaces stay alone, and three corners that are not in line are their own border.
bool Joiner::is_plain_triangle(std::uint32_t f) const {
    if (first_edge_[f + 1] - first_edge_[f] != 3) return false;
    double longest = 0;
    for (std::uint32_t e = first_edge_[f]; e < first_edge_[f + 1]; ++e) {
        const auto split = std::lower_bound(splits_.begin(), splits_.end(), e,
                                            [](const Split& s, std::uint32_t edge) { return s.edge < edge; });
        if (split != splits_.end() && split->edge == e) return false;
        longest = std::max(longest, squared_norm(point(edges_[e].to) - point(edges_[e].from)));
    }
    return 0.5 * norm(mesh_.area_vector[faces_[f]]) > tol_.place * std::sqrt(longest);
}

/// The union of a set; no loops when it is no proper polygon, with the faces that cover earlier ones if that is why.
Joiner::Union Joiner::unite(std::span<const std::uint32_t> set) const {
    Union out;
    for (std::uint32_t f : set) out.joined.faces.push_back(faces_[f]);
    if (set.size() == 1 && is_plain_triangle(set[0])) {
        const auto outline = mesh_.outline(faces_[set[0]]);
        auto& loop = out.joined.loops.emplace_back(outline.begin(), outline.end());
        return start_at_smallest(mesh_.points, loop), out;
    }
    Vec3 area_vector;
    for (std::uint32_t f : set) area_vector += mesh_.area_vector[faces_[f]];
    if (!is_flat(set, area_vector)) return out;
    out.joined.loops = border_loops(mesh_.points, border(set), area_vector, tol_.place);
    if (set.size() > 1 && !is_one_convex_loop(out.joined.loops, area_vector)) {
        out.covering = covering_faces(set, normalized(area_vector));
        if (!out.covering.empty()) out.joined.loops.clear();
    }
    return out;
}

void Joiner::collect(std::vector<JoinedFaces>& out, std::vector<std::uint32_t>& covering,
                     std::vector<std::uint32_t>& failed) {
    const auto n = static_cast<std::uint32_t>(faces_.size());
    std::vector<std::uint32_t> members(n), first(n + 1, 0), roots;  // sets by their roots, their faces ascending
    for (std::uint32_t f = 0; f < n; ++f) ++first[sets_.root(f) + 1];
    for (std::uint32_t f = 0; f < n; ++f) {
        if (first[f + 1] > 0) roots.push_back(f);
        first[f + 1] += first[f];
    }
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t f = 0; f < n; ++f) members[next[sets_.root(f)]++] = f;
    const auto set_of = [&](std::size_t i) {
        return std::span(members).subspan(first[roots[i]], first[roots[i] + 1] - first[roots[i]]);
    };
    std::vector<Union> unions(roots.size());
    parallel_for(roots.size(), 256, [&](std::size_t i) { unions[i] = unite(set_of(i)); });
    for (std::size_t i = 0; i < roots.size(); ++i) {
        Union& u = unions[i];
        if (!u.joined.loops.empty()) {
            out.push_back(std::move(u.joined));
            continue;
        }
        for (std::uint32_t f : set_of(i)) {
            const bool covers = std::binary_search(u.covering.begin(), u.covering.end(), f);
            (covers ? covering : failed).push_back(faces_[f]);
        }
    }
}

}  // namespace

std::vector<JoinedFaces> join_coplanar(const FaceMesh& mesh, const Tolerances& tolerances) {
    std::vector<JoinedFaces> out;
    std::vector<std::uint32_t> faces(mesh.size()), lone;
    std::iota(faces.begin(), faces.end(), 0u);
    // Finely cut curved surfaces bend little from one face to the next, but much over a whole set: such a set is joined
    // again where it is flat to rounding alone. Each way is tried again for sets from which covering faces were taken.
    Tolerances strict = tolerances;
    strict.plane = strict.place;
    for (const Tolerances& attempt : {tolerances, tolerances, strict, strict}) {
        if (faces.empty()) break;
        Joiner joiner(mesh, attempt, std::move(faces));
        joiner.pair_whole_edges();
        joiner.pair_parts_of_edges();
        faces.clear();
        joiner.collect(out, lone, faces);
        std::sort(faces.begin(), faces.end());
    }
    lone.insert(lone.end(), faces.begin(), faces.end());
    for (std::uint32_t f : lone) out.push_back({{f}, lone_face_loops(mesh, f, tolerances.place)});
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.faces[0] < b.faces[0]; });
    return out;
}

}  // namespace exitance
