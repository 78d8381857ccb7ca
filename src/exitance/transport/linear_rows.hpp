#pragma once

#include <array>
#include <vector>

#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Transport by rays between linear elements, by collocation: the unknowns are values of E_ind at the nodes of the
/// leaves (as many as each leaf's polynomial has freedoms), and row k gathers at node k
///
///     (H rho E)(x_k) = mean over rays of rho(y) sum_l N_l(y) E_l,      y: what the ray hits first,
///
/// with N_l the polynomials of the leaf that y lies on. Reflectance is inside, since a row crosses many surfaces.
/// Source: [Atkinson00]. O(rays) to apply, 8 bytes a ray.
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
        return sizeof(Hit) * hits_.size() + sizeof(float) * counts_.size() + sizeof(Node) * nodes_.size();
    }
    /// Of all processes together; each has the rows of its own nodes.
    std::size_t rays() const { return rays_; }

    /// H rho E_dir at every node, with E_dir as projected: what the emitters' light brings after one reflection, W/m^2.
    std::vector<Spectrum> first_reflection(const DirectProjection& direct) const;
    /// Area that each node stands for, m^2: its weight in the leaf's rule times the leaf's area.
    std::vector<double> node_areas() const;
    /// The leaf's polynomial through its nodes' values, by its values at the corners of the leaf's patch.
    std::array<Spectrum, 4> corners(std::size_t leaf, std::span<const Spectrum> nodal) const;
    /// Mean over the leaf, W/m^2.
    Spectrum mean(std::size_t leaf, std::span<const Spectrum> nodal) const;

  private:
    static constexpr std::uint32_t missed = 0xffffffffu;
    /// Where a ray ends: a leaf, by its place among those that are met here, and the place there in steps of 2^-16 of
    /// the patch.
    struct Hit {
        std::uint32_t leaf = missed;
        std::uint16_t u = 0, v = 0;
    };
    struct Node {
        double area = 0;
        std::size_t first_ray = 0, last_ray = 0;  ///< Empty where the node is another process's.
    };
    struct Leaf {
        std::uint32_t first_node = 0, node_count = 0;
        bool triangle = false;
        Spectrum reflectance;
        /// Row c: the weights of the nodes' values in the value at corner c. A leaf has eight nodes at most.
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
    /// What the leaves that are met reflect, at their corners; `values`: own and fetched ones.
    std::vector<Corners> reflected(std::span<const Spectrum> values) const;
    Spectrum read(const std::vector<Corners>& corners, const Node& node) const;
    void read_own(const std::vector<Corners>& corners, std::span<Spectrum> out) const;

    DealtUnknowns dealt_{0};
    std::size_t rays_ = 0;
    FetchedValues fetched_;
    std::vector<std::uint32_t> met_;         ///< Leaves that rays of own nodes end on, ascending.
    std::vector<std::uint32_t> first_read_;  ///< Where the nodes of each begin in read_;
    std::vector<std::uint32_t> read_;        ///< where their values stand among own and fetched ones.

    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_;
    std::vector<Hit> hits_;
    std::vector<float> counts_;  ///< As how many rays each of them counts; empty where all are 1.
    std::vector<ElementId> ids_;
};

}  // namespace exitance
