#include "exitance/mesh/planar_subdivision.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <unordered_map>

namespace exitance {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr std::uint32_t unnumbered = 0xffffffffu;
struct Number {
    std::uint32_t value = unnumbered;
};
struct Depth {
    int value = -1;  ///< Number of loops between the face and infinity; odd: inside.
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Number, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<Depth, Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;

/// Assigns to every face the number of loops around it, proceeding inwards from the infinite face.
template <class AnyTriangulation, class IsBorder>
void count_loops_around(AnyTriangulation& t, const IsBorder& is_border) {
    std::deque<typename AnyTriangulation::Face_handle> open{t.infinite_face()};
    t.infinite_face()->info().value = 0;
    while (!open.empty()) {
        const auto face = open.front();
        open.pop_front();
        for (int i = 0; i < 3; ++i) {
            const auto next = face->neighbor(i);
            if (next->info().value >= 0) continue;
            const bool border = is_border(face, i);
            next->info().value = face->info().value + (border ? 1 : 0);
            if (border)
                open.push_back(next);  // visited after all faces on this side of the border
            else
                open.push_front(next);
        }
    }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> delaunay_triangles(std::span<const std::vector<Vec2>> loops) {
    Triangulation t;
    std::uint32_t number = 0;
    for (const auto& loop : loops) {
        std::vector<Triangulation::Vertex_handle> vertices;
        for (const Vec2& p : loop) {
            const auto v = t.insert({p.x, p.y});
            v->info().value = std::min(v->info().value, number++);
            vertices.push_back(v);
        }
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const auto a = vertices[i], b = vertices[(i + 1) % vertices.size()];
            if (a != b) t.insert_constraint(a, b);
        }
    }
    std::vector<std::array<std::uint32_t, 3>> out;
    if (t.dimension() < 2) return out;
    count_loops_around(t, [&](const auto& face, int i) { return t.is_constrained({face, i}); });
    for (const auto face : t.finite_face_handles()) {
        if (face->info().value % 2 == 0) continue;
        std::array<std::uint32_t, 3> corners;
        for (int i = 0; i < 3; ++i) corners[static_cast<std::size_t>(i)] = face->vertex(i)->info().value;
        if (std::find(corners.begin(), corners.end(), unnumbered) == corners.end()) out.push_back(corners);
    }
    return out;
}

namespace {

/// Data of a face of the labelled triangulation: depth, number, and the labels of the edges opposite its vertices.
struct FaceNote {
    int value = -1;
    std::uint32_t number = LabelledTriangles::none;
    std::array<std::uint8_t, 3> labels{LabelledTriangles::unlabelled, LabelledTriangles::unlabelled,
                                       LabelledTriangles::unlabelled};
};
using NotedFace =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<FaceNote, Kernel>>;
using Lines = CGAL::Constrained_triangulation_plus_2<CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, NotedFace>, CGAL::Exact_predicates_tag>>;

void insert_line(Lines& t, Vec2 a, Vec2 b, std::uint8_t label,
                 std::vector<std::pair<Lines::Constraint_id, std::uint8_t>>& lines) {
    if (a == b) return;
    const auto va = t.insert({a.x, a.y}), vb = t.insert({b.x, b.y});
    if (va == vb) return;
    const Lines::Constraint_id id = t.insert_constraint(va, vb);
    if (id != Lines::Constraint_id()) lines.emplace_back(id, label);
}

/// Assigns to each edge the smallest label of the lines that contain it.
void label_edges(Lines& t, const std::vector<std::pair<Lines::Constraint_id, std::uint8_t>>& lines) {
    for (const auto& [id, label] : lines) {
        auto at = t.vertices_in_constraint_begin(id);
        const auto end = t.vertices_in_constraint_end(id);
        if (at == end) continue;
        for (auto next = std::next(at); next != end; at = next++) {
            Lines::Face_handle face;
            int i = 0;
            if (!t.is_edge(*at, *next, face, i)) continue;
            const auto mark = [&, label = label](Lines::Face_handle f, int k) {
                std::uint8_t& known = f->info().labels[static_cast<std::size_t>(k)];
                known = std::min(known, label);
            };
            mark(face, i);
            const auto other = face->neighbor(i);
            mark(other, other->index(face));
        }
    }
}

template <class AnyTriangulation>
LabelledTriangles take_inside(AnyTriangulation& t) {
    LabelledTriangles out;
    std::uint32_t triangles = 0;
    for (const auto face : t.finite_face_handles())
        if (face->info().value % 2 != 0) face->info().number = triangles++;
    for (const auto face : t.finite_face_handles()) {
        if (face->info().number == LabelledTriangles::none) continue;
        std::array<std::uint32_t, 3> corners, neighbors;
        std::array<std::uint8_t, 3> labels;
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            std::uint32_t& number = face->vertex(i)->info().value;
            if (number == unnumbered) {
                number = static_cast<std::uint32_t>(out.points.size());
                out.points.push_back({face->vertex(i)->point().x(), face->vertex(i)->point().y()});
            }
            corners[k] = number;
            labels[k] = face->info().labels[(k + 2) % 3];
            neighbors[k] = face->neighbor((i + 2) % 3)->info().number;
        }
        out.corners.push_back(corners), out.labels.push_back(labels), out.neighbors.push_back(neighbors);
    }
    return out;
}

}  // namespace

LabelledTriangles labelled_triangles(std::span<const std::vector<Vec2>> loops,
                                     std::span<const LabelledSegment> segments) {
    try {
        Lines t;
        std::vector<std::pair<Lines::Constraint_id, std::uint8_t>> lines;
        for (const auto& loop : loops)
            for (std::size_t i = 0; i < loop.size(); ++i)
                insert_line(t, loop[i], loop[(i + 1) % loop.size()], LabelledTriangles::border, lines);
        for (const LabelledSegment& s : segments) insert_line(t, s.a, s.b, s.label, lines);
        if (t.dimension() < 2) return {};
        label_edges(t, lines);
        count_loops_around(t, [](const auto& face, int i) {
            return face->info().labels[static_cast<std::size_t>(i)] == LabelledTriangles::border;
        });
        return take_inside(t);
    } catch (const std::exception&) {
        return {};  // a CGAL assertion failed
    }
}

namespace {

using Faces =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, NotedFace>,
                                               CGAL::Exact_predicates_tag>;

double area_of(const LabelledTriangles& t) {
    double twice = 0;
    for (const auto& c : t.corners) twice += cross(t.points[c[1]] - t.points[c[0]], t.points[c[2]] - t.points[c[0]]);
    return 0.5 * twice;
}

class DelaunayRefinement {
  public:
    explicit DelaunayRefinement(const LabelledTriangles& coarse) {
        std::vector<Faces::Vertex_handle> vertices;
        for (const Vec2& p : coarse.points) vertices.push_back(add(faces_.insert({p.x, p.y})));
        for (std::size_t i = 0; i < coarse.corners.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto a = vertices[coarse.corners[i][k]], b = vertices[coarse.corners[i][(k + 1) % 3]];
                std::uint8_t label = coarse.labels[i][k];
                if (coarse.neighbors[i][k] == LabelledTriangles::none) label = LabelledTriangles::border;
                if (label == LabelledTriangles::unlabelled || a == b) continue;
                const auto [known, is_new] = labels_.try_emplace(key(a, b), label);
                known->second = std::min(known->second, label);
                if (is_new) faces_.insert_constraint(a, b);
            }
        given_ = count_;
        const double mean_edge = std::sqrt(2 * area_of(coarse) / static_cast<double>(coarse.corners.size()));
        // At smaller distances, the number of triangles grows more than their shapes improve. Chosen: half of it
        // makes 25% more triangles, with a mean ratio of radii of 0.345 in place of 0.343, and twice it 24% fewer,
        // with 0.339: measured by `exitance solve gaps.obj --method discontinuity --dm-quality delaunay --error
        // 0.05`.
        constexpr double min_distance_share = 0.25;
        nearest_ = min_distance_share * mean_edge;
    }

