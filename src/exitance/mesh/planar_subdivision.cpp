#include "exitance/mesh/planar_subdivision.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <deque>

namespace exitance {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr std::uint32_t unnumbered = 0xffffffffu;
struct Number {
    std::uint32_t value = unnumbered;
};
struct Depth {
    int value = -1;  ///< How many loops lie between the face and infinity; odd: inside.
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Number, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<Depth, Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;

/// Gives every face the number of loops around it, going inwards from the infinite face.
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
                open.push_back(next);  // after everything on this side of the border
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

/// What a face of the labelled triangulation carries: depth, number, labels of the edges opposite its vertices.
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

/// Writes the least label of each line onto the faces beside its edges.
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

LabelledTriangles take_inside(Lines& t) {
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
        return {};  // CGAL's assertions
    }
}

}  // namespace exitance
