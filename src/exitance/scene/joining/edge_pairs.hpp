#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/scene/joining/face_mesh.hpp"

namespace exitance {

/// Finds which faces of a set can be joined: those in one plane, of one material and one orientation, that share an
/// edge or a part of one. Edges are numbered over the corners of these faces, and faces by their index in the set.
/// Expected O(n log n) in edges.
class EdgePairs {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;
    struct Edge {
        std::uint32_t from, to, face;
        std::uint32_t partner;  ///< The edge in the opposite direction between the same points, of a joined face.
        std::uint32_t twin;     ///< The previous edge between the same two points, in either direction, or none.
    };
    /// A corner of another face in the interior of an edge, `at` metres from the start of the edge.
    struct Split {
        std::uint32_t edge;
        double at;
        std::uint32_t point;
        auto operator<=>(const Split&) const = default;
    };

    /// `faces` are indices into the mesh. All arguments must outlive the object.
    EdgePairs(const FaceMesh& mesh, const Tolerances& tolerances, std::span<const std::uint32_t> faces);

    /// Range [first, second) of the edges of face f.
    std::pair<std::uint32_t, std::uint32_t> edges_of(std::uint32_t f) const {
        return {first_edge_[f], first_edge_[f + 1]};
    }
    const Edge& edge(std::uint32_t e) const { return edges_[e]; }
    /// Splits of edge e, in order along the edge.
    std::span<const Split> splits(std::uint32_t e) const;
    /// Smallest index of the faces that are joined to f.
    std::uint32_t root(std::uint32_t f) { return sets_.root(f); }

  private:
    /// An unpaired edge under one of the keys of its line. One edge represents all between the same two points.
    struct LineEntry {
        std::uint32_t key;
        std::uint32_t edge;
        auto operator<=>(const LineEntry&) const = default;
    };
    /// Error bounds for the line through an edge: of its direction, radians, and of its point nearest to the centre,
    /// metres.
    struct LineErrors {
        double direction, foot;
    };
    /// Projection of an edge onto a direction. `against`: the edge points against `forward`; `behind`: so does its
    /// face's normal.
    struct Interval {
        double lo, hi;
        std::uint32_t edge;
        bool against, behind;
    };

    const Point& point(std::uint32_t i) const { return mesh_.points[i]; }
    std::uint32_t material(std::uint32_t f) const { return mesh_.material[faces_[f]]; }
    bool coplanar(std::uint32_t f, std::uint32_t g) const;
    void pair_whole_edges();
    void pair_parts_of_edges();
    std::vector<LineEntry> line_entries() const;
    void find_extent();
    LineErrors line_errors(std::uint32_t edge) const;
    unsigned grade(std::uint32_t edge) const;
    template <class Take>
    void each_line_key(std::uint32_t edge, unsigned grade, const Take& take) const;
    void add_unpaired_twins(std::uint32_t edge, std::vector<std::uint32_t>& out) const;
    static double crowding(const std::vector<Interval>& intervals);
    std::vector<Interval> intervals_along(const Vec3& d, std::span<const std::uint32_t> group) const;
    void pair_on_line(std::span<const std::uint32_t> group);
    bool pair_parts(std::uint32_t e, std::uint32_t f);
    void split_at_ends(std::uint32_t e, std::uint32_t other, const Vec3& d, double length);

    const FaceMesh& mesh_;
    const Tolerances& tol_;
    std::span<const std::uint32_t> faces_;
    Point centre_{0, 0, 0};  ///< Centre of most edges, origin for the position of lines.
    double size_ = 0;        ///< Extent of most edges, metres.
    DisjointSets sets_;
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> first_edge_;
    std::vector<Split> splits_;
};

}  // namespace exitance
