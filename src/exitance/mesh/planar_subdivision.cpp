#include "exitance/mesh/planar_subdivision.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
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
void count_loops_around(Triangulation& t) {
    std::deque<Triangulation::Face_handle> open{t.infinite_face()};
    t.infinite_face()->info().value = 0;
    while (!open.empty()) {
        const auto face = open.front();
        open.pop_front();
        for (int i = 0; i < 3; ++i) {
            const auto next = face->neighbor(i);
            if (next->info().value >= 0) continue;
            const bool border = t.is_constrained({face, i});
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
    count_loops_around(t);
    for (const auto face : t.finite_face_handles()) {
        if (face->info().value % 2 == 0) continue;
        std::array<std::uint32_t, 3> corners;
        for (int i = 0; i < 3; ++i) corners[static_cast<std::size_t>(i)] = face->vertex(i)->info().value;
        if (std::find(corners.begin(), corners.end(), unnumbered) == corners.end()) out.push_back(corners);
    }
    return out;
}

}  // namespace exitance
