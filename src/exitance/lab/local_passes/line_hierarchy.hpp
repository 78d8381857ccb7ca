#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/discontinuity/receiver_curves.hpp"
#include "exitance/mesh/discontinuity/line_tree.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

struct LineHierarchyOptions {
    double threshold = 0;   ///< BF_eps: what a link may carry, as a share of what the brightest band emits.
    double min_area = 0;    ///< No node is cut smaller, as a share of the scene's area.
    std::size_t rays = 16;  ///< A link.
    /// Direct light in a layer of its own: exact means of it on the leaves are what is linked, and primary sources are
    /// not.
    bool layers = false;
    /// With layers: nodes none of whose leaves reflect as much have no links, as a share of mean reflected direct
    /// light.
    double dark = 0;
    int rounds = 3;  ///< Of refining links by the light of the last solve.
    std::uint64_t seed = 1;
};

/// The global pass of [Lischinski93]: hierarchical radiosity of constants on trees whose cuts follow discontinuity
/// lines (LineTree). A pair of nodes is linked where B_q F_pq A_p is below the threshold, else the larger one is cut,
/// down to the least area, where links are made whatever they carry; a third of the threshold where visibility is
/// partial. Refined again by the light of each solve. O(links x rays); the same bits on any number of threads.
class LineHierarchy {
  public:
    struct Link {
        std::uint32_t receiver = 0, source = 0;
        float factor = 0;   ///< F_pq, nothing in between.
        float visible = 0;  ///< Share of the rays that pass.
    };

    /// All pairs of pieces are looked at: with more of them than this, memory and time are not to be had.
    static constexpr std::size_t most_pieces = 5'000;

    /// The stage must outlive it.
    LineHierarchy(const Stage& stage, const LineHierarchyOptions& options);

    /// Finds links and light. False where a stop cut it short; then there is light of fewer rounds, or none.
    bool solve(Progress& progress, const StopRequest& stop);

    const Stage& stage() const { return stage_; }
    const LineTree& tree() const { return tree_; }
    const ReceiverCurves& receiver(RegionId region) const { return receivers_[region.value]; }
    std::span<const std::uint32_t> roots_of(RegionId region) const { return roots_[region.value]; }
    std::span<const Link> links_of(std::uint32_t node) const {
        return std::span(links_).subspan(first_link_[node], first_link_[node + 1] - first_link_[node]);
    }
    const std::vector<Link>& links() const { return links_; }
    /// Mean irradiance (W/m^2) of a leaf, and what it reflects; of inner nodes means of the leaves.
    const Spectrum& irradiance(std::uint32_t node) const { return E_[node]; }
    const Spectrum& reflected(std::uint32_t node) const { return b_[node]; }
    /// What links take from a node: M + b, or b where direct light is apart.
    Spectrum sent(std::uint32_t node) const;
    bool is_primary(std::uint32_t node) const;
    std::span<const Point> corners(std::uint32_t node) const {
        return std::span(corners_).subspan(first_corner_[node], first_corner_[node + 1] - first_corner_[node]);
    }
    const Normal& normal(std::uint32_t node) const;
    /// The leaf that holds a point of a region.
    std::uint32_t leaf_at(RegionId region, const Point& p) const;
    /// Points of a node, stratified. Writes `count` of them.
    void points_on(std::uint32_t node, std::uint64_t key, std::size_t count, std::vector<Point>& out) const;
    const LineHierarchyOptions& options() const { return options_; }

    std::size_t rays() const { return rays_; }
    std::size_t form_factors() const { return form_factors_; }
    std::size_t leaf_count() const;
    std::size_t iterations() const { return iterations_; }
    double change() const { return change_; }  ///< Of all reflected light in the last iteration, relative.

  private:
    struct Judged {
        Link link;
        std::uint8_t cut = 0;  ///< 0: a link, 1: the receiver, 2: the source, 3: never any light, 4: too dark now.
    };
    Judged judge(std::uint32_t p, std::uint32_t q) const;
    double form_factor(std::uint32_t p, std::uint32_t q) const;
    double visibility(std::uint32_t p, std::uint32_t q) const;
    bool can_cut(std::uint32_t node) const;
    bool cut(std::uint32_t node);
    void add_corners();
    void cut_by_direct_light(const StopRequest& stop);
    using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
    bool link(Pairs pending, const StopRequest& stop);
    bool refine(const StopRequest& stop);
    void sort_links();
    void relax(const StopRequest& stop);
    void pull();

    const Stage& stage_;
    LineHierarchyOptions options_;
    LineTree tree_;
    std::vector<ReceiverCurves> receivers_;
    std::vector<std::vector<std::uint32_t>> roots_;  ///< By region.
    std::vector<Point> corners_;
    std::vector<std::size_t> first_corner_;
    std::vector<std::uint8_t> whole_;  ///< No cut leaves anything of these.
    std::vector<Spectrum> E_, b_, direct_;
    std::vector<double> brightest_;  ///< Of the leaves below.
    std::vector<Link> links_;
    std::vector<std::size_t> first_link_;
    Pairs dark_;  ///< Pairs that are too dark as yet.
    double threshold_ = 0, least_area_ = 0, darkest_ = 0;
    std::size_t rays_ = 0, form_factors_ = 0, iterations_ = 0;
    double change_ = 0;
};

}  // namespace exitance
