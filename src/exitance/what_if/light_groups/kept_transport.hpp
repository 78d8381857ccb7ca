#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/solution/solution.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// Diffuse transport between the elements of a solution, kept for changes of its light: E = G b.
///
/// Sources are the elements of `Solution::interpolant` and those above them, b the mean of what each reflects; where a
/// receiver sees several small ones under one form factor, the element above stands for them. Receivers are elements of
/// `Solution::indirect` that cover all of it, leaves or larger; their E is bilinear, linear on triangles and cells. A
/// weight is what a source's light brings to a corner of the receiver's patch. 20 bytes an entry.
struct KeptTransport {
    std::vector<std::uint32_t> receiver;  ///< Elements of `indirect`, in order of their ids.
    std::vector<std::uint32_t> first;     ///< Row i stands in [first[i], first[i + 1]).
    std::vector<std::uint32_t> source;    ///< Elements of `interpolant`,
    std::vector<std::array<float, 4>> weight;
    std::size_t rays = 0;  ///< That the rows were found by.
    /// RMS of rho (G b - E) over RMS of rho E, for the light of all groups.
    double error = 0;

    bool empty() const { return source.empty(); }
    std::size_t bytes() const {
        return 4 * (receiver.size() + first.size() + source.size()) + sizeof(weight[0]) * weight.size();
    }
};

/// A value between up to four others that stand side by side.
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

/// Weights of a patch's corners at a place of its plane.
std::array<float, 4> corner_weights(const Patch& patch, Vec2 uv);

/// How receivers, sources and values of a solution lie on one another. It follows from the solution and the receivers.
struct TransportLayout {
    /// Elements of `interpolant` that are leaves, or are cut into fans of them.
    std::vector<ElementId> sources;
    std::vector<double> area;  ///< m^2
    std::vector<MaterialId> material;
    Field<ElementId, std::uint32_t> number;  ///< Of sources among them; of others: none.
    std::vector<Between> source_at;          ///< Where their centres lie on the receivers' corners, four a receiver.
    /// Means of the interpolant: of a source, this share of the value there, for each of its leaves.
    struct LeafShare {
        std::uint32_t source;
        double share;
        Between at;
    };
    std::vector<LeafShare> source_mean;
    std::vector<Between> corner_at;       ///< Of every value of `indirect`: on the receivers' corners.
    std::vector<Between> interpolant_at;  ///< Of every value of `interpolant`: among values of `indirect`.
    std::vector<std::uint32_t> node;      ///< Of every value of `indirect`: values at one node are one.
    std::size_t node_count = 0;
    /// From leaves up: what an element's mean has of the one below.
    struct Pull {
        std::uint32_t parent, child;
        double share;
    };
    std::vector<Pull> pulls;

    static constexpr std::uint32_t none = 0xffffffffu;
    bool empty() const { return sources.empty(); }
};
TransportLayout make_layout(const Solution& solution, std::span<const std::uint32_t> receivers);

/// Is an element one by itself, cut into a fan or not?
bool is_base(const ElementTree& tree, ElementId e);

/// Of every value of a function, the node that it stands at: where the corners of leaves of one region meet, they share
/// one if they have one value, as continuous functions do but where light jumps.
std::vector<std::uint32_t> number_nodes(const ElementFunction& f, double scene_size, std::size_t& count);
/// Every value becomes the mean of those at its node.
void average_at_nodes(std::span<const std::uint32_t> node, std::size_t count, std::vector<Spectrum>& values);

/// Kept transport between the sources, as relaxations take it: rows, then values of receivers at sources. O(entries) a
/// gather.
class KeptOperator final : public TransportOperator {
  public:
    /// All must outlive it.
    KeptOperator(const KeptTransport& transport, const TransportLayout& layout, std::size_t interpolant_elements)
        : transport_(transport), layout_(layout), elements_(interpolant_elements) {}

    std::size_t size() const override { return layout_.sources.size(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    std::size_t memory_bytes() const override { return transport_.bytes(); }

    /// E at the corners of the receivers, four each.
    std::vector<Spectrum> at_receivers(std::span<const Spectrum> radiosity) const;
    /// E at the values of `indirect`, from that at the receivers' corners; one value a node.
    std::vector<Spectrum> at_corners(const std::vector<Spectrum>& receivers) const;

  private:
    const KeptTransport& transport_;
    const TransportLayout& layout_;
    std::size_t elements_;
};

}  // namespace exitance
