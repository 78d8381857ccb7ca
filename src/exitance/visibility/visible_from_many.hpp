#pragma once

#include <span>

#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/visibility/critical_lines.hpp"
#include "exitance/visibility/visible_from_four.hpp"
#include "exitance/visibility/visible_lanes.hpp"
#include "exitance/visibility/visible_source.hpp"

namespace exitance {

/// What VisibleSource computes, for many points of one convex receiver at a time. Blockers that hide nothing from any
/// of its points, and edges that never cross the source as seen from there, are left out once for all of them. One
/// object serves one thread and many pairs.
class VisibleFromMany {
  public:
    enum class Outlook : std::uint8_t { hidden, clear, partly };

    /// Takes a receiver (in its plane's frame), a source, and the blockers that may stand in its light. All of every
    /// blocker and of the source lies in front of the receiver's plane, all of every blocker and of the receiver in
    /// front of the source's. Keeps references. Tells whether one blocker hides all of the source from all points, or
    /// none any; certain when it says so. About 0.5 us a blocker.
    Outlook set(const PlaneFrame& frame, std::span<const Vec2> receiver, std::span<const Point> source,
                std::span<const ConvexBlocker* const> blockers);

    /// The blockers that are left, and their edges that may cross the source.
    std::span<const SeenEdges> seen_edges() const { return seen_edges_; }

    /// Form factors from points of the receiver to the visible part of the source, and how much that is; `points`, `F`
    /// and `seen` of one size. `ends` tells where groups of points end that probably see alike, as those of a cell do;
    /// the last one is the number of points. 20 to 100 ns a point, where much stands in between and a group's points
    /// do not see alike 400.
    void operator()(std::span<const Vec2> points, std::span<const std::size_t> ends, std::span<double> F,
                    std::span<Seen> seen);

    /// The same as if nothing stood in the way.
    double unoccluded(Vec2 p);

  private:
    using Affine = SightTables::Affine;
    using Line = SightTables::Line;

    enum class Kept : std::uint8_t { nothing, hides_all, some };
    Kept add_blocker(const ConvexBlocker& shape);
    bool add_faces(const ConvexBlocker& shape, SightTables::Blocker& blocker);
    bool add_line(Line line, const ConvexBlocker::Edge& e, bool turned, std::uint32_t edge);
    bool find_outline(const ConvexBlocker::Edge& e, bool is_sheet, Line& line, bool& turned) const;
    /// A directed line, by which heights over it are told.
    struct Axis {
        Vec3 along, moment;
        Axis(const Vec3& a, const Vec3& d) : along(d), moment(cross(d, a)) {}
        Affine height(const Vec3& p) const;
    };
    /// What values of functions are found on the receiver, a bit a function; its corners decide.
    struct Signs {
        std::uint32_t above = 0, below = 0;  ///< More than `none`, less than -none.
        std::uint32_t away = 0;              ///< Farther from 0 than `nil`.
    };
    Signs signs(const Affine& f, double none, double nil) const;
    template <class Heights>
    Signs add_heights(std::size_t stride, std::size_t place, double none, double nil, const Heights& heights);
    void set_source(std::span<const Point> source);
    void join(std::size_t k, std::size_t j);
    Vec3 place(const Point& p) const;
    void look_otherwise(std::span<const Vec2> points, std::span<double> F, std::span<Seen> seen);

    PlaneFrame frame_{{}, {0, 0, 1}};
    std::vector<double> receiver_u_, receiver_v_;  ///< Its corners.
    std::span<const Point> source_;
    std::span<const ConvexBlocker* const> blockers_;
    double reach_ = 0;  ///< Metres between any two of the places at hand, at most.
    SightTables tables_;
    std::vector<std::uint32_t> edges_;    ///< Of each line, in its blocker's.
    std::vector<std::uint32_t> crossed_;  ///< By each line, as SeenEdges wants it.
    std::vector<std::uint32_t> corners_crossed_;
    /// x, y, z of the source's corners, of its edges, and of these edges' moments, filled up to groups of four.
    std::array<std::vector<double>, 9> source_columns_;
    std::vector<SeenEdges> seen_edges_;
    std::vector<Vec3> points_;  ///< Of the blocker at hand, in the receiver's frame.
    enum class Facing : std::uint8_t { back, front, turning };
    std::vector<Facing> facing_;          ///< Its faces, as all of the receiver sees them.
    std::vector<std::uint32_t> turning_;  ///< Where those that turn stand in the tables.
    EdgeTerms terms_;
    bool is_crowded_ = false;  ///< More in between than the tables take.
    bool single_is_set_ = false;
    VisibleFromFour from_four_;  ///< Where many shadows lie on the source at once.
    VisibleSource single_;       ///< And edges fall together, or points do not see alike.
};

}  // namespace exitance
