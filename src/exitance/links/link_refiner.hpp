#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/links/received_light.hpp"

namespace exitance {

/// Finds the links of a hierarchy. Initially either the given pairs of elements are linked, or every piece with all
/// pieces. A source is split until its link is good enough. A receiver is split if the sum of the light of all its
/// links is not close to a polynomial over it; its parts then inherit the links that cause this. Source: [Hanrahan91].
///
/// The refinement proceeds in rounds. All pairs of a round are judged in parallel with a fixed tree; then elements are
/// split in the order of their ids. The result is therefore independent of the number of threads. O(pairs + links).
class LinkRefiner {
  public:
    /// Computes the light on elements that become part of links: sets the fields on the children of `parents`, and
    /// their roughness as in NodalField::roughness(). Called when the children get stored values.
    using Light = std::function<void(const std::vector<ElementId>& parents, Field<ElementId, double>& roughness)>;

    /// `light` is required if `sites` do not hold all elements.
    LinkRefiner(ElementTree& tree, LinkSites& sites, Light light = {})
        : tree_(tree), sites_(sites), light_below_(std::move(light)), judged_(sites) {}

    /// Starts with all pairs of pieces, or continues with the links found so far.
    /// b  reflected light at the nodes of all elements; parts of split elements inherit it from their wholes
    /// also  other fields whose values parts inherit
    void refine(NodalField& b, std::span<NodalField* const> also, const LinkTolerance& tolerance, Progress& progress,
                const StopRequest& stop);
    /// Like the above, for the links found so far and the given pairs.
    void refine(const std::vector<LinkPair>& fresh, NodalField& b, std::span<NodalField* const> also,
                const LinkTolerance& tolerance, Progress& progress, const StopRequest& stop);

    /// Sets the weight of squared errors per receiving element, relative to the mean, for later refinements. Parts
    /// inherit it from their wholes. Empty: uniform.
    void set_importance(Field<ElementId, double> importance) { importance_ = std::move(importance); }

    /// Declares that links are always judged by the same light, so the light of earlier judgements need not be stored.
    void keep_light() { light_stays_ = true; }

    /// Sets the roughness of elements whose children are not held. For other elements the roughness is computed.
    void set_roughness(Field<ElementId, double> roughness) { roughness_ = std::move(roughness); }

    /// Splits leaves; their parts inherit the functions of `b` and of each field in `also`.
    void cut_elements(const std::vector<ElementId>& elements, NodalField& b, std::span<NodalField* const> also);

    /// Stores values for the children (if any) of these elements from now on, starting with their present light.
    void open(std::vector<ElementId> parents);

    /// Errors: root of the sum of areas times squared errors, W/m^2 m. link_error(): of rules and visibility, over
    /// links; interpolation_error(): over receivers.
    double link_error() const { return link_error_; }
    double interpolation_error() const { return std::sqrt(interpolation_); }
    double error() const { return std::hypot(link_error(), interpolation_error()); }
    /// True if refinement stopped at the maximum number of links.
    bool is_limited() const { return limited_; }
    /// Memory per link during refinement including its block, bytes.
    static constexpr std::size_t bytes_a_link = 150;
    /// Unoccluded power of all links, mean over bands, W; open_light(): the part of it that is certainly unoccluded.
    double light() const { return light_; }
    double open_light() const { return open_light_; }
    std::size_t size() const { return links_.size(); }
    Links make_links() const;

    /// Writes or reads the state of the refinement, for checkpoints.
    template <class Archive>
    void archive_state(Archive& a) {
        a(importance_, roughness_, links_, blocks_, shadows_, interpolation_, rays_, form_factors_, begun_, limited_);
        judged_.archive_state(a);
    }

    std::size_t field_bytes() const { return judged_.memory_bytes() + 8 * roughness_.size(); }
    std::size_t rays() const { return rays_; }
    std::size_t form_factors() const { return form_factors_; }

  private:
    /// The result of judging a block of pairs.
    struct Block;
    static LinkPair pair_of(const FoundLink& found);
    const float* shadow_of(const FoundLink& found) const {
        return found.shadow == FoundLink::none ? nullptr : &shadows_[found.shadow];
    }
    void judge_all_pieces(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop);
    void judge_again(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop);
    /// Factor by which a source's light has grown since its links were judged, if it has kept its shape; otherwise -1.
    double growth(const NodalField& b, ElementId source) const;
    std::vector<LinkPair> take_stale_links(const NodalField& b, const LinkTolerance& tolerance);
    Block judge_block(std::span<const LinkPair> pairs, LinkJudge& judge, std::span<const PieceId> pool) const;
    void add_links_of(const Block& block);
    void judge(std::vector<LinkPair> pairs, const NodalField& b, const LinkTolerance& tolerance,
               const StopRequest& stop);
    void cut_until_good(NodalField& b, std::span<NodalField* const> also, const LinkTolerance& tolerance,
                        Progress& progress, const StopRequest& stop);
    /// Splits receivers whose light departs too much from a polynomial; returns the pairs that their parts inherit.
    struct Receivers;
    Field<ElementId, std::uint8_t> judge_receivers(Receivers& receivers, const LinkTolerance& tolerance,
                                                   std::vector<ElementId>& leaves);
    std::vector<LinkPair> cut_receivers(NodalField& b, std::span<NodalField* const> also,
                                        const LinkTolerance& tolerance, Receivers& receivers);

    void sum_up();

    ElementTree& tree_;
    LinkSites& sites_;
    Light light_below_;
    double weight(ElementId receiver) const { return importance_.empty() ? 1 : importance_[receiver]; }
    /// Per held element: RMS deviation of its descendants' light from its own function.
    Field<ElementId, double> roughness_;
    Field<ElementId, double> importance_;
    std::vector<FoundLink> links_;
    std::vector<float> blocks_, shadows_;
    NodalField judged_;         ///< The light by which links were last judged; unused after keep_light().
    double interpolation_ = 0;  ///< Squared interpolation error.
    double link_error_ = 0, light_ = 0, open_light_ = 0;
    std::size_t rays_ = 0, form_factors_ = 0;
    bool begun_ = false, limited_ = false, light_stays_ = false;
};

}  // namespace exitance
