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

/// A way for light between two elements, receiver first: their nodes see each other as the bits say. The kernel is made
/// anew whenever light passes; what is kept is what is dear.
struct Link {
    ElementId receiver, source;
    /// Bit k n + l: is node l of the source visible from node k of the receiver? The last bit marks a constant: of
    /// order 1, whatever the basis, from the mean of the source to all of the receiver.
    std::array<std::uint32_t, 3> visible{};
    /// A constant: form factor times visible share. Else where the link's block stands (Links::blocks_), or, far, the
    /// number by which its kernel is scaled, with the sign set.
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
/// Constants, which are all of order 1 and those of higher orders that carry little: E = F V b with F the mean over the
/// receiver, and b that over the source. The others: at each node x_k of the receiver
///
///     E_k = sum_l K_kl V_kl b_l,    K_kl = w_l A cos cos / (pi r^2) between x_k and y_l
///
/// over the nodes y_l of the source, with b_l its numbers: a rule as exact as the basis, made anew when it is applied,
/// and scaled, so that even light arrives exactly in the mean over the receiver: what the rule misses has the same sign
/// from link to link, and would come back from every reflection.
/// Where the source is so near that the rule is not exact enough, the block K is integrated once (NearRow) and kept.
/// Source: [Hanrahan91], [Gortler93].
class Links {
  public:
    /// `links` in any order; `blocks` holds nodes()^2 numbers for each link that is near.
    Links(const LinkSites& sites, std::vector<Link> links, std::vector<float> blocks);

    std::size_t size() const { return constants_.size() + kernels_.size(); }
    std::size_t memory_bytes() const;

    /// E of every element that links lead to, at its nodes; of the others: zero. O(links). Kernels are made, and added
    /// up within a link, in single precision: 1e-6 of what arrives.
    void gather(const NodalField& b, NodalField& E) const;
    /// Adds that to E, which is zero where links lead to.
    void add_to(NodalField& E, const NodalField& b) const;

    /// Marks the elements that links lead to or come from.
    void mark(Field<ElementId, std::uint8_t>& marked) const;

    /// Calls body(receiver, source) for every one.
    template <class Body>
    void for_each(const Body& body) const {
        for (const Rows* rows : {&constants_, &kernels_})
            for (std::size_t row = 0; row < rows->receiver.size(); ++row)
                for (std::size_t i = rows->first[row]; i < rows->first[row + 1]; ++i)
                    body(rows->receiver[row], rows->source_of(i));
    }

    /// All of them, by receiver, then by source. O(links).
    std::vector<KeptLink> list() const;

  private:
    /// Links of one kind, one after the other.
    struct Rows {
        std::vector<ElementId> receiver;    ///< Of each row.
        std::vector<std::size_t> first;     ///< Row i stands in [first[i], first[i + 1]).
        std::vector<ElementId> sources;     ///< All of them, once, in order of their ids;
        std::vector<std::uint32_t> source;  ///< of a link: its place among them.

        /// Sorts the links.
        Rows(std::vector<Link>& links, std::size_t elements);
        std::size_t size() const { return source.size(); }
        ElementId source_of(std::size_t link) const { return sources[source[link]]; }
        std::size_t memory_bytes() const { return 4 * (source.size() + sources.size()) + 12 * receiver.size(); }
        void mark(Field<ElementId, std::uint8_t>& marked) const;
        /// Calls gather_row(row) for all of them on all threads.
        template <class Row>
        void for_each(const ElementTree& tree, const Row& gather_row) const;
    };

    struct Kinds {
        std::vector<Link> constants, kernels;
    };
    /// All are constants where the basis is.
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
    std::vector<float> factor_;           ///< Of constants.
    std::vector<std::uint32_t> visible_;  ///< Of kernels: `words_` a link, bits as LinkLayout has them.
    std::vector<std::uint32_t> block_;    ///< Of kernels.
    std::vector<float> blocks_;
    std::size_t words_ = 0;
};

/// The least part of a hierarchy that holds all elements which links lead to or come from. `far`: those of clusters;
/// may be null. What lies below its ends receives alike, and sends as a whole.
ElementPart linked_part(const LinkSites& sites, const Links& links, const ClusterLinks* far);

/// Links as an operator on what the ends of a part of the hierarchy hold: unknown i n + k is node k of end i. Pull,
/// links, push. All elements that links touch must be in the part.
///
/// Over several processes the links may be dealt out by the ends that they lead to: then each process gathers at its
/// own ends, from these and from those that lie below what its links come from.
class LinkOperator final : public TransportOperator {
  public:
    /// `far`: those of clusters; may be null.
    /// `together`: so many ends, one after the other, are one process's, and it alone has the links that lead to them;
    /// all links lead to ends then. 0: every process has all links.
    LinkOperator(const LinkSites& sites, const Links& links, const ClusterLinks* far, const ElementPart& part,
                 std::size_t together = 0);

    std::size_t size() const override { return part_->ends.size() * sites_->nodes(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    /// No cheaper than gathering for all of them.
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
