#include "exitance/scene/joining/regions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/groups.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/scene/joining/border.hpp"
#include "exitance/scene/joining/common_area.hpp"
#include "exitance/scene/joining/edge_pairs.hpp"

namespace exitance {
namespace {

/// One attempt to join a set of faces. Faces are numbered by their index in the set.
class Joiner {
  public:
    Joiner(const FaceMesh& mesh, const Tolerances& tolerances, std::vector<std::uint32_t> faces)
        : mesh_(mesh), tol_(tolerances), faces_(std::move(faces)), pairs_(mesh, tolerances, faces_) {}

    /// Appends the sets whose union is a valid polygon to `out`. Of the other sets, faces that cover an earlier one are
    /// appended to `covering`, the rest to `failed`.
    void collect(std::vector<JoinedFaces>& out, std::vector<std::uint32_t>& covering,
                 std::vector<std::uint32_t>& failed);

  private:
    const Point& point(std::uint32_t i) const { return mesh_.points[i]; }
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
    EdgePairs pairs_;
};

/// Edges of a set of faces, split at T-vertices, without edges that have a partner within the set.
std::vector<BorderEdge> Joiner::border(std::span<const std::uint32_t> set) const {
    std::vector<BorderEdge> out;
    for (std::uint32_t f : set) {
        const auto [first, last] = pairs_.edges_of(f);
        for (std::uint32_t e = first; e < last; ++e) {
            const EdgePairs::Edge& edge = pairs_.edge(e);
            if (edge.partner != EdgePairs::none) continue;
            std::uint32_t from = edge.from;
            for (const EdgePairs::Split& split : pairs_.splits(e))
                out.push_back({from, split.point}), from = split.point;
            out.push_back({from, edge.to});
        }
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

/// Faces of a set that cover a part of an earlier one, ascending. All but the first if too many faces overlap to
/// decide.
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
    const bool gave_up = each_overlap(boxes, tol_.place, [&](std::uint32_t i, std::uint32_t j) {
        const bool covers = common_area(corners(i), corners(j), n, tol_.place) > 0;
        if (covers) out.push_back(set[i]);
        return covers;
    });
    if (gave_up) out.assign(set.begin() + 1, set.end());
    return out;
}

/// True if a union of faces has one convex loop as its border. The number of faces that cover a point equals the
/// winding number of the border; with a convex loop no point is covered twice, and faces need not be compared with each
/// other.
bool Joiner::is_one_convex_loop(const std::vector<std::vector<std::uint32_t>>& loops, const Vec3& area_vector) const {
    if (loops.size() != 1) return false;
    std::vector<Point> corners;
    for (std::uint32_t c : loops[0]) corners.push_back(point(c));
    return is_convex(corners, normalized(area_vector));
}

/// True for a triangle without splits whose corners are not collinear: its outline is its border. Most single faces are
/// triangles of curved surfaces.
bool Joiner::is_plain_triangle(std::uint32_t f) const {
    const auto [first, last] = pairs_.edges_of(f);
    if (last - first != 3) return false;
    double longest = 0;
    for (std::uint32_t e = first; e < last; ++e) {
        if (!pairs_.splits(e).empty()) return false;
        longest = std::max(longest, squared_norm(point(pairs_.edge(e).to) - point(pairs_.edge(e).from)));
    }
    return 0.5 * norm(mesh_.area_vector[faces_[f]]) > tol_.place * std::sqrt(longest);
}

/// Union of a set. Without loops if it is not a valid polygon; `covering` then lists faces that cover earlier ones, if
/// that is the reason.
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
    std::vector<std::uint32_t> root_of(n), roots;
    for (std::uint32_t f = 0; f < n; ++f) {
        root_of[f] = pairs_.root(f);
        if (root_of[f] == f) roots.push_back(f);
    }
    const Groups sets(root_of, n);  // sets of joined faces, indexed by their roots
    std::vector<Union> unions(roots.size());
    parallel_for(roots.size(), 256, [&](std::size_t i) { unions[i] = unite(sets[roots[i]]); });
    for (std::size_t i = 0; i < roots.size(); ++i) {
        Union& u = unions[i];
        if (!u.joined.loops.empty()) {
            out.push_back(std::move(u.joined));
            continue;
        }
        for (std::uint32_t f : sets[roots[i]]) {
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
    // Finely tessellated curved surfaces bend little between neighbouring faces but much over a whole set. Such a set
    // is tried again with faces that are coplanar up to rounding. Each attempt is repeated for sets from which covering
    // faces were removed.
    Tolerances strict = tolerances;
    strict.plane = strict.place;
    for (const Tolerances& attempt : {tolerances, tolerances, strict, strict}) {
        if (faces.empty()) break;
        Joiner joiner(mesh, attempt, std::move(faces));
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
