#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/links/error/open_transfer.hpp"
#include "exitance/links/error/pair_visibility.hpp"
#include "exitance/links/links.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// A pair of elements that will become one or more links, with the available information about occluders in between.
struct LinkPair {
    ElementId receiver, source;
    View view = View::mixed;
    bool triaged = false;  ///< True if this pair, or one that contains it, has been classified.
    /// If `view` is mixed and the pair is classified: range of its occluder candidates in the round's pool.
    std::uint32_t first = 0, count = 0;
};

/// The decision about a pair.
struct LinkDecision {
    enum class Verdict : std::uint8_t { drop, accept, cut_source };
    Verdict verdict = Verdict::drop;
    Link link;
    bool near = false;  ///< True if the kernel is in block().
    /// True if the receiver must be split whatever its other links contribute: because of a strength oracle or a peak.
    bool cuts_receiver = false;
    double squared_error = 0;  ///< Error of the rule and of visibility: area times squared error of an accepted link.
    double undersampling = 0;  ///< Error between nodes and check points, in the units of a tolerance.
    double light = 0;          ///< Unoccluded power received by the whole receiver, W.
    Departure departure{};
    /// If occluders are possible: the light at the receiver's nodes, and its variance from the rays.
    NodeRow shadowed{}, variance{};
};

/// Judges pairs of elements. One object per thread; reuses its memory.
///
/// The error of a link is that of the radiosity w E that it causes, where w is the receiver's reflectance:
/// - rule: the error of the kernel rule, and of replacing the source's radiosity by its polynomial (`roughness`, per
/// element, RMS of the mean over bands) where the kernel varies over it. If too large, the source is split;
/// - visibility: the standard error of the rays, if visibility is uncertain. If too large, the source is split or more
/// rays are cast;
/// - interpolation: the difference between the link's light at check points of the receiver and the polynomial through
/// its nodes. It is judged for all links of a receiver together: near an edge, each part of a wall contributes light
/// that varies strongly although the sum does not.
/// Alternatively links are judged by their strength alone (LinkOracle); a link that is too strong has the larger of the
/// two elements split.
/// Source: the oracle of [Gortler93] and [Lischinski94], by samples; certain visibility of [Haines91] is inherited.
class LinkJudge {
  public:
    LinkJudge(const LinkSites& sites, const NodalField& b, const Field<ElementId, double>& roughness,
              const LinkTolerance& tolerance);

    /// Judges a pair. `pool` contains the pairs' candidates. If the pair is split, its parts inherit candidates().
    LinkDecision judge(LinkPair& pair, std::span<const PieceId> pool);

    std::span<const float> block() const { return block_; }  ///< nodes() x nodes() entries, receiver first.
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
    bool classified_ = false;  ///< True once the view of the current pair is classified.
};

}  // namespace exitance
