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

/// The elements that receive and the patches that send: two levels of one tree [Cohen86]. A patch is a leaf or an inner
/// element; every leaf lies in exactly one patch.
struct PatchLevel {
    std::vector<ElementId> patches;       ///< In order of their ids.
    std::vector<std::uint32_t> patch_of;  ///< By leaf number: the leaf's patch, as an index into `patches`.
    std::vector<double> share;            ///< By leaf number: area of the leaf over area of its patch.

    /// Patches `levels` above the leaves: 0 makes every leaf a patch of its own.
    PatchLevel(const ElementTree& tree, const LeafNumbering& numbering, int levels);

    /// Means over the patches of what the leaves hold (pull).
    std::vector<Spectrum> pull(std::span<const Spectrum> leaf_values) const;
};

/// Form factors between elements, and how much of them is visible, computed when asked for.
///
/// F_ij is taken at the receiver's middle, exactly, towards the whole source polygon [Baum89], and times the share of
/// `samples` rays between the two that meet nothing. Every element has its own places, one in each cell of a 4 x 4
/// grid; which of them a ray joins follows an orthogonal array of strength 2, turned by the pair of elements: each pair
/// of the four coordinates is stratified [Owen92]. One sample is one ray from middle to middle, as [Cohen88] and
/// [Willmott97] shoot; other numbers are taken up to a multiple of 16.
class PatchTransfer {
  public:
    PatchTransfer(const Stage& stage, const ElementTree& tree, unsigned samples, std::uint64_t seed)
        : stage_(stage),
          tree_(tree),
          samples_(std::clamp((samples + 15) / 16 * 16, 16u, most_samples)),
          joins_middles_(samples == 1),
          seed_(seed) {
        update_places();
    }

    /// Makes places for the elements that the tree has got since it was last called.
    void update_places();

    static constexpr unsigned most_samples = 256;  ///< Rays a pair; more are not asked for.

    struct Workspace {
        ReceiverBatch batch;
        std::vector<std::size_t> facing;
        std::vector<double> F;
        std::size_t rays = 0, form_factors = 0;
    };

    /// F_ij from receiver i to source j, occlusion included: E_i = sum_j F_ij B_j.
    double form_factor(ElementId receiver, ElementId source, Workspace& workspace) const;

    /// F_ij for every receiver in turn and one source. Counts go to `rays` and `form_factors`. `precise`, if not empty:
    /// the same numbers as `form_factor` computes them.
    void column(std::span<const ElementId> receivers, ElementId source, std::span<float> out,
                std::span<double> precise = {}) const;

    /// The share of `samples` rays between the two that meet nothing.
    double visible_share(ElementId receiver, ElementId source, Workspace& workspace) const;
    /// The ends of the rays of one group of sixteen.
    std::pair<RayEnds, RayEnds> rays(ElementId receiver, ElementId source, std::size_t group) const;
    /// F_ij as if nothing stood in between.
    double form_factor_in_the_open(ElementId receiver, ElementId source) const;

    /// Adds what a workspace has counted to the totals.
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
    std::vector<Point> centres_;  ///< Of every element.
    /// Sixteen places a group, `samples_` of every element. As a source, they lie in the order of the cells that rays
    /// from cells 0 to 15 lead to.
    std::vector<RayEnds> receiving_, sending_;
    unsigned samples_;    ///< A multiple of 16.
    bool joins_middles_;  ///< By one ray, in place of samples.
    std::uint64_t seed_;
    mutable std::atomic<std::size_t> rays_{0}, form_factors_{0};
};

/// The matrix of form factors from elements to patches, computed at once and kept: E = F (mean of b over each patch).
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
    Groups leaves_of_;      ///< By patch.
    std::vector<float> F_;  ///< Row of leaf i: F_[i * patches, (i + 1) * patches).
};

}  // namespace exitance
