#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/visibility/critical_lines.hpp"
#include "exitance/visibility/visible_from_many.hpp"

namespace exitance {

/// Two convex polygons and what may stand between them.
struct OccludedPair {
    std::span<const Point> receiver, source;  ///< Each wholly in front of the other's plane, 3 to 12 corners, metres.
    Plane receiver_plane, source_plane;
    std::span<const ConvexBlocker* const> blockers;
};

/// What the quadrature of a partly hidden pair is to reach.
struct Demand {
    double relative = 1e-4;             ///< Error over the pair's exchange area.
    double absolute = 0;                ///< m^2: an error that never matters.
    double ignored = 0;                 ///< m^2: smaller exchange areas need no digits.
    double large = 0;                   ///< m^2: larger exchange areas are integrated with more care.
    double dominating = 0;              ///< m^2: still larger ones make the error of their row.
    std::size_t most_cells = SIZE_MAX;  ///< Of the receiver: where lines cut it into more, they do not pay.
};

/// Integrates the exact visible part of a source over a receiver. The receiver is cut along the lines where the visible
/// part changes its corners; within the cells the integrand is smooth and Gauss rules converge fast. Cells whose
/// embedded rules disagree are halved. One object serves one thread and many pairs.
class OccludedExchange {
  public:
    /// What is computed when a stop is requested is of no use.
    explicit OccludedExchange(const StopRequest& stop) : stop_(stop) {}

    /// A_i F_ij, m^2; nothing when lines would cut the receiver into more cells than the demand has it. `unoccluded`
    /// tells that nothing stands between after all; the value is then left to others.
    std::optional<double> operator()(const OccludedPair& pair, const Demand& demand, bool& unoccluded);

    std::size_t evaluations = 0;  ///< Exact visible parts so far.

  private:
    /// What the points of a rule saw.
    struct Glance {
        std::size_t count = 0, lit = 0, dark = 0;  ///< Of how many points, seeing all, hidden by one blocker alone.
        std::size_t black = 0;                     ///< Seeing nothing.
        double lowest = HUGE_VAL, highest = 0;
        void take(double F, Seen seen);
    };

    /// A convex part of the receiver. Copies take along the corners that there are.
    struct Part {
        static constexpr std::size_t most = 16;
        std::size_t count = 0;
        std::array<Vec2, most> corner;

        Part() = default;
        Part(const Part& other) { *this = other; }
        Part& operator=(const Part& other) {
            count = other.count;
            for (std::size_t i = 0; i < count; ++i) corner[i] = other.corner[i];
            return *this;
        }
        void add(Vec2 p) {
            if (count < most) corner[count++] = p;
        }
        std::span<const Vec2> corners() const { return std::span(corner).first(count); }
    };
    /// A triangle or quadrilateral of it.
    struct Cell {
        std::size_t count = 0;
        std::array<Vec2, 4> corner;
        double area = 0, two_points = 0;  ///< m^2; the second is the integral by two Gauss points a side.
        double middle = 0;                ///< Form factor to what is seen from the middle.
        Glance glance;
        bool complete = false;  ///< No critical line that crosses it was left out.

        void add(Vec2 p) { corner[count++] = p; }
        std::span<const Vec2> corners() const { return std::span(corner).first(count); }
    };
    /// A cell that is not done.
    struct Task {
        Cell cell;
        double distance, allowed;  ///< Metres to the source; m^2.
        double sum;                ///< m^2, by the best rule so far.
        Glance glance;             ///< Of that rule.
        int depth;
        /// m^2, of a cell that is too near to the source for rules: the exact integral with nothing in between, from
        /// which a rule takes what is hidden. Negative for other cells.
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

    static constexpr double nearest_line = 1e-6;  ///< Of the receiver's size: lines nearer to each other are one.
    const StopRequest& stop_;
    OccludedPair pair_;
    PlaneFrame frame_{{}, {0, 0, 1}};
    VisibleFromMany visible_;
    std::vector<Vec2> nodes_;
    std::vector<double> weights_, factors_;  ///< m^2; form factors from the nodes.
    std::vector<Seen> seen_;
    std::vector<std::size_t> lasts_;  ///< Where the nodes of each cell end.
    std::vector<double> befores_;
    std::vector<Task> tasks_, halves_;
    std::vector<Cell*> looking_;
    CriticalLineFinder finder_;
    std::vector<CriticalLine> lines_;
    std::vector<Part> parts_;
    std::vector<Cell> cells_;
    double size_ = 0, source_area_ = 0, receiver_area_ = 0;
    double ignored_ = 0;
    double brightest_seen_ = 0;  ///< The largest form factor, or what may have been missed.
    double relative_ = 0;
    bool matters_ = false, dominates_ = false;
    std::size_t most_cells_ = 0;
    std::size_t enough_ = 0;  ///< Evaluations after which nothing is halved any more: a bound on the worst pairs.
};

}  // namespace exitance
