#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/solution/solution.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// Diffuse transport between the elements of a solution, stored for changes of its light: E = G b.
///
/// Sources are the elements of `Solution::interpolant` and their ancestors; b is the mean reflected radiosity of each.
/// If a receiver sees several small elements under a small form factor, their ancestor replaces them. Receivers are
/// elements of `Solution::indirect`, leaves or larger, that cover all of it; their E is bilinear, or linear on
/// triangles and cells. A weight is the contribution of a source to a corner of the receiver's patch. 20 bytes per
/// entry.
struct KeptTransport {
    std::vector<std::uint32_t> receiver;  ///< Elements of `indirect`, in the order of their ids.
    std::vector<std::uint32_t> first;     ///< Entries of row i are in [first[i], first[i + 1]).
    std::vector<std::uint32_t> source;    ///< Elements of `interpolant`.
    std::vector<std::array<float, 4>> weight;
    std::size_t rays = 0;  ///< Number of rays that the rows were computed from.
    /// RMS of rho (G b - E) relative to the RMS of rho E, for the light of all groups.
    double error = 0;

    bool empty() const { return source.empty(); }
    std::size_t bytes() const {
        return 4 * (receiver.size() + first.size() + source.size()) + sizeof(weight[0]) * weight.size();
    }
};

/// A value interpolated between up to four consecutive values.
struct Between {
    std::uint32_t first = 0;
    std::array<float, 4> weight{};

    template <class Values>
    Spectrum of(const Values& values) const {
        Spectrum sum;
        for (std::uint32_t k = 0; k < 4; ++k) {
            if (weight[k] == 0) continue;
            const double w = static_cast<double>(weight[k]);
            for (std::size_t band = 0; band < bands; ++band)
                sum[band] += w * static_cast<double>(values[first + k][band]);
        }
        return sum;
    }
};

/// Weights of a patch's corners at a point of its plane.
std::array<float, 4> corner_weights(const Patch& patch, Vec2 uv);

/// Geometric relations between the receivers, sources and values of a solution. Determined by the solution and the
/// receivers.
struct TransportLayout {
    /// Elements of `interpolant` that are leaves, or are split into fans of leaves.
    std::vector<ElementId> sources;
    std::vector<double> area;  ///< m^2
    std::vector<MaterialId> material;
    Field<ElementId, std::uint32_t> number;  ///< Per element: its number among the sources, or none.
    /// Per source: its centre, interpolated from the receivers' corners (four per receiver).
    std::vector<Between> source_at;
    /// Contribution of one leaf of the interpolant to the mean of its source: `share` of the value at `at`.
    struct LeafShare {
        std::uint32_t source;
        double share;
        Between at;
    };
    std::vector<LeafShare> source_mean;
    std::vector<Between> corner_at;       ///< Per value of `indirect`: interpolation from the receivers' corners.
    std::vector<Between> interpolant_at;  ///< Per value of `interpolant`: interpolation from values of `indirect`.
    std::vector<std::uint32_t> node;      ///< Per value of `indirect`: its node. Values of one node are equal.
    std::size_t node_count = 0;
    /// Contribution of a child to its parent's mean; in order from the leaves up.
    struct Pull {
        std::uint32_t parent, child;
        double share;
    };
    std::vector<Pull> pulls;

    static constexpr std::uint32_t none = 0xffffffffu;
    bool empty() const { return sources.empty(); }
};
TransportLayout make_layout(const Solution& solution, std::span<const std::uint32_t> receivers);

/// True if an element is a source: a leaf, or the parent of a fan of leaves.
bool is_base(const ElementTree& tree, ElementId e);

/// Returns the node of every value of a function. Corners of leaves of one region that coincide are one node if they
/// have the same value, as in continuous functions except at jumps. `count`: receives the number of nodes.
std::vector<std::uint32_t> number_nodes(const ElementFunction& f, double scene_size, std::size_t& count);
/// Replaces every value by the mean of those at its node.
void average_at_nodes(std::span<const std::uint32_t> node, std::size_t count, std::vector<Spectrum>& values);

/// The stored transport as an operator from sources to sources, for relaxation: its rows give E at the receivers'
/// corners, from which E at the sources is interpolated.
/// O(entries) per gather.
class KeptOperator final : public TransportOperator {
  public:
    /// All arguments must outlive this object.
    KeptOperator(const KeptTransport& transport, const TransportLayout& layout, std::size_t interpolant_elements)
        : transport_(transport), layout_(layout), elements_(interpolant_elements) {}

    std::size_t size() const override { return layout_.sources.size(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    std::size_t memory_bytes() const override { return transport_.bytes(); }

    /// E at the corners of the receivers, four per receiver, W/m^2.
    std::vector<Spectrum> at_receivers(std::span<const Spectrum> radiosity) const;
    /// E for each of the values of `indirect`, W/m^2: interpolated between E at the `receivers`' corners, then averaged
    /// over the values of each node.
    std::vector<Spectrum> at_corners(const std::vector<Spectrum>& receivers) const;

  private:
    const KeptTransport& transport_;
    const TransportLayout& layout_;
    std::size_t elements_;
};

}  // namespace exitance