    LabelledTriangles run() {
        constexpr int max_passes = 100;
        for (int pass = 0; pass < max_passes && improve_all(); ++pass) {
        }
        find_inside();
        for (const auto face : faces_.finite_face_handles())
            for (int i = 0; i < 3; ++i) {
                const auto known = labels_.find(key(face->vertex(Faces::ccw(i)), face->vertex(Faces::cw(i))));
                if (known != labels_.end()) face->info().labels[static_cast<std::size_t>(i)] = known->second;
            }
        for (const auto v : faces_.finite_vertex_handles()) v->info().value = unnumbered;
        return take_inside(faces_);
    }

  private:
    using Handle = Faces::Face_handle;
    using Vertex = Faces::Vertex_handle;

    Vertex add(Vertex v) {
        if (v->info().value == unnumbered) v->info().value = count_++;
        return v;
    }
    static std::uint64_t key(Vertex a, Vertex b) {
        const auto [least, most] = std::minmax(a->info().value, b->info().value);
        return static_cast<std::uint64_t>(least) << 32 | most;
    }
    static Vec2 place(Vertex v) { return {v->point().x(), v->point().y()}; }

    void find_inside() {
        for (const auto face : faces_.all_face_handles()) face->info() = {};
        count_loops_around(faces_, [&](const auto& face, int i) {
            if (!faces_.is_constrained({face, i})) return false;
            const auto known = labels_.find(key(face->vertex(Faces::ccw(i)), face->vertex(Faces::cw(i))));
            return known != labels_.end() && known->second == LabelledTriangles::border;
        });
    }

