#pragma once

#include <array>
#include <vector>

#include "exitance/view_factors/occluded_pair.hpp"

namespace exitance {

/// Integrates the exact visible part of a source over a receiver where much stands in between: critical lines would cut
/// the receiver into thousands of cells, most of which hardly matter. Cells of the receiver are looked from by three
/// rules, and the one on which these differ most is halved, until what is left is small. Each half sees past fewer
/// blockers than its cell, and a source before many is halved, too, so that a point meets few of them at a time.
/// Jumps are sought: the receiver is cut along the borders of what stands on it. Under edges that pass within a cell's
/// size, rules that agree are not believed: what stands a finger's breadth before a wall darkens a strip that no point
/// of a large cell may meet. One object serves one thread and many pairs.
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
    /// turned  other points are looked from: this is the pair's second look from the same face
    double operator()(const OccludedPair& pair, const Allowance& allowance, bool turned, bool& unoccluded);

    std::size_t evaluations = 0;  ///< Points from which a part of a source was looked at, so far.

  private:
    using Part = std::vector<Vec2>;
    using Blockers = std::vector<const ConvexBlocker*>;

    /// A part of the source, and what may stand before it as seen from a cell: nothing where it is clear.
    struct SourcePart {
        std::vector<Point> outline;
        Blockers blockers;
        int depth;  ///< Halvings of the source.
    };
    struct Cell {
        std::array<Vec2, 4> corner;
        std::uint32_t count;
        double integral = 0, error = 0;   ///< m^2; the second about.
        std::vector<SourcePart> sources;  ///< Without what is hidden for certain.
        std::span<const Vec2> corners() const { return std::span(corner).first(count); }
        bool operator<(const Cell& other) const { return error < other.error; }
    };

    void cut_along_contacts(double slack);
    void add_cells(const std::vector<SourcePart>& sources);
    void place_nodes(const Cell& cell);
    void look(Cell& cell, const std::vector<SourcePart>& sources);
    void add_source(Cell& cell, const SourcePart& source);
    bool add_halves(Cell& cell, const SourcePart& source);
    Blockers seen_blockers() const;
    void judge(Cell& cell);
    double exact(const Cell& cell) const;
    void halve_worst();
    void find_edges(double slack);
    void cut_along(Vec2 p, Vec2 q, double slack);
    void cut_under_edges(double slack);
    double share_under_edges(const Cell& cell) const;
    double unseen(const Cell& cell) const;

    const StopRequest& stop_;
    OccludedPair pair_;
    PlaneFrame frame_{{}, {0, 0, 1}};
    VisibleFromMany visible_;
    std::vector<Part> parts_, next_;
    std::vector<Cell> heap_;  ///< The largest error first.
    struct Edge {
        Point low, high;  ///< Its ends in the receiver's frame: two coordinates and the height.
    };
    std::vector<Edge> edges_;  ///< Of the blockers, off the receiver, by their lower ends' heights.
    std::vector<Vec2> nodes_;
    std::vector<double> weights_, values_, factors_;  ///< m^2; form factors to all of the source, to a part of it.
    std::vector<Seen> seen_;
    std::vector<std::size_t> ends_;  ///< Of the rules' nodes.
    double area_ = 0, total_ = 0, squared_error_ = 0, relative_ = 0;
    double brightest_ = 0;  ///< The largest form factor seen, or what may have been missed.
    bool all_lit_ = true, turned_ = false;
};

/// How unevenly a plane's points see past blockers: lengths of their edges over their heights. Of two faces the one
/// with less is to receive. No face is counted closer than 0.002 of `size` (metres).
double crowding(const Plane& plane, double size, std::span<const ConvexBlocker* const> blockers);

}  // namespace exitance
