#pragma once

#include <array>
#include <deque>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/view_factors/cluttered_pair.hpp"
#include "exitance/view_factors/occluded_pair.hpp"
#include "exitance/view_factors/view_pairs.hpp"

namespace exitance {

/// Computes view factors, a row or an entry at a time, with scratch memory of its own. One object serves one thread;
/// results do not depend on what it computed before.
class RowWorker {
  public:
    RowWorker(const ViewPairs& pairs, double tolerance, const StopRequest& stop)
        : pairs_(pairs), tolerance_(tolerance), stop_(stop), exchange_(stop), cluttered_exchange_(stop) {}

    /// All of a row, from points of its own face (of a much smaller one, where that sees more evenly). What it holds
    /// when a stop is requested is of no use.
    void compute(std::size_t i, std::span<double> row);

    enum class Means : std::uint8_t {
        usual,
        without_lines,  ///< Cells are halved where that changes something, and no critical lines are sought.
        patient,        ///< The same, up to 25 times as long.
    };
    /// F_ij by itself, to another tolerance.
    double entry(std::size_t i, std::size_t j, double tolerance, Means means);

  private:
    static constexpr int most_points = 8;  ///< Gauss points a side; nearer pairs take the contour integral.

    int points_for(const ViewFace& receiver, const ViewFace& source) const;
    double occluded(std::size_t i, std::size_t j, std::span<const std::uint32_t> blockers, bool& unoccluded);
    double occluded_pieces(const ViewFace& receiver, const ViewFace& source, std::span<const Point> r,
                           std::span<const Point> s, bool& unoccluded);
    void add_clipped(ConvexBlocker&& part, const ViewFace& receiver, const ViewFace& source);
    void add_unoccluded(std::size_t i, std::size_t j, bool cut);
    void flush_batches(std::size_t i, std::span<double> row);
    void make_nodes(const ViewFace& receiver, int points);

    struct Batch {
        QuadBatch quads;
        std::vector<std::uint32_t> faces;
    };
    struct Node {
        Point at;
        double weight;
    };

    const ViewPairs& pairs_;
    double tolerance_;
    const StopRequest& stop_;
    std::vector<std::uint32_t> of_row_, of_pair_;
    std::array<Batch, most_points + 1> batches_;
    std::vector<std::uint32_t> exact_;  ///< Unoccluded pairs for the contour integral.
    std::vector<Node> nodes_;
    std::vector<double> values_;
    std::vector<const ConvexBlocker*> standing_between_;
    std::deque<ConvexBlocker> clipped_;
    std::vector<Point> front_r_, front_s_;
    OccludedExchange exchange_;
    ClutteredExchange cluttered_exchange_;
    static constexpr std::size_t usual_evaluations = 20'000;  ///< Of a pair among much clutter.
    std::size_t most_evaluations_ = usual_evaluations;
    bool is_alone_ = false;      ///< Is an entry at hand that is known to matter?
    bool is_cluttered_ = false;  ///< May many things hide some of the pair at hand?
};

}  // namespace exitance
