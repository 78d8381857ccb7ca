#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/scene/joining/face_mesh.hpp"

namespace exitance {

/// Which of a set of faces lie in one plane side by side: those of one material and one orientation that share an edge,
/// or a part of one. Edges are numbered over the corners of these faces, faces by their place among them. Expected
/// O(n log n) in edges.
class EdgePairs {
  public:
    static constexpr std::uint32_t none = 0xffffffffu;
    struct Edge {
        std::uint32_t from, to, face;
        std::uint32_t partner;  ///< The edge that runs against it between the same points, of a face it is joined to.
        std::uint32_t twin;     ///< The edge before this one between the same two points, either way round, or none.
    };
    /// A corner of another face that lies inside an edge, `at` metres from where that begins.
    struct Split {
        std::uint32_t edge;
        double at;
        std::uint32_t point;
        auto operator<=>(const Split&) const = default;
    };

    /// `faces` of the mesh. All must outlive it.
    EdgePairs(const FaceMesh& mesh, const Tolerances& tolerances, std::span<const std::uint32_t> faces);

    /// The edges of face f, from the first to before the second.
    std::pair<std::uint32_t, std::uint32_t> edges_of(std::uint32_t f) const {
        return {first_edge_[f], first_edge_[f + 1]};
    }
    const Edge& edge(std::uint32_t e) const { return edges_[e]; }
    /// Those of edge e, in the order in which it meets them.
    std::span<const Split> splits(std::uint32_t e) const;
    /// The least face of those that are joined to f.
    std::uint32_t root(std::uint32_t f) { return sets_.root(f); }

  private:
    /// The first unpaired edge between two points under one of the keys of its line.
    struct LineEntry {
        std::uint32_t key;
        std::uint32_t edge;
        auto operator<=>(const LineEntry&) const = default;
    };
    /// How far off the line through an edge may be: its direction, and its point nearest to the centre, metres.
    struct LineErrors {
        double direction, foot;
    };
    /// How far an edge reaches along a direction; whether it runs against `forward`, whether its face looks so.
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
    Point centre_{0, 0, 0};  ///< That lines are told by, and
    double size_ = 0;        ///< how far most edges reach, metres.
    DisjointSets sets_;
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> first_edge_;
    std::vector<Split> splits_;
};

}  // namespace exitance
