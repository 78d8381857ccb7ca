#pragma once

#include <span>

#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/visibility/critical_lines.hpp"
#include "exitance/visibility/visible_from_four.hpp"
#include "exitance/visibility/visible_lanes.hpp"
#include "exitance/visibility/visible_source.hpp"

namespace exitance {

/// Computes the same as VisibleSource, for many points of one convex receiver at a time. Blockers that hide nothing
/// from any of its points, and edges that never cross the source as seen from it, are removed once for all points. One
/// object per thread; can be reused for many pairs.
class VisibleFromMany {
  public:
    enum class Outlook : std::uint8_t { hidden, clear, partly };

    /// Sets a receiver (in the coordinates of its plane), a source, and the blockers that may be in between. Every
    /// blocker and the source must be entirely in front of the receiver's plane; every blocker and the receiver,
    /// entirely in front of the source's. Keeps references. Returns `hidden` if one blocker hides all of the source
    /// from all points, `clear` if none hides any of it, both only if certain. About 0.5 us per blocker.
    Outlook set(const PlaneFrame& frame, std::span<const Vec2> receiver, std::span<const Point> source,
                std::span<const ConvexBlocker* const> blockers);

    /// The remaining blockers, with their edges that may cross the source.
    std::span<const SeenEdges> seen_edges() const { return seen_edges_; }

    /// Computes the form factors from points of the receiver to the visible part of the source.
    /// points  in the receiver's plane coordinates, metres
    /// ends  index of the end of each group of points with probably the same visibility, such as the points of one
    /// cell; the last entry is the number of points
    /// F, seen  receive the form factors and visibility classes; same size as `points`
    /// 20 to 100 ns per point; 400 ns if there are many blockers in between and visibility differs within groups.
    void operator()(std::span<const Vec2> points, std::span<const std::size_t> ends, std::span<double> F,
                    std::span<Seen> seen);

    /// Form factor without occluders.
    double unoccluded(Vec2 p);

  private:
    using Affine = SightTables::Affine;
    using Line = SightTables::Line;

    enum class Kept : std::uint8_t { nothing, hides_all, some };
    Kept add_blocker(const ConvexBlocker& shape);
    bool add_faces(const ConvexBlocker& shape, SightTables::Blocker& blocker);
    bool add_line(Line line, const ConvexBlocker::Edge& e, bool turned, std::uint32_t edge);
    bool find_outline(const ConvexBlocker::Edge& e, bool is_sheet, Line& line, bool& turned) const;
    /// A directed line from which signed heights are measured.
    struct Axis {
        Vec3 along, moment;
        Axis(const Vec3& a, const Vec3& d) : along(d), moment(cross(d, a)) {}
        Affine height(const Vec3& p) const;
    };
    /// Bit masks over functions: which values the functions take on the receiver, judged at its corners.
    struct Signs {
        std::uint32_t above = 0,
                      below = 0;  ///< above: functions that exceed `none` somewhere; below: less than -none somewhere.
        std::uint32_t away = 0;   ///< Functions whose absolute value exceeds `nil` somewhere.
    };
    Signs signs(const Affine& f, double none, double nil) const;
    template <class Heights>
    Signs add_heights(std::size_t stride, std::size_t place, double none, double nil, const Heights& heights);
    void set_source(std::span<const Point> source);
    void join(std::size_t k, std::size_t j);
    Vec3 place(const Point& p) const;
    void look_otherwise(std::span<const Vec2> points, std::span<double> F, std::span<Seen> seen);

    PlaneFrame frame_{{}, {0, 0, 1}};
    std::vector<double> receiver_u_, receiver_v_;  ///< Coordinates of the receiver's corners in `frame_`.
    std::span<const Point> source_;
    std::span<const ConvexBlocker* const> blockers_;
    double reach_ = 0;     ///< Upper bound of the distance between any two points involved, metres.
    double one_line_ = 0;  ///< Share of `reach_`: edges closer than this from everywhere count as one line.
    SightTables tables_;
    std::vector<std::uint32_t> edges_;    ///< Per line: its edge, as an index into the blocker's edges.
    std::vector<std::uint32_t> crossed_;  ///< Per line: its value of SeenEdges::edges_over_corners.
    std::vector<std::uint32_t> corners_crossed_;
    /// x, y, z of the source's corners, of its edges, and of the moments of these edges, padded to groups of four.
    std::array<std::vector<double>, 9> source_columns_;
    std::vector<SeenEdges> seen_edges_;
    std::vector<Vec3> points_;  ///< Corners of the current blocker, in the receiver's frame.
    enum class Facing : std::uint8_t { back, front, turning };
    std::vector<Facing> facing_;  ///< Per face of the blocker: its orientation to the whole receiver.
    /// Per face that is front-facing from some points only: its index in the tables.
    std::vector<std::uint32_t> turning_;
    EdgeTerms terms_;
    bool is_crowded_ = false;  ///< True if the tables are too small for all blockers, lines or corners.
    bool single_is_set_ = false;
    VisibleFromFour from_four_;  ///< Used if many shadows overlap on the source.
    VisibleSource single_;       ///< Used if edges coincide, or if the visibility of the points differs.
};

}  // namespace exitance
