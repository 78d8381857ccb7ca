#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/links/cluster_links.hpp"
#include "exitance/links/kept_link.hpp"
#include "exitance/links/link_sites.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/processes/fetched_values.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// A transport link between two elements, receiver first, with a visibility bit per pair of nodes. The kernel is
/// recomputed whenever light is transported; only data that are expensive to compute are stored.
struct Link {
    ElementId receiver, source;
    /// Bit k n + l: node l of the source is visible from node k of the receiver. The last bit marks a constant link,
    /// which is of order 1 for every basis: it carries the mean of the source to the whole receiver.
    std::array<std::uint32_t, 3> visible{};
    /// Constant links: form factor times visible share. Other links: index of the link's block (Links::blocks_) or, for
    /// far links, the scale of the kernel with the sign bit set.
    union {
        float factor;
        std::uint32_t block;
    };
    static constexpr std::uint32_t far = 0x80000000u, constant_bit = 0x80000000u;
    static bool is_far(std::uint32_t block) { return block & far; }
    static float scale(std::uint32_t block) { return std::bit_cast<float>(block & ~far); }
    void set_far(float scale) { block = far | std::bit_cast<std::uint32_t>(scale); }
    void set_constant(double form_factor) { visible = {0, 0, constant_bit}, factor = static_cast<float>(form_factor); }
    bool is_constant() const { return visible[2] & constant_bit; }
    bool has_block() const { return !is_constant() && !is_far(block); }

    bool sees(std::size_t bit) const { return visible[bit / 32] >> (bit % 32) & 1u; }
    void set(std::size_t bit) { visible[bit / 32] |= 1u << (bit % 32); }
};

/// All links of a hierarchy, sorted by receiver, then by source.
///
/// Constant links (all links of order 1, and links of higher order with a small contribution): E = F V b, where F is
/// the mean over the receiver and b the mean over the source. Other links: at each node x_k of the receiver
///
///     E_k = sum_l K_kl V_kl b_l,    K_kl = w_l A cos cos / (pi r^2) between x_k and y_l
///
/// over the nodes y_l of the source, where b_l are its values. This rule is as accurate as the basis. It is recomputed
/// when it is applied, and scaled so that uniform light has the exact mean over the receiver: otherwise its errors
/// would have the same sign in all links and accumulate with every reflection. If the source is so near that the rule
/// is too inaccurate, the block K is integrated once (NearRow) and stored.
/// Source: [Hanrahan91], [Gortler93].
class Links {
  public:
    /// `links` may be in any order.
    /// `blocks`: nodes()^2 values for each near link.
    Links(const LinkSites& sites, std::vector<Link> links, std::vector<float> blocks);

    std::size_t size() const { return constants_.size() + kernels_.size(); }
    std::size_t memory_bytes() const;

    /// Computes E at the nodes of every receiving element; elsewhere it is zero. O(links). Kernels are evaluated, and
    /// summed within a link, in single precision: error 1e-6 of the received light.
    void gather(const NodalField& b, NodalField& E) const;
    /// Adds the received light to E, which must be zero at receiving elements.
    void add_to(NodalField& E, const NodalField& b) const;

    /// Marks the elements that are receivers or sources of links.
    void mark(Field<ElementId, std::uint8_t>& marked) const;

    /// Calls body(receiver, source) for every link.
    template <class Body>
    void for_each(const Body& body) const {
        for (const Rows* rows : {&constants_, &kernels_})
            for (std::size_t row = 0; row < rows->receiver.size(); ++row)
                for (std::size_t i = rows->first[row]; i < rows->first[row + 1]; ++i)
                    body(rows->receiver[row], rows->source_of(i));
    }

    /// All links, sorted by receiver, then by source. O(links).
    std::vector<KeptLink> list() const;

  private:
    /// Links of one kind, row by row.
    struct Rows {
        std::vector<ElementId> receiver;    ///< Per row.
        std::vector<std::size_t> first;     ///< Row i contains the links [first[i], first[i + 1]).
        std::vector<ElementId> sources;     ///< All sources, each once, in the order of their ids.
        std::vector<std::uint32_t> source;  ///< Per link: index of its source in `sources`.

        /// Sorts `links` and builds the rows.
        Rows(std::vector<Link>& links, std::size_t elements);
        std::size_t size() const { return source.size(); }
        ElementId source_of(std::size_t link) const { return sources[source[link]]; }
        std::size_t memory_bytes() const { return 4 * (source.size() + sources.size()) + 12 * receiver.size(); }
        void mark(Field<ElementId, std::uint8_t>& marked) const;
        /// Calls gather_row(row) for all rows, in parallel.
        template <class Row>
        void for_each(const ElementTree& tree, const Row& gather_row) const;
    };

    struct Kinds {
        std::vector<Link> constants, kernels;
    };
    /// If the basis is constant, all links are constants.
    static Kinds by_kind(std::vector<Link> links, std::size_t nodes);
    Links(const LinkSites& sites, Kinds links, std::vector<float> blocks);
    template <std::size_t groups>
    double mean_form_factor(std::size_t row, std::size_t link) const;
    void lay_out(const Link& link, std::size_t i);
    void gather_constants(const NodalField& b, NodalField& E) const;
    template <class Layout>
    void gather_kernels(const NodalField& b, NodalField& E) const;

    const LinkSites* sites_;
    Rows constants_, kernels_;
    std::vector<float> factor_;           ///< Per constant link: form factor including visibility.
    std::vector<std::uint32_t> visible_;  ///< Per kernel link: `words_` words of bits in the order of LinkLayout.
    std::vector<std::uint32_t> block_;    ///< Per kernel link: index of its block in `blocks_`.
    std::vector<float> blocks_;
    std::size_t words_ = 0;
};

/// The smallest part of a hierarchy that contains all receivers and sources of links. Below its ends, elements receive
/// the same light and emit as a whole. `far`: cluster links; may be null.
ElementPart linked_part(const LinkSites& sites, const Links& links, const ClusterLinks* far);

/// Links as an operator on the values at the ends of a part of the hierarchy: unknown i n + k is node k of end i.
/// Applies pull, links and push. All receivers and sources must be in the part.
///
/// With several processes the links may be distributed by the ends that receive them. Each process then gathers at its
/// own ends; it needs the values of these and of the ends below the sources of its links.
class LinkOperator final : public TransportOperator {
  public:
    /// `far`: cluster links; may be null.
    /// `together`: number of consecutive ends per block of one process, which alone has the links to them; all
    /// receivers must then be ends. 0: every process has all links.
    LinkOperator(const LinkSites& sites, const Links& links, const ClusterLinks* far, const ElementPart& part,
                 std::size_t together = 0);

    std::size_t size() const override { return part_->ends.size() * sites_->nodes(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    /// Costs as much as gathering for all receivers.
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    std::size_t memory_bytes() const override { return links_->memory_bytes() + (far_ ? far_->memory_bytes() : 0); }
    DealtUnknowns dealt() const override { return dealt_; }
    void gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;

  private:
    void fetch_what_links_read();
    void carry() const;

    const LinkSites* sites_;
    const Links* links_;
    const ClusterLinks* far_;
    const ElementPart* part_;
    DealtUnknowns dealt_;
    FetchedValues fetched_;
    mutable NodalField b_, E_;
};

}  // namespace exitance
