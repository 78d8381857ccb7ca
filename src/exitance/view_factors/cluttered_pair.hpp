#pragma once

#include <array>
#include <vector>

#include "exitance/view_factors/occluded_pair.hpp"

namespace exitance {

/// Integrates the exact visible part of a source over a receiver where much stands in between: critical lines would cut
/// the receiver into thousands of cells, most of which hardly matter. Cells are halved where that changes their
/// integral most, until what changes is small; bends are not sought, but are met from many sides, so that what they
/// leave has no common sign. Jumps are sought: the receiver is cut along the borders of what stands on it. Under edges
/// that pass within a cell's size, halves that agree are not believed: what stands a finger's breadth before a wall
/// darkens a strip that no point of a large cell may meet. One object serves one thread and many pairs.
class ClutteredExchange {
  public:
    /// What is computed when a stop is requested is of no use.
    explicit ClutteredExchange(const StopRequest& stop) : stop_(stop) {}

    /// The error that may be left, as it is estimated: the larger of the first two.
    struct Allowance {
        double relative = 1e-4;                 ///< Of the value.
        double absolute = 0;                    ///< m^2
        double ignored = 0;                     ///< m^2: smaller values need no digits.
        std::size_t most_evaluations = 20'000;  ///< A bound on the worst pairs.
    };

    /// A_i F_ij, m^2, of a pair as for OccludedExchange. `unoccluded` tells that nothing was seen to stand between; the
    /// value is then left to others.
    /// ratio  where cells are cut in two: with another ratio other points are looked from
    double operator()(const OccludedPair& pair, const Allowance& allowance, double ratio, bool& unoccluded);

    std::size_t evaluations = 0;  ///< Exact visible parts so far.

  private:
    struct Cell {
        std::array<Vec2, 4> corner;
        std::uint32_t count;
        double integral;  ///< m^2, by two Gauss points a side.
        double error;     ///< m^2, about.
        bool operator<(const Cell& other) const { return error < other.error; }
    };

    using Part = std::vector<Vec2>;

    void cut_along_contacts(double slack);
    void add_cells();
    void look(Cell& cell);
    void halve_worst();
    void find_edges(double slack);
    void cut_along(Vec2 p, Vec2 q, double slack);
    void cut_under_edges(double slack);
    double share_under_edges(const Cell& cell) const;
    double unseen(const Cell& cell) const;
    double dark(const Cell& cell);
    double visible_at(Vec2 p, double weight);

    const StopRequest& stop_;
    OccludedPair pair_;
    PlaneFrame frame_{{}, {0, 0, 1}};
    VisibleSource visible_;
    std::vector<Part> parts_, next_;
    std::vector<Cell> heap_;  ///< The largest error first.
    struct Edge {
        Point a, b;   ///< In the receiver's frame: two coordinates and the height.
        bool is_cut;  ///< Has the receiver been cut along it?
    };
    std::vector<Edge> edges_;  ///< Of the blockers, off the receiver.
    double area_ = 0, ratio_ = 0.5, total_ = 0, squared_error_ = 0;
    double brightest_ = 0;  ///< The largest form factor seen, or what may have been missed.
    bool all_lit_ = true;
};

/// How unevenly a plane's points see past blockers: lengths of their edges over their heights. Of two faces the one
/// with less is to receive. No face is counted closer than 0.002 of `size` (metres).
double crowding(const Plane& plane, double size, std::span<const ConvexBlocker* const> blockers);

}  // namespace exitance
