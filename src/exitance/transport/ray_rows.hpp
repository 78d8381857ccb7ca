#pragma once

#include <vector>

#include "exitance/mesh/numbered_leaves.hpp"
#include "exitance/processes/fetched_values.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// Number of rays per element: larger elements, which contribute more to the error, get more rays.
struct RayBudget {
    double average = 64;  ///< Rays of an element of mean area.
    unsigned min = 16;
    unsigned max = 4096;
    /// For diffusing panes: true if rays leave only by the front, as emitted light does; false if they represent
    /// gathered light.
    bool front_alone = false;

    /// Number of rays for `area` if the mean area is `mean_area` (both m^2): a power of two, about proportional to
    /// sqrt(area), which minimizes the total variance for a given number of rays.
    unsigned rays(double area, double mean_area) const;
};

/// Sample points of rays. by_element: every element has its own sequence. by_piece: each piece has one sequence,
/// divided among its leaves in tree order. Rays of neighbours then fill each other's gaps, and an inner element gathers
/// nearly as accurately as if it had cast all rays of its leaves; this helps most if elements have few rays.
enum class Dealing : std::uint8_t { by_element, by_piece };

/// Storage of rows if several processes work together: every process has all rows, or only those that it has cast. The
/// latter suffices to gather, and to find each process's own links.
enum class RowsHeld : std::uint8_t { everywhere, by_owner };

/// Rays of rows: how many, and at which points they start.
struct RowRays {
    RayBudget budget;
    std::uint64_t seed = 1;
    Dealing dealing = Dealing::by_element;
    RowsHeld held = RowsHeld::everywhere;
};

/// Transport by rays. Row i stores the elements that n_i rays hit first on their fronts; the rays are spread over
/// element i with density cos / pi around its normal. F_ij is the share of them that hits j. Unbiased; a row of a
/// closed scene sums to exactly 1. If half of the rays of a row are aimed at openings into brighter rooms
/// (`PortalAim`), rays have weights that keep the expected value of F_ij. The points (four dimensions: position and
/// direction) are scrambled Sobol points, so that the error of gathered light decreases like n^-3/4. O(n log n) per row
/// to make, O(rays) to apply, 4 bytes per ray, 28 if glass is
/// coloured.
/// On a stop request during construction all rays of the remaining rows are `missed`.
class RayRows final : public TransportOperator {
  public:
    RayRows(const Stage& stage, const NumberedLeaves& leaves, const RowRays& cast, const StopRequest* stop = nullptr);

    std::size_t size() const override { return dealt_.count(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    DealtUnknowns dealt() const override { return dealt_; }
    void gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    std::size_t memory_bytes() const override {
        return 4 * (hits_.size() + counts_.size() + escaped_.size()) + 8 * first_.size() +
               sizeof(Spectrum) * colours_.size();
    }
    /// Rays of all processes together.
    std::size_t rays() const { return rays_; }
    static constexpr std::uint32_t missed = 0xffffffffu;
    /// Leaf numbers hit by the rays of row i; `missed` if a ray hit nothing or a back. Requires that every process has
    /// all rows.
    std::span<const std::uint32_t> hits(std::size_t i) const {
        EXI_ASSERT(!dealt_.is_spread());
        return places(i);
    }
    /// Writes the leaf numbers of row i to `out`, as hits(i) returns them. Requires only that this process stores row
    /// i.
    void leaves_met(std::size_t i, std::vector<std::uint32_t>& out) const;

    /// Weights of the rays of row i; empty if all are 1.
    std::span<const float> counts(std::size_t i) const {
        return counts_.empty() ? std::span<const float>() : of_row(std::span(counts_), i);
    }

    /// For every row, the share of its rays that hit a front. Collective if rows are distributed.
    std::vector<double> kept() const;
    /// For every row, the number of its rays that hit neither fronts nor backs, those that a pane stopped included.
    /// Collective if rows are distributed.
    std::vector<std::uint32_t> escaped() const;

  private:
    template <class T>
    std::span<T> of_row(std::span<T> values, std::size_t i) const {
        const std::size_t at = dealt_.place(i);
        return values.subspan(first_[at], first_[at + 1] - first_[at]);
    }
    std::span<const std::uint32_t> places(std::size_t i) const { return of_row(std::span(hits_), i); }
    void tell_rows();
    void fetch_what_is_met();
    Spectrum read(std::size_t place, std::span<const Spectrum> radiosity) const;

    DealtUnknowns dealt_;
    std::size_t rays_ = 0;
    std::vector<std::size_t> first_;  ///< The row at index `place` is hits_[first_[place], first_[place + 1]).
    std::vector<std::uint32_t>
        hits_;  ///< Indices of the leaves among own and fetched values; leaf numbers if every process has all rows.
    std::vector<std::uint32_t> escaped_;  ///< For every own row, its rays that hit nothing.
    std::vector<float> counts_;           ///< Weight of each ray; empty if all are 1.
    std::vector<Spectrum> colours_;       ///< Factors of panes on the bands of each ray; empty if all are 1.
    FetchedValues fetched_;
};

}  // namespace exitance