    /// Processes all triangles with a small angle once. Returns false if none could be improved.
    bool improve_all() {
        find_inside();
        std::vector<std::array<Vertex, 3>> sharp;
        for (const auto face : faces_.finite_face_handles())
            if (face->info().value % 2 != 0 && is_sharp(face))
                sharp.push_back({face->vertex(0), face->vertex(1), face->vertex(2)});
        bool is_better = false;
        for (const auto& [a, b, c] : sharp) {
            Handle face;
            if (faces_.is_face(a, b, c, face)) is_better |= improve(face);
        }
        return is_better;
    }

    /// Returns whether the triangle has a small angle that is not between two labelled edges.
    bool is_sharp(Handle face) const {
        // Sine of 20.7 degrees, the smallest angle: shortest edge over twice the circumradius. Derived from Ruppert's
        // refinement, which ends for angles up to this one.
        constexpr double sine = 0.3535;
        double length[3];
        for (int i = 0; i < 3; ++i) {
            const Vec2 d = place(face->vertex(Faces::ccw(i))) - place(face->vertex(Faces::cw(i)));
            length[i] = std::sqrt(dot(d, d));
        }
        const int least = static_cast<int>(std::min_element(length, length + 3) - length);
        const double twice =
            cross(place(face->vertex(1)) - place(face->vertex(0)), place(face->vertex(2)) - place(face->vertex(0)));
        if (!(twice > 0)) return false;
        if (twice >= sine * length[(least + 1) % 3] * length[(least + 2) % 3]) return false;
        return !faces_.is_constrained({face, (least + 1) % 3}) || !faces_.is_constrained({face, (least + 2) % 3});
    }

    bool improve(Handle face) {
        const Kernel::Point_2 middle = faces_.circumcenter(face);
        const Vec2 m{middle.x(), middle.y()}, way = m - place(face->vertex(0));
        if (!(dot(way, way) >= nearest_ * nearest_) || !std::isfinite(dot(way, way))) return false;
        constexpr int max_steps = 1'000;
        for (int step = 0; step < max_steps; ++step) {
            int beyond = -1;
            for (int i = 0; i < 3 && beyond < 0; ++i)
                if (CGAL::orientation(face->vertex(Faces::ccw(i))->point(), face->vertex(Faces::cw(i))->point(),
                                      middle) == CGAL::RIGHT_TURN)
                    beyond = i;
            if (beyond < 0) return insert(middle, face);
            if (faces_.is_constrained({face, beyond})) return halve({face, beyond});
            face = face->neighbor(beyond);
            if (faces_.is_infinite(face)) return false;
        }
        return false;
    }

