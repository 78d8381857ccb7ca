#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/links/error/open_transfer.hpp"
#include "exitance/links/error/pair_visibility.hpp"
#include "exitance/links/links.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// A pair of elements that is to become a link, or several, with what was found out of what stands in between.
struct LinkPair {
    ElementId receiver, source;
    View view = View::mixed;
    bool triaged = false;                ///< Has the pair, or one that holds it, been classified?
    std::uint32_t first = 0, count = 0;  ///< Mixed and classified: the candidates, in the round's pool.
};

/// What is decided of a pair.
struct LinkDecision {
    enum class Verdict : std::uint8_t { drop, accept, cut_source };
    Verdict verdict = Verdict::drop;
    Link link;
    bool near = false;  ///< The kernel stands in block().
    /// True if the receiver is to be cut whatever its other links bring: by an oracle of strength, or for a peak.
    bool cuts_receiver = false;
    double squared_error = 0;  ///< Of rule and visibility: area times squared error, of an accepted link.
    double undersampling = 0;  ///< Error between nodes and check points, in the units of a tolerance.
    double light = 0;          ///< Of all of the receiver, in the open, W.
    Departure departure{};
    /// Where something stands in between: the light at the receiver's nodes, and the variance that rays leave.
    NodeRow shadowed{}, variance{};
};

/// Judges pairs of elements. One a thread; keeps its memory.
///
/// The error of a link is that of the radiosity w E which it causes, w the receiver's reflectance:
/// - the rule: what its order leaves, and the source's departure from its own polynomial (`roughness`, by element, the
///   RMS of mean bands) where the kernel is no polynomial over it. Then the source is cut;
/// - visibility: the standard error of as many rays, where nothing is certain. Then the source is cut, or more are
///   cast;
/// - interpolation: light that the link sends to points between the receiver's nodes, against the nodes' polynomial.
///   This is judged for all links of a receiver together: near an edge each part of a wall sends light that varies
///   fast, while the whole of it does not.
/// Or links are judged by their strength alone (LinkOracle): where it is too large, the larger of the two is cut.
/// Source: the oracle of [Gortler93] and [Lischinski94], by samples; certain visibility of [Haines91] is inherited.
class LinkJudge {
  public:
    LinkJudge(const LinkSites& sites, const NodalField& b, const Field<ElementId, double>& roughness,
              const LinkTolerance& tolerance);

    /// `pool` holds the pairs' candidates. For a pair to be cut, what its parts inherit is in candidates().
    LinkDecision judge(LinkPair& pair, std::span<const PieceId> pool);

    std::span<const float> block() const { return block_; }  ///< nodes() x nodes(), receiver first.
    std::span<const PieceId> candidates() const { return candidates_; }
    std::size_t rays() const { return visible_.rays(); }
    std::size_t form_factors() const { return rule_.form_factors(); }

  private:
    bool may_see(ElementId p, ElementId q) const;
    void classify_view(LinkPair& pair, std::span<const PieceId> pool, bool is_weak);
    std::optional<LinkDecision> judge_as_constant(LinkPair& pair, std::span<const PieceId> pool,
                                                  const SourceLight& source, double allowed);
    LinkDecision decide_by_error(LinkPair& pair, std::span<const PieceId> pool, const SourceLight& source,
                                 const OpenTransfer& transfer, double allowed);
    LinkDecision decide_by_strength(LinkPair& pair, std::span<const PieceId> pool, const SourceLight& source,
                                    const OpenTransfer& transfer, double allowed);
    double cast(const LinkPair& pair, const OpenTransfer& transfer, bool few, double allowed);
    double cast_once(const LinkPair& pair, const OpenTransfer& transfer, unsigned times, bool few);
    enum class Cut { nothing, source, receiver };
    Cut what_to_cut(const LinkPair& pair, const OpenTransfer& transfer) const;
    LinkDecision accept(const LinkPair& pair, const SourceLight& source, const OpenTransfer& transfer,
                        double visibility_error, double undersampling = 0);
    void set_kernel(bool open, const SourceLight& source, const OpenTransfer& transfer, LinkDecision& out);
    void set_block(const OpenTransfer& transfer, double scale);

    const LinkSites& sites_;
    const NodalField& b_;
    const Field<ElementId, double>& roughness_;
    const LinkTolerance& tolerance_;
    std::size_t n_;
    OpenTransferRule rule_;
    PairVisibility visible_;
    Shaft shaft_;
    std::vector<PieceId> candidates_;
    std::vector<float> block_;
    bool classified_ = false;  ///< True once the view of the pair at hand is classified.
};

}  // namespace exitance
