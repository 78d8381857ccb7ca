#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/view_factors/pair_sampler.hpp"
#include "exitance/view_factors/raw_row.hpp"
#include "exitance/view_factors/row_caster.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// Computes one row of view factors so that sqrt(sum_j v_ij) + sum_j |c_ij| <= R once it is combined with the other
/// rows: v the variance of what is sampled, c the bound of what is integrated. Three estimators share a row:
///
///   - pairs that nothing stands between: the closed form (PairFormFactor);
///   - partly hidden pairs that are apart: the unoccluded factor times a visible share by shadow rays (PairSampler);
///   - all others, near ones and the many small ones: rays cast from the face (RowCaster).
///
/// A pilot that is not used in the result decides which pairs are treated one by one and how many samples each gets:
/// the least cost for the variance allowed. Results depend on the scene, the row, R and the seed alone. One object
/// serves one thread.
class RowEstimator {
  public:
    RowEstimator(const RowScene& scene, double error, std::uint64_t seed, const StopRequest& stop);

    /// The row of a face; nothing when a stop is requested meanwhile.
    /// round  repeats have other random numbers       share  of R that the row may use
    std::optional<RawRow> operator()(std::size_t face, std::uint32_t round, double share);

  private:
    /// A pair that is treated by itself, or, if `to_cast`, by the cast after all.
    struct Pair {
        std::uint32_t column;
        double unoccluded = 0;  ///< F_ij with nothing between.
        double visible = 0;     ///< Share that the pilot saw.
        std::size_t batches = 0, rays_a_batch = 0;
        bool is_exact = false, to_cast = false;
        double left = 1;  ///< Share of the variance that is left once both estimates are combined.
        double deviation() const;
    };
    struct Plan {
        std::size_t batches = 0, rays_a_batch = 0;  ///< Of the cast.
    };

    void find_candidates(std::size_t face);
    double left_of_cast(std::size_t face, std::uint32_t column) const;
    double left_of_pair(std::size_t face, std::uint32_t column) const;
    double combined_error(const RawRow& row) const;
    bool may_be_under(std::size_t face, std::size_t other) const;
    double smallest_candidate(std::size_t face, double variance) const;
    void classify(std::size_t face, std::uint32_t round);
    View view_of(std::size_t face, std::size_t other);
    void classify_pair(std::size_t face, Pair& pair, std::uint32_t round);
    Plan plan(double variance);
    RawRow measure(std::size_t face, std::uint32_t round, const Plan& plan);

    const RowScene& scene_;
    double error_;
    std::uint64_t seed_;
    const StopRequest& stop_;
    RowCaster caster_;
    PairSampler sampler_;
    Shaft shaft_;
    std::vector<PieceId> blockers_;
    struct Candidate {
        double about;  ///< F_ij with nothing between, from the faces' middles.
        std::uint32_t column;
    };
    std::vector<Candidate> candidates_;
    bool under_others_ = false;  ///< Some of the face may be covered.
    std::vector<RowCaster::Count> pilot_;
    std::vector<Pair> pairs_;
    double rest_ = 0;  ///< Pilot's sum of the entries that are left to the cast, each times left_of_cast.
};

}  // namespace exitance