    /// Inserts a circumcentre, or splits an edge whose diametral circle contains it.
    bool insert(const Kernel::Point_2& p, Handle face) {
        std::vector<Handle> conflicts;
        std::vector<Faces::Edge> rim;
        faces_.get_conflicts_and_boundary(p, std::back_inserter(conflicts), std::back_inserter(rim), face);
        bool is_near = false;
        for (const Faces::Edge& e : rim) {
            if (!faces_.is_constrained(e)) continue;
            const Vec2 at{p.x(), p.y()}, a = place(e.first->vertex(Faces::ccw(e.second))),
                                         b = place(e.first->vertex(Faces::cw(e.second)));
            if (dot(a - at, b - at) > 0) continue;
            is_near = true;
            if (halve(e)) return true;
        }
        if (is_near) return false;
        add(faces_.insert(p, face));
        return true;
    }

    /// Splits a labelled edge: at its middle, or if it starts at an original vertex, at a power-of-two distance from
    /// there, so that the edges of a sharp corner are split at equal distances.
    bool halve(const Faces::Edge& edge) {
        const auto [face, i] = edge;
        const Vertex a = face->vertex(Faces::ccw(i)), b = face->vertex(Faces::cw(i));
        const Vec2 pa = place(a), pb = place(b), way = pb - pa;
        const double length = std::sqrt(dot(way, way));
        if (!(length >= 2 * nearest_)) return false;
        double share = 0.5;
        if (const bool first = is_given(a); first != is_given(b)) {
            const double shell = std::exp2(std::round(std::log2(0.5 * length / nearest_))) * nearest_;
            // Derived from the nearest power of two, which is 0.35 to 0.71 of the length.
            constexpr double min_share = 0.3;
            share = std::clamp(shell / length, min_share, 1 - min_share);
            if (!first) share = 1 - share;
        }
        const Vec2 m = pa + share * way;
        const Kernel::Point_2 at(m.x, m.y);
        const auto is_between = [&](const Faces::Edge& e) {
            if (faces_.is_infinite(e.first)) return true;
            const auto& top = e.first->vertex(e.second)->point();
            const auto &p = e.first->vertex(Faces::ccw(e.second))->point(),
                       &q = e.first->vertex(Faces::cw(e.second))->point();
            return CGAL::orientation(top, p, at) == CGAL::LEFT_TURN && CGAL::orientation(top, at, q) == CGAL::LEFT_TURN;
        };
        if (!is_between(edge) || !is_between(faces_.mirror_edge(edge))) return false;
        const auto known = labels_.find(key(a, b));
        if (known == labels_.end()) return false;
        const std::uint8_t label = known->second;
        labels_.erase(known);
        const Vertex v = add(faces_.insert(at, Faces::EDGE, face, i));
        labels_[key(a, v)] = labels_[key(v, b)] = label;
        return true;
    }
    bool is_given(Vertex v) const { return v->info().value < given_; }

    Faces faces_;
    std::unordered_map<std::uint64_t, std::uint8_t> labels_;  ///< Labels of constrained edges, by their end points.
    std::uint32_t count_ = 0, given_ = 0;  ///< Number of vertices so far, and of the coarse triangles.
    double nearest_ = 0;                   ///< Minimum distance of added points from others.
};

}  // namespace

LabelledTriangles refined_triangles(const LabelledTriangles& coarse) {
    if (coarse.corners.empty()) return coarse;
    try {
        LabelledTriangles out = DelaunayRefinement(coarse).run();
        constexpr double max_area_error = 1e-10;  // derived from double precision: a missing triangle is larger
        if (std::abs(area_of(out) - area_of(coarse)) <= max_area_error * area_of(coarse)) return out;
    } catch (const std::exception&) {
        // a CGAL assertion failed: return the input
    }
    return coarse;
}

}  // namespace exitance
