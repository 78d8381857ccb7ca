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

/// Computes view factors by rows or by entries, with its own scratch memory. One object serves one thread; results do
/// not depend on earlier calls.
class RowWorker {
  public:
    RowWorker(const ViewPairs& pairs, double tolerance, const StopRequest& stop)
        : pairs_(pairs), tolerance_(tolerance), stop_(stop), exchange_(stop), cluttered_exchange_(stop) {}

    /// Computes row i from points of face i (or of a much smaller face, if the view from there varies less). After a
    /// stop request the contents of `row` are meaningless.
    void compute(std::size_t i, std::span<double> row);

    enum class Means : std::uint8_t {
        usual,
        without_lines,  ///< Find no critical lines; halve cells where the error is large.
        patient,        ///< Like without_lines, with up to 25 times as many evaluations.
    };
    /// Computes F_ij alone, with its own tolerance.
    double entry(std::size_t i, std::size_t j, double tolerance, Means means);

  private:
    static constexpr int max_points = 8;  ///< Gauss points per side, at most; nearer pairs use the contour integral.

    int points_for(const ViewFace& receiver, const ViewFace& source) const;
    bool has_hidden_parts(std::size_t i, std::size_t j) const;
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
    std::array<Batch, max_points + 1> batches_;
    std::vector<std::uint32_t> exact_;  ///< Unoccluded pairs that use the contour integral.
    std::vector<Node> nodes_;
    std::vector<double> values_;
    std::vector<const ConvexBlocker*> standing_between_;
    std::deque<ConvexBlocker> clipped_;
    std::vector<Point> front_r_, front_s_;
    std::array<ConvexParts, 2> cut_;  ///< Pieces of the receiver and the source without hidden parts.
    OccludedExchange exchange_;
    ClutteredExchange cluttered_exchange_;
    /// Limit on the evaluations of a pair with many blockers.
    static constexpr std::size_t usual_evaluations = 20'000;
    std::size_t max_evaluations_ = usual_evaluations;
    bool is_alone_ = false;      ///< True while entry() computes a single entry.
    bool is_cluttered_ = false;  ///< True if many blockers may hide parts of the current pair.
};

}  // namespace exitance
