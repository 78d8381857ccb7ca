#pragma once

#include <vector>

#include "exitance/mesh/element_locator.hpp"
#include "exitance/processes/fetched_values.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// How many rays the things of a mesh are given: the more area (and so the more say in the error) the more rays.
struct RayBudget {
    double average = 64;  ///< Rays of an element of mean area.
    unsigned least = 16;
    unsigned most = 4096;
    bool front_alone = false;  ///< Of diffusing panes: as light leaves them, not as they gather.

    /// Rays of something of `area`, when the mean area of its kind is `mean_area` (both m^2): a power of two, in
    /// proportion to the root of the area, which spends a given number of rays on the least total variance.
    unsigned rays(double area, double mean_area) const;
};

/// Where the points of rays come from: every element has a sequence of its own; or each piece has one, which is dealt
/// out over its leaves in the order of the tree. Then rays of neighbours fill each other's gaps, and what all leaves
/// below an element gather is nearly as good as if it had cast all of their rays; of much use where an element has few.
enum class Dealing : std::uint8_t { by_element, by_piece };

/// Where several processes work together: has each of them all rows, or only those that it has cast? The latter are
/// rows to gather by, and to find each process's own links with.
enum class RowsHeld : std::uint8_t { everywhere, by_owner };

/// Transport by rays: row i holds the elements that n_i rays, spread over element i with density cos / pi around its
/// normal, hit first on their fronts: F_ij is the share of them that hits j. Unbiased; a row of a closed scene sums to
/// 1 exactly; where half of the rays of a row are aimed at openings into lighter rooms (`PortalAim`), rays count as
/// much as makes F_ij right on average. The points (four dimensions: place and direction) are scrambled Sobol points,
/// so that the error of what is gathered falls like n^-3/4. O(n log n) a row to make, O(rays) to apply, 4 bytes a ray.
/// Where a stop is asked for in the making, the rows that are left miss everything.
class RayRows final : public TransportOperator {
  public:
    RayRows(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering, const ElementLocator& locator,
            RayBudget budget, std::uint64_t seed, Dealing dealing = Dealing::by_element,
            RowsHeld held = RowsHeld::everywhere, const StopRequest* stop = nullptr);

    std::size_t size() const override { return dealt_.count(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    DealtUnknowns dealt() const override { return dealt_; }
    void gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    std::size_t memory_bytes() const override { return 4 * (hits_.size() + counts_.size()) + 8 * first_.size(); }
    /// Of all processes together.
    std::size_t rays() const { return rays_; }
    static constexpr std::uint32_t missed = 0xffffffffu;
    /// Of row i, which is here, leaf numbers, `missed` where a ray met nothing or a back. For rows that are everywhere.
    std::span<const std::uint32_t> hits(std::size_t i) const {
        EXI_ASSERT(!dealt_.is_spread());
        return places(i);
    }
    /// The same of any row that is here.
    void leaves_met(std::size_t i, std::vector<std::uint32_t>& out) const;

    /// As how many rays each of them counts; empty where all count alike.
    std::span<const float> counts(std::size_t i) const {
        return counts_.empty() ? std::span<const float>() : of_row(std::span(counts_), i);
    }

    /// Of every row, the share of its rays that hit a front.
    std::vector<double> kept() const;

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
    std::vector<std::size_t> first_;   ///< The row at a place stands in hits_[first_[place], first_[place + 1]).
    std::vector<std::uint32_t> hits_;  ///< The leaves' places among own and fetched ones; their numbers where all are.
    std::vector<float> counts_;        ///< Of each of them; empty where all are 1.
    FetchedValues fetched_;
};

}  // namespace exitance
