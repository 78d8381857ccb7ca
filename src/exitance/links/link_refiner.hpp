#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/links/received_light.hpp"

namespace exitance {

/// Finds the links of a hierarchy. Pairs of elements are given, or every piece begins as a receiver that is linked to
/// all pieces; a source is cut until its link is good enough; a receiver is cut where the light of all its links
/// together is no polynomial over it, and hands on to its parts those links that are to blame. Source: [Hanrahan91].
///
/// Rounds: all pairs of a round are judged on all threads against a tree that stands still; elements are cut in the
/// order of their ids. So the result does not depend on threads. O(pairs + links).
class LinkRefiner {
  public:
    /// Finds light on elements that links come to: what fields hold on the children of `parents`, and how rough it is
    /// there, as NodalField::roughness() tells it. Called when their places are made.
    using Light = std::function<void(const std::vector<ElementId>& parents, Field<ElementId, double>& roughness)>;

    /// `light`: where `sites` do not hold all elements.
    LinkRefiner(ElementTree& tree, LinkSites& sites, Light light = {})
        : tree_(tree), sites_(sites), light_below_(std::move(light)), judged_(sites) {}

    /// Starts with all pairs of pieces, or goes on from the links that it found before. `b`: the light that elements
    /// reflect, at the nodes of all of them; elements that are cut hand on theirs, here and in each of `also`.
    void refine(NodalField& b, std::span<NodalField* const> also, const LinkTolerance& tolerance, Progress& progress,
                const StopRequest& stop);
    /// The same, with the pairs that are given beside the links that it found before.
    void refine(const std::vector<LinkPair>& fresh, NodalField& b, std::span<NodalField* const> also,
                const LinkTolerance& tolerance, Progress& progress, const StopRequest& stop);

    /// How much errors count on each element as a receiver, squared and relative to the mean, from the next refinement
    /// on; parts take it from their wholes. Empty: alike everywhere.
    void set_importance(Field<ElementId, double> importance) { importance_ = std::move(importance); }

    /// From now on links are judged by the same light whenever they are: what they were judged by is not kept.
    void keep_light() { light_stays_ = true; }

    /// Of elements whose children are not held; of others it is found by itself.
    void set_roughness(Field<ElementId, double> roughness) { roughness_ = std::move(roughness); }

    /// Cuts leaves; their parts take their functions, of `b` and of each of `also`.
    void cut_elements(const std::vector<ElementId>& elements, NodalField& b, std::span<NodalField* const> also);

    /// From now on the children of these, if they have any, are held, with the light that there is.
    void open(std::vector<ElementId> parents);

    /// Root of areas times squared errors, W/m^2 m: of rules and visibility, by link; of interpolation, by receiver.
    double link_error() const { return link_error_; }
    double interpolation_error() const { return std::sqrt(interpolation_); }
    double error() const { return std::hypot(link_error(), interpolation_error()); }
    /// Did the number of links end the refinement?
    bool is_limited() const { return limited_; }
    /// Bytes that a link takes while links are refined, with its block.
    static constexpr std::size_t bytes_a_link = 150;
    /// What links carry in the open, by mean bands, W, and how much of that meets nothing on its way, certainly.
    double light() const { return light_; }
    double open_light() const { return open_light_; }
    std::size_t size() const { return links_.size(); }
    Links make_links() const;

    /// What was found so far, for checkpoints.
    template <class Archive>
    void archive_state(Archive& a) {
        a(importance_, roughness_, links_, blocks_, shadows_, interpolation_, rays_, form_factors_, begun_, limited_);
        judged_.archive_state(a);
    }

    std::size_t field_bytes() const { return judged_.memory_bytes() + 8 * roughness_.size(); }
    std::size_t rays() const { return rays_; }
    std::size_t form_factors() const { return form_factors_; }

  private:
    /// What a block of pairs came to.
    struct Block;
    static LinkPair pair_of(const FoundLink& found);
    const float* shadow_of(const FoundLink& found) const {
        return found.shadow == FoundLink::none ? nullptr : &shadows_[found.shadow];
    }
    void judge_all_pieces(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop);
    void judge_again(const NodalField& b, const LinkTolerance& tolerance, const StopRequest& stop);
    /// How much more light a source sends than when its links were judged, if it is the same but for that; else -1.
    double growth(const NodalField& b, ElementId source) const;
    std::vector<LinkPair> take_stale_links(const NodalField& b, const LinkTolerance& tolerance);
    Block judge_block(std::span<const LinkPair> pairs, LinkJudge& judge, std::span<const PieceId> pool) const;
    void add_links_of(const Block& block);
    void judge(std::vector<LinkPair> pairs, const NodalField& b, const LinkTolerance& tolerance,
               const StopRequest& stop);
    void cut_until_good(NodalField& b, std::span<NodalField* const> also, const LinkTolerance& tolerance,
                        Progress& progress, const StopRequest& stop);
    /// Cuts receivers whose light departs too much from a polynomial; returns the pairs that their parts inherit.
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
    Field<ElementId, double> roughness_;  ///< Of elements that are held.
    Field<ElementId, double> importance_;
    std::vector<FoundLink> links_;
    std::vector<float> blocks_, shadows_;
    NodalField judged_;         ///< The light that links were judged by last, unless it stays.
    double interpolation_ = 0;  ///< Squared.
    double link_error_ = 0, light_ = 0, open_light_ = 0;
    std::size_t rays_ = 0, form_factors_ = 0;
    bool begun_ = false, limited_ = false, light_stays_ = false;
};

}  // namespace exitance
