#pragma once

#include <array>
#include <vector>

#include "exitance/view_factors/occluded_pair.hpp"

namespace exitance {

/// Integrates the exact visible part of a source over a receiver with many blockers, where critical lines would cut the
/// receiver into thousands of cells, most of which hardly matter. Three quadrature rules are applied to cells of the
/// receiver, and the cell on which they differ most is halved until the error is small. Each half has fewer relevant
/// blockers than its cell. A source behind many blockers is halved, too, so that few of them are relevant at a time.
/// Discontinuities are handled explicitly: the receiver is cut along its contacts with blockers. Below edges that pass
/// within a cell's size, agreeing rules are not trusted: a blocker a centimetre in front of a wall darkens a strip that
/// all points of a large cell may miss. One object serves one thread and many pairs.
class ClutteredExchange {
  public:
    /// After a stop request the results are meaningless.
    explicit ClutteredExchange(const StopRequest& stop) : stop_(stop) {}

    /// Allowed estimated error: the larger of `relative` and `absolute`.
    struct Allowance {
        double relative = default_entry_error;  ///< Share of the value.
        double absolute = 0;                    ///< m^2
        double ignored = 0;                     ///< Exchange areas below this need no accuracy, m^2.
        std::size_t max_evaluations = 20'000;   ///< Limit on the evaluations of a pair.
    };

    /// A_i F_ij of a pair, m^2; the pair must be as for OccludedExchange. Sets `unoccluded` if no blocker was found
    /// between the faces; the value is then 0 and must be computed otherwise.
    /// turned  use other sample points: this is the pair's second computation from the same face
    double operator()(const OccludedPair& pair, const Allowance& allowance, bool turned, bool& unoccluded);

    std::size_t evaluations = 0;  ///< Points from which parts of a source were evaluated, so far.

  private:
    using Part = std::vector<Vec2>;
    using Blockers = std::vector<const ConvexBlocker*>;

    /// A part of the source, and its possible blockers as seen from a cell: empty if it is unoccluded.
    struct SourcePart {
        std::vector<Point> outline;
        Blockers blockers;
        int depth;  ///< Number of halvings of the source.
    };
    struct Cell {
        std::array<Vec2, 4> corner;
        std::uint32_t count;
        double integral = 0, error = 0;   ///< Integral over the cell, and its estimated error, m^2.
        std::vector<SourcePart> sources;  ///< Parts of the source, without those that are certainly hidden.
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
    std::vector<Cell> heap_;  ///< Largest error first.
    struct Edge {
        Point low, high;  ///< End points in the receiver's frame: two coordinates and the height.
    };
    std::vector<Edge> edges_;  ///< Edges of the blockers, off the receiver, sorted by the height of their lower end.
    std::vector<Vec2> nodes_;
    /// Weights in m^2; form factors to the whole source; form factors to a part of it.
    std::vector<double> weights_, values_, factors_;
    std::vector<Seen> seen_;
    std::vector<std::size_t> ends_;  ///< Per rule: end of its nodes in `nodes_`.
    double area_ = 0, total_ = 0, squared_error_ = 0, relative_ = 0;
    double brightest_ = 0;  ///< Largest form factor found, or a bound on the one that may have been missed.
    bool all_lit_ = true, turned_ = false;
};

/// Measure of how much blockers make the view from a plane vary: the sum of their edges' lengths over their heights.
/// The face with the smaller value should be the receiver. Heights are at least 0.002 of `size` (metres).
double crowding(const Plane& plane, double size, std::span<const ConvexBlocker* const> blockers);

}  // namespace exitance
