#pragma once

#include <array>
#include <vector>

#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Transport by rays between linear elements, by collocation. The unknowns are values of E_ind at the nodes of the
/// leaves; a leaf has as many nodes as its polynomial has degrees of freedom. Row k gathers at node k:
///
///     (H rho E)(x_k) = mean over rays of rho(y) sum_l N_l(y) E_l,      y: what the ray hits first,
///
/// where N_l are the polynomials of the leaf that contains y. The reflectance is part of the matrix, since a row
/// reaches many surfaces. O(rays) to apply, 8 bytes per ray.
/// Source: [Atkinson00].
class LinearRows final : public TransportOperator {
  public:
    LinearRows(const Stage& stage, const DirectProjection& direct, const LeafNumbering& numbering,
               const ElementLocator& locator, RayBudget budget, std::uint64_t seed);

    std::size_t size() const override { return nodes_.size(); }
    void gather(std::span<const Spectrum> nodal, std::span<Spectrum> out) const override;
    Spectrum gather_at(std::size_t node, std::span<const Spectrum> nodal) const override;
    DealtUnknowns dealt() const override { return dealt_; }
    void gather_own(std::span<const Spectrum> nodal, std::span<Spectrum> out) const override;
    std::size_t memory_bytes() const override {
        return sizeof(Hit) * hits_.size() + sizeof(float) * counts_.size() + sizeof(Spectrum) * colours_.size() +
               sizeof(Node) * nodes_.size();
    }
    /// Rays of all processes. Each process stores only the rows of its own nodes.
    std::size_t rays() const { return rays_; }

    /// H rho E_dir at every node, with the projected E_dir: the light of the emitters after one reflection, W/m^2.
    std::vector<Spectrum> first_reflection(const DirectProjection& direct) const;
    /// Area that each node represents, m^2: its weight in the leaf's rule times the leaf's area.
    std::vector<double> node_areas() const;
    /// Values at the corners of the leaf's patch of the polynomial through the leaf's nodal values.
    std::array<Spectrum, 4> corners(std::size_t leaf, std::span<const Spectrum> nodal) const;
    /// Mean of the polynomial over the leaf, W/m^2.
    Spectrum mean(std::size_t leaf, std::span<const Spectrum> nodal) const;

  private:
    static constexpr std::uint32_t missed = 0xffffffffu;
    /// End of a ray: a leaf, as an index into `met_`, and the position in units of 2^-16 of the patch's parameters.
    struct Hit {
        std::uint32_t leaf = missed;
        std::uint16_t u = 0, v = 0;
    };
    struct Node {
        double area = 0;
        std::size_t first_ray = 0, last_ray = 0;  ///< Range of the node's rays; empty if another process owns the node.
    };
    struct Leaf {
        std::uint32_t first_node = 0, node_count = 0;
        bool triangle = false;
        Spectrum reflectance;
        /// to_corner[c][k]: weight of node k in the value at corner c. A leaf has at most eight nodes.
        std::array<std::array<float, 8>, 4> to_corner{};
    };
    using Corners = std::array<Spectrum, 4>;
    struct NodePlace {
        Point x;
        RegionId region;
    };
    std::vector<NodePlace> number_nodes(const Stage& stage, const ElementTree& tree, const RayBudget& budget);
    void cast(const Stage& stage, std::span<const NodePlace> places, const LeafNumbering& numbering,
              const ElementLocator& locator, std::uint64_t seed);
    void find_what_is_met();
    /// Reflected light at the corners of the leaves in `met_`. `values`: own and fetched nodal values.
    std::vector<Corners> reflected(std::span<const Spectrum> values) const;
    Spectrum read(const std::vector<Corners>& corners, const Node& node) const;
    Spectrum weight(std::size_t ray) const {
        return (counts_.empty() ? 1 : static_cast<double>(counts_[ray])) *
               (colours_.empty() ? Spectrum(1.0) : colours_[ray]);
    }
    void read_own(const std::vector<Corners>& corners, std::span<Spectrum> out) const;

    DealtUnknowns dealt_{0};
    std::size_t rays_ = 0;
    FetchedValues fetched_;
    std::vector<std::uint32_t> met_;         ///< Leaves hit by rays of own nodes, ascending.
    std::vector<std::uint32_t> first_read_;  ///< Per leaf of met_: index in read_ of its first node.
    std::vector<std::uint32_t> read_;        ///< Index of each node's value among the own and fetched values.

    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_;
    std::vector<Hit> hits_;
    std::vector<float> counts_;      ///< Weight of each ray; empty if all are 1.
    std::vector<Spectrum> colours_;  ///< Factors of panes on each ray's bands; empty if all are 1.
    std::vector<ElementId> ids_;
};

}  // namespace exitance
