#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/groups.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// Receiving elements and sending patches: two levels of one tree [Cohen86]. A patch is a leaf or an inner element;
/// every leaf belongs to exactly one patch.
struct PatchLevel {
    std::vector<ElementId> patches;       ///< The patches, in the order of their ids.
    std::vector<std::uint32_t> patch_of;  ///< The patch of each leaf, as an index into `patches`.
    std::vector<double> share;            ///< Area of each leaf over the area of its patch.

    /// Uses the ancestors `levels` above the leaves as patches; with 0 every leaf is its own patch.
    PatchLevel(const ElementTree& tree, const LeafNumbering& numbering, int levels);

    /// Area-weighted means of leaf values over the patches.
    std::vector<Spectrum> pull(std::span<const Spectrum> leaf_values) const;
};

/// Computes form factors between elements and their visibility on demand.
///
/// F_ij is the exact form factor from the receiver's centre to the whole source polygon [Baum89], times the share of
/// `samples` rays between the elements that are unoccluded. Every element has its own sample points, one in each cell
/// of a 4 x 4 grid. An orthogonal array of strength 2, shifted for each pair of elements, selects the points that a ray
/// joins, so that every pair of the four coordinates is stratified [Owen92]. One sample is a ray from centre to centre,
/// as in [Cohen88] and [Willmott97]; other numbers are rounded up to a multiple of 16.
class PatchTransfer {
  public:
    PatchTransfer(const Stage& stage, const ElementTree& tree, unsigned samples, std::uint64_t seed)
        : stage_(stage),
          tree_(tree),
          samples_(std::clamp((samples + 15) / 16 * 16, 16u, max_samples)),
          joins_middles_(samples == 1),
          seed_(seed) {
        update_places();
    }

    /// Creates sample points for elements that were added to the tree since the last call.
    void update_places();

    static constexpr unsigned max_samples = 256;  ///< Limit on the rays per pair.

    struct Workspace {
        ReceiverBatch batch;
        std::vector<std::size_t> facing;
        std::vector<double> F;
        std::size_t rays = 0, form_factors = 0;
    };

    /// F_ij from receiver i to source j, including occlusion: E_i = sum_j F_ij B_j.
    double form_factor(ElementId receiver, ElementId source, Workspace& workspace) const;

    /// Computes F_ij for all receivers and one source. Adds the counts to `rays` and `form_factors`. `precise`, if not
    /// empty, receives the values that `form_factor` computes.
    void column(std::span<const ElementId> receivers, ElementId source, std::span<float> out,
                std::span<double> precise = {}) const;

    /// Share of `samples` rays between the two that are unoccluded.
    double visible_share(ElementId receiver, ElementId source, Workspace& workspace) const;
    /// End points of the rays of one group of sixteen.
    std::pair<RayEnds, RayEnds> rays(ElementId receiver, ElementId source, std::size_t group) const;
    /// F_ij without occlusion.
    double form_factor_in_the_open(ElementId receiver, ElementId source) const;

    /// Adds the counts of a workspace to the totals.
    void count(const Workspace& workspace) const {
        rays_ += workspace.rays;
        form_factors_ += workspace.form_factors;
    }
    std::size_t rays() const { return rays_; }
    std::size_t form_factors() const { return form_factors_; }

  private:
    bool faces(ElementId receiver, ElementId source) const;

    const Stage& stage_;
    const ElementTree& tree_;
    std::vector<Point> centres_;  ///< Centre of every element.
    /// Sample points in groups of sixteen, `samples_` per element. `sending_` has them in the order of the cells to
    /// which rays from cells 0 to 15 lead.
    std::vector<RayEnds> receiving_, sending_;
    unsigned samples_;    ///< Number of samples, a multiple of 16.
    bool joins_middles_;  ///< If true, one ray from centre to centre replaces the samples.
    std::uint64_t seed_;
    mutable std::atomic<std::size_t> rays_{0}, form_factors_{0};
};

/// Dense matrix of form factors from elements to patches, computed at construction: E = F (mean of b over each patch).
/// O(elements x patches) form factors and floats.
class DenseTransport final : public TransportOperator {
  public:
    DenseTransport(const PatchTransfer& transfer, const LeafNumbering& numbering, const PatchLevel& level,
                   Progress& progress, const StopRequest& stop);

    std::size_t size() const override { return level_.patch_of.size(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    std::size_t memory_bytes() const override { return 4 * F_.size(); }
    std::size_t entries() const { return F_.size(); }

  private:
    const PatchLevel& level_;
    Groups leaves_of_;      ///< Leaves of each patch.
    std::vector<float> F_;  ///< Row of leaf i: F_[i * patches, (i + 1) * patches).
};

}  // namespace exitance
