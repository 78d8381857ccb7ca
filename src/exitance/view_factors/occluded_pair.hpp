#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/view_factors/accuracy.hpp"
#include "exitance/visibility/critical_lines.hpp"
#include "exitance/visibility/visible_from_many.hpp"

namespace exitance {

/// Cuts a convex polygon of three or four corners across its longest edge, at a ratio of its length, and a
/// quadrilateral also across the opposite edge. Both parts have as many corners as the polygon.
std::array<std::array<Vec2, 4>, 2> halves_of(std::span<const Vec2> corners, double ratio = 0.5);

/// Squared distance from a point x to the segment from a to b, m^2.
inline double squared_distance(const Point& x, const Point& a, const Point& b) {
    const Vec3 e = b - a, d = x - a;
    const double length = dot(e, e), t = length > 0 ? std::clamp(dot(d, e) / length, 0.0, 1.0) : 0;
    return dot(d - t * e, d - t * e);
}

/// Two convex polygons and their possible blockers.
struct OccludedPair {
    /// Convex polygons with 3 to 12 corners, each wholly in front of the other's plane, metres.
    std::span<const Point> receiver, source;
    Plane receiver_plane, source_plane;
    std::span<const ConvexBlocker* const> blockers;
};

/// Accuracy required of the quadrature of a partly hidden pair.
struct Demand {
    double relative = default_entry_error;  ///< Relative error of the pair's exchange area.
    double absolute = 0;                    ///< Error that is always accepted, m^2.
    double ignored = 0;                     ///< Smaller exchange areas need no accuracy, m^2.
    double large = 0;                       ///< m^2; larger exchange areas are integrated more carefully.
    double dominating = 0;                  ///< m^2; larger exchange areas largely determine the error of their row.
    /// Limit on the cells of the receiver: with more, critical lines are not worthwhile.
    std::size_t max_cells = SIZE_MAX;
};

/// Integrates the exact visible part of a source over a receiver. The receiver is cut along the critical lines at which
/// the visible part gains or loses corners. Within the cells the integrand is smooth, and Gauss rules converge fast.
/// Cells whose embedded rules disagree are halved. One object serves one thread and many pairs.
class OccludedExchange {
  public:
    /// After a stop request the results are meaningless.
    explicit OccludedExchange(const StopRequest& stop) : stop_(stop) {}

    /// A_i F_ij, m^2; empty if critical lines would cut the receiver into more than demand.max_cells cells. Sets
    /// `unoccluded` if no blocker is between the faces after all; the value is then 0 and must be computed otherwise.
    std::optional<double> operator()(const OccludedPair& pair, const Demand& demand, bool& unoccluded);

    std::size_t evaluations = 0;  ///< Evaluations of exact visible parts so far.

  private:
    /// Visibility of the source from the points of a rule.
    struct Glance {
        /// Number of points; of those that see the whole source; of those from which a single blocker hides all of it.
        std::size_t count = 0, lit = 0, dark = 0;
        std::size_t black = 0;  ///< Number of points that see nothing.
        double lowest = HUGE_VAL, highest = 0;
        void take(double F, Seen seen);
    };

    /// A convex part of the receiver. Copies only the used corners.
    struct Part {
        static constexpr std::size_t max_corners = 16;
        std::size_t count = 0;
        std::array<Vec2, max_corners> corner;

        Part() = default;
        Part(const Part& other) { *this = other; }
        Part& operator=(const Part& other) {
            count = other.count;
            for (std::size_t i = 0; i < count; ++i) corner[i] = other.corner[i];
            return *this;
        }
        void add(Vec2 p) {
            if (count < max_corners) corner[count++] = p;
        }
        std::span<const Vec2> corners() const { return std::span(corner).first(count); }
    };
    /// A triangle or quadrilateral of the receiver.
    struct Cell {
        std::size_t count = 0;
        std::array<Vec2, 4> corner;
        double area = 0, two_points = 0;  ///< m^2; the latter is the integral by 2 x 2 Gauss points.
        double middle = 0;                ///< Form factor from the centre to the visible part.
        Glance glance;
        bool complete = false;  ///< True if no critical line that crosses this cell was omitted.

        void add(Vec2 p) { corner[count++] = p; }
        std::span<const Vec2> corners() const { return std::span(corner).first(count); }
    };
    /// A cell whose integral is not accurate enough yet.
    struct Task {
        Cell cell;
        double distance, allowed;  ///< Distance to the source, metres; allowed error, m^2.
        double sum;                ///< Integral by the best rule so far, m^2.
        Glance glance;             ///< Visibility found by that rule.
        int depth;
        /// m^2: for a cell too near to the source for quadrature, the exact integral without occlusion, from which a
        /// rule subtracts the hidden part. Negative for other cells.
        double whole = -1;
    };

    void cut_into_cells(const Part& part, int depth);
    bool cut(const Part& part, const CriticalLine& line, Part& front, Part& back) const;
    double distance_to_source(const Cell& cell) const;
    double brightest(double d) const;
    bool is_under_an_edge(const Cell& cell) const;
    double convergence(const Cell& cell, double d) const;
    double integrate_smooth(const Cell& cell, double d, double allowed);
    void place_nodes(const Cell& cell, int points);
    void look_from_nodes();
    void look_at_cells(std::span<Cell* const> cells);
    void look_from_middles();
    bool is_settled_by_two_points(const Task& task) const;
    double share_left(const Task& task) const;
    double dark(const Cell& cell) const;
    void apply(int points);
    void halve(const Task& task);
    bool is_near(const Task& task, int points) const;
    double exact(const Cell& cell, double allowed) const;
    double settle_near_cells(int points);
    double integrate_tasks();

    /// Share of the receiver's size; lines nearer to each other are merged. Derived from the rounding of files.
    static constexpr double nearest_line = 1e-6;
    const StopRequest& stop_;
    OccludedPair pair_;
    PlaneFrame frame_{{}, {0, 0, 1}};
    VisibleFromMany visible_;
    std::vector<Vec2> nodes_;
    std::vector<double> weights_, factors_;  ///< Weights in m^2; form factors from the nodes.
    std::vector<Seen> seen_;
    std::vector<std::size_t> lasts_;  ///< End of each cell's nodes.
    std::vector<double> befores_;
    std::vector<Task> tasks_, halves_;
    std::vector<Cell*> looking_;
    CriticalLineFinder finder_;
    std::vector<CriticalLine> lines_;
    std::vector<Part> parts_;
    std::vector<Cell> cells_;
    double size_ = 0, source_area_ = 0, receiver_area_ = 0;
    double ignored_ = 0;
    double brightest_seen_ = 0;  ///< Largest form factor found, or a bound on the one that may have been missed.
    double relative_ = 0;
    bool matters_ = false, dominates_ = false;
    std::size_t max_cells_ = 0;
    /// Number of evaluations after which cells are not halved any more: limits the worst pairs.
    std::size_t enough_ = 0;
};

}  // namespace exitance
