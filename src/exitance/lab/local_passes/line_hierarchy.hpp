#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/discontinuity/receiver_curves.hpp"
#include "exitance/mesh/discontinuity/line_tree.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

struct LineHierarchyOptions {
    /// BF_eps: most light that a link may carry, as a share of the flux emitted in the brightest band.
    double threshold = 0;
    double min_area = 0;    ///< Smallest node, as a share of the scene's area.
    std::size_t rays = 16;  ///< Rays per link.
    /// If true, direct light is a separate layer: its exact means on the leaves are linked instead of primary sources.
    bool layers = false;
    /// With layers: nodes whose leaves all reflect less than this have no links; share of the mean reflected direct
    /// light.
    double dark = 0;
    int rounds = 3;  ///< Rounds of refining links by the light of the last solve.
    std::uint64_t seed = 1;
};

/// The global pass of [Lischinski93]: hierarchical radiosity of constant elements on trees whose cuts follow
/// discontinuity lines (LineTree). A pair of nodes is linked if B_q F_pq A_p is below the threshold, otherwise the
/// larger node is split. Nodes of the smallest area are linked in any case. The threshold is a third if visibility is
/// partial. Links are refined again with the light of each solve. O(links x rays); bitwise equal for any number of
/// threads.
class LineHierarchy {
  public:
    struct Link {
        std::uint32_t receiver = 0, source = 0;
        float factor = 0;   ///< F_pq without blockers.
        float visible = 0;  ///< Unblocked share of the rays.
    };

    /// Limit on the pieces of a scene: all pairs are tested, which would take too much memory and time.
    static constexpr std::size_t max_pieces = 5'000;

    /// `stage` must outlive this object.
    LineHierarchy(const Stage& stage, const LineHierarchyOptions& options);

    /// Finds links and light. Returns false after a request to stop; the light is then that of fewer rounds, or
    /// missing.
    bool solve(Progress& progress, const StopRequest& stop);

    const Stage& stage() const { return stage_; }
    const LineTree& tree() const { return tree_; }
    const ReceiverCurves& receiver(RegionId region) const { return receivers_[region.value]; }
    std::span<const Link> links_of(std::uint32_t node) const {
        return std::span(links_).subspan(first_link_[node], first_link_[node + 1] - first_link_[node]);
    }
    const std::vector<Link>& links() const { return links_; }
    /// Mean irradiance and mean reflected radiosity of a node, W/m^2. Means of the leaves for inner nodes.
    const Spectrum& irradiance(std::uint32_t node) const { return E_[node]; }
    const Spectrum& reflected(std::uint32_t node) const { return b_[node]; }
    /// Radiosity that links take from a node, W/m^2: M + b, or b if direct light is a separate layer.
    Spectrum sent(std::uint32_t node) const;
    bool is_primary(std::uint32_t node) const;
    std::span<const Point> corners(std::uint32_t node) const {
        return std::span(corners_).subspan(first_corner_[node], first_corner_[node + 1] - first_corner_[node]);
    }
    const Normal& normal(std::uint32_t node) const;
    /// Returns the leaf that contains a point of a region.
    std::uint32_t leaf_at(RegionId region, const Point& p) const;
    /// Writes `count` stratified points of a node to `out`.
    void points_on(std::uint32_t node, std::uint64_t key, std::size_t count, std::vector<Point>& out) const;
    const LineHierarchyOptions& options() const { return options_; }

    std::size_t rays() const { return rays_; }
    std::size_t form_factors() const { return form_factors_; }
    std::size_t leaf_count() const;
    std::size_t iterations() const { return iterations_; }
    double change() const { return change_; }  ///< Relative change of all reflected light in the last iteration.

  private:
    struct Judged {
        Link link;
        /// 0: linked, 1: split the receiver, 2: split the source, 3: never any light, 4: too dark at present.
        std::uint8_t cut = 0;
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
    std::vector<std::vector<std::uint32_t>> roots_;  ///< Roots of each region.
    std::vector<Point> corners_;
    std::vector<std::size_t> first_corner_;
    std::vector<std::uint8_t> whole_;  ///< Per node: 1 if no cut can split it.
    std::vector<Spectrum> E_, b_, direct_;
    std::vector<double> brightest_;  ///< Per node: largest value among its leaves.
    std::vector<Link> links_;
    std::vector<std::size_t> first_link_;
    Pairs dark_;  ///< Pairs that are too dark at present.
    double threshold_ = 0, min_area_ = 0, darkest_ = 0;
    std::size_t rays_ = 0, form_factors_ = 0, iterations_ = 0;
    double change_ = 0;
};

}  // namespace exitance
