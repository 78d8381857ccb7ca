#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/view_factors/accuracy.hpp"
#include "exitance/view_factors/pair_sampler.hpp"
#include "exitance/view_factors/raw_row.hpp"
#include "exitance/view_factors/row_caster.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// Required accuracy of rows.
struct RowDemand {
    double error = default_row_error;  ///< R, limit on the error of a row.
    double missed_error =
        default_row_error;  ///< Limit on the standard deviations of the shares of the sky and of backs.
    double deviations = 0;  ///< A row exceeds R as rarely as a normal variable exceeds this, see ClosedVariance.
};

/// Computes one row of view factors with the error R that it has after it is combined with the other rows: sqrt(L) +
/// sum_j |c_ij| <= R, where L is the limit of the sampled entries (ClosedVariance::limit) and c the error bound of
/// integrated ones. A row uses three estimators:
///
///   - for unoccluded pairs, the closed form (PairFormFactor);
///   - for partly hidden pairs that are not near, the unoccluded factor times a visible share by shadow rays
/// (PairSampler);
///   - for all others, near pairs and the many small ones, rays cast from the face (RowCaster).
///
/// A pilot, which does not enter the result, decides which pairs are treated one by one and how many samples each gets,
/// to reach the allowed variance at the least cost. Results depend only on the scene, the row, R and the seed. One
/// object serves one thread.
class RowEstimator {
  public:
    RowEstimator(const RowScene& scene, const RowDemand& demand, std::uint64_t seed, const StopRequest& stop);

    /// Computes the row of a face; empty if a stop is requested meanwhile.
    /// round  repetitions use other random numbers
    /// share  share of R that the row may use
    /// before  an estimate of the row with which the new samples are pooled; null: none
    std::optional<RawRow> operator()(std::size_t face, std::uint32_t round, double share, const RawRow* before);

  private:
    /// A pair that is treated individually, unless `to_cast` returns it to the cast rays.
    struct Pair {
        std::uint32_t column;
        double unoccluded = 0;  ///< F_ij without occlusion.
        double visible = 0;     ///< Visible share found by the pilot.
        std::size_t batches = 0, rays_a_batch = 0;
        bool is_exact = false, to_cast = false;
        double left = 1;  ///< Share of the variance that remains after both rows' estimates are combined.
        double deviation() const;
    };
    struct Plan {
        /// Number of batches of rays cast for the whole row, and of rays per batch.
        std::size_t batches = 0, rays_a_batch = 0;
    };

    struct Candidate {
        double about;  ///< F_ij without occlusion, from the faces' centres.
        std::uint32_t column;
    };

    void find_candidates(std::size_t face);
    double left_of_cast(std::size_t face, std::uint32_t column) const;
    double left_of_pair(std::size_t face, std::uint32_t column) const;
    double combined_limit(const RawRow& row) const;
    bool may_be_under(std::size_t face, std::size_t other) const;
    double smallest_candidate(std::size_t face, double variance);
    void classify(std::size_t face, std::uint32_t round);
    bool has_many_pieces(std::size_t face, const Candidate& candidate) const;
    double unoccluded_exchange(std::size_t face, std::size_t other, const ConvexParts& own_pieces,
                               const ConvexParts& other_pieces) const;
    View view_of(std::size_t face, std::size_t other, const ConvexParts& own_pieces, const ConvexParts& other_pieces);
    void classify_pair(std::size_t face, Pair& pair, std::uint32_t round);
    Plan plan(double limit);
    void add_rest(double share) {
        rest_ += share, rest_squares_ += share * share, rest_cubes_ += share * share * share;
    }
    RawRow measure(std::size_t face, std::uint32_t round, const Plan& plan);

    const RowScene& scene_;
    double error_, missed_error_, deviations_;
    std::uint64_t seed_;
    const StopRequest& stop_;
    RowCaster caster_;
    PairSampler sampler_;
    Shaft shaft_;
    std::vector<PieceId> blockers_;
    std::array<ConvexParts, 2> cut_;  ///< Pieces of a pair of faces without hidden parts.
    std::vector<Candidate> candidates_;
    bool under_others_ = false;  ///< True if another face may cover part of the face.
    std::vector<RowCaster::Count> pilot_;
    std::vector<double> seen_by_pilot_;  ///< Scratch of smallest_candidate(), one entry per face; zero between calls.
    std::vector<Pair> pairs_;
    double rest_squares_ = 0, rest_cubes_ = 0;  ///< Sums of the squares and cubes of the terms of rest_.
    double missed_ = 0;                         ///< Pilot's share of rays that hit no front.
    double missed_deviation_ = 0;  ///< Variance per ray of the sky's or the back's share, the larger of the two.
    /// Pilot's sum of F (1 - F) over the entries F that are left to cast rays, each times left_of_cast.
    double rest_ = 0;
};

}  // namespace exitance
