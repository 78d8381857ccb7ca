#pragma once

#include <compare>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "exitance/direct/distant_sources.hpp"
#include "exitance/direct/emitter_tree.hpp"
#include "exitance/direct/light_accuracy.hpp"
#include "exitance/direct/sky_openings.hpp"
#include "exitance/direct/sky_tree.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/visibility/glass/glass_colours.hpp"
#include "exitance/visibility/portal_aim.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Direct light at a place by rays, for scenes in which exact visible parts are too expensive: thousands of faces under
/// a sky, thousands of emitters, or many blockers. The light is a sum over parts: the sky, the sky seen through
/// openings of rooms, strong emitters and discs of the sun one by one, and all other emitters together.
///
///     E = sum over parts of  L sum over rays of w_i V_i / sum over rays of w_i,    w_i = (radiance cos) / density,
///
/// where L is the light of the part without occlusion. Rays to the sky have the density of radiance times cosine
/// (SkyTree), rays to an emitter that of its area or solid angle (SeenPolygon), rays to openings lead to uniform points
/// of them (PortalAim), rays to the other emitters choose one by a cut through the tree of emitters [Walter05]; for
/// openings and other emitters the mean of w V is used, since L is not known exactly. The mean over many places is the
/// exact light. For elements there is a form whose rays start all over the element (on_element). Rays are points of a
/// scrambled Sobol sequence, so that the error falls about as n^(-3/4) where light is cut by edges. The sequence
/// depends on the coordinates of the place alone: every caller gets the same light there.
///
/// A pilot of a few rays per part estimates variances; rays are then added to each part in the proportion that reaches
/// the required accuracy with fewest. A place that stops as soon as its own rays agree is too dark in the mean: rays
/// that missed a window agree, too. Places of an element are therefore given numbers of rays that other rays decided
/// (`Spread`) [Kirk91]. Panes let rays pass at random, in proportion to their transmission. Light of
/// punctual lights is exact.
class RayLight {
  public:
    /// Nearly hidden light needs no better accuracy than light of this share of the unoccluded light. Chosen: half of
    /// it takes 55% more rays and twice it the same number, measured by `exitance solve carpet.obj --error 0.1`
    /// (carpet u=12 v=13 cuts=1 books=0).
    static constexpr double min_share = 0.05;

    /// Both arguments must outlive this object.
    RayLight(const DirectLight& direct, const RayTracer& tracer);

    class Workspace;
    struct Estimate {
        Spectrum irradiance = {};  ///< W/m^2
        Spectrum parallel = {};    ///< The part of `irradiance` from sky and sun.
        double variance = 0;       ///< Variance of the mean over bands, (W/m^2)^2; 0: exact.
        std::size_t rays = 0;      ///< Number of rays cast.
        double work = 0;           ///< Cost of attempts at exact light, with or without success, in rays.

        /// Returns the standard error per band, in proportion to the light of the band, W/m^2.
        Spectrum standard_error() const;
    };

    /// Variance of one ray to each kind of part, (W/m^2)^2, so that n rays have this times n^(-3/2); empty where no
    /// place had such a part. Strong emitters and suns decide for themselves: their light is cut by sharp shadows, and
    /// differs from place to place.
    struct Spread {
        std::optional<double> sky = {}, openings = {}, others = {};
    };
    /// The spreads on both sides of a surface.
    struct Spreads {
        Spread front, back;
    };
    /// Measures the spreads at some of the places, by rays that at() never casts.
    Spreads spreads(std::span<const Point> places, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                    Workspace& room) const;

    /// Returns the light at x on region `own` (none: in free space). `known`: decides the numbers of rays; null: the
    /// rays themselves do, so that the mean over many places is too small where few rays find light, unless the
    /// accuracy demands many. About 0.2 us per ray.
    Estimate at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room,
                const Spreads* known = nullptr) const;

    /// Forecasts the work of at(), in rays.
    double forecast(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                    Workspace& room) const;

    /// Light of an element from the emitters that contribute little there.
    struct ElementEstimate {
        Spectrum irradiance = {};   ///< Mean over the element, W/m^2.
        double variance = 0;        ///< Variance of this mean, mean over bands, (W/m^2)^2.
        double misfit_squared = 0;  ///< Estimate of the mean of (w (E - irradiance))^2 over the element, w the weight.
        std::vector<DirectLight::SourceName> strong = {};  ///< All other sources: their visibility must be exact.
    };
    /// Separates the emitters that contribute little to an element from the others, and estimates their light by `rays`
    /// rays from the element to the tree of emitters. For buildings, in which hundreds of emitters shine through doors
    /// on thousands of small objects. As many emitters count as weak as cause a misfit of at most `allowed` if their
    /// light is treated as constant, weighted by `weight`. The mean over many elements is the exact light, except for
    /// sources that do not face an element's centre. Sky, sun and punctual lights are left out, and the region must not
    /// transmit light. About 100 ns per term of the cut through the tree, or per source if any is directed, plus rays.
    ElementEstimate on_element(const ElementTree& tree, ElementId e, const Spectrum& weight, double allowed,
                               std::uint32_t rays, Workspace& room) const;

    /// Variance of light that varies between 0 and U, as a share of U^2. Derived from its maximum, 1 / 4, of which half
    /// is typical.
    static constexpr double typical_variance = 0.125;

    /// Returns the number of rays after which stratified rays reach an error, relative to the unoccluded light of a
    /// source that is half hidden.
    static double rays_for(double relative_error);
    /// Like rays_for(), for light whose part without occlusion is `open` > 0, W/m^2.
    static double rays_for(const LightAccuracy& accuracy, double open);
    /// Returns the random key of a place.
    static std::uint64_t key_of(const Point& x, RegionId own);
    /// Returns the inverse of rays_for().
    static double error_of(double rays);

    /// The tree of the emitters that are not parts of the open sky.
    const EmitterTree& emitters() const { return tree_; }

  private:
    struct Part;
    struct Start;
    class RayMaker;
    Estimate on_side(const Start& start, const LightAccuracy& accuracy, const Spread* known, Workspace& room) const;
    Spread spread_on_side(std::span<const Point> places, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                          Workspace& room) const;
    double expected_variance(const Part& part, const Spread* known) const;
    const SkyOpenings& openings() const;
    double find_parts(const SurfacePoint& at, const LightAccuracy& accuracy, Workspace& room) const;
    void add_openings(const SurfacePoint& at, const LightAccuracy& accuracy, Workspace& room) const;
    double variance(const Part& part) const;
    double light_through_openings(const Workspace& room) const;
    void add_discs(const SurfacePoint& at, Workspace& room) const;
    void add_piece(const SurfacePoint& at, const DirectLight::SourceName& source, Workspace& room) const;
    Spectrum open_light(const SurfacePoint& at, const DirectLight::SourceName& source, Workspace& room) const;
    void add_rays(const Start& start, Part& part, std::uint32_t last, Workspace& room) const;
    void trace(Workspace& room) const;
    void continue_through_windows(Workspace& room) const;
    void find_terms(const SurfacePoint& at, double radius, Workspace& room) const;
    void find_terms_in_sight(const Start& start, Workspace& room) const;

    /// Standard deviation of the light that one ray finds from a half-hidden source, relative to the source's
    /// unoccluded light. Features that carry less light than one ray may be missed by all rays; this share of one ray's
    /// light is their assumed standard deviation.
    static constexpr double half_hidden = 0.5;
    static constexpr std::uint32_t min_pilot = 16, max_pilot = 64;
    /// Rounds a number of rays up to a power of two between `least` and `most`.
    static std::uint32_t power_of_two(double rays, std::uint32_t least, std::uint32_t most);

    const DirectLight* direct_;
    const RayTracer* tracer_;
    EmitterTree tree_;
    SkyTree sky_;
    std::vector<DistantDisc> discs_;   ///< Suns; they appear in the same direction from every point.
    mutable std::once_flag searched_;  ///< Guards `openings_`, which is made at the first call of openings().
    mutable std::unique_ptr<const SkyOpenings> openings_;
    double size_ = 0;  ///< m
    GlassColours glass_;
};

/// A source of light, or group of sources, that is sampled by rays of its own.
struct RayLight::Part {
    enum class Kind : std::uint8_t { sky, openings, piece, others } kind = Kind::sky;
    DirectLight::SourceName source = {};  ///< The source, if `kind` is piece.
    Spectrum open;                        ///< Light without occlusion, W/m^2; for `openings`, `others` an estimate.
    const SeenPolygon* seen = nullptr;    ///< The source's polygon, if `kind` is piece.
    double unaimed = 0;                   ///< Light through openings at which no rays are aimed, W/m^2, of the sky.
    std::uint32_t scene_part = 0;         ///< Part of the scene in SkyOpenings, of the sky and of suns.
    bool is_sun = false;                  ///< True for a disc of the sun.
    Point from = {};                      ///< Viewpoint of a piece: the place, or the scene's middle for the sun.
    std::uint32_t rays = 0;               ///< Rays cast so far: a power of two.
    std::uint32_t block = 1;              ///< Rays per block.
    bool by_term = false;                 ///< True if every term of the cut has a block of its own; `others` only.
    /// Sums over a block of rays: of the weights, and of the weights of the rays that arrive.
    struct Block {
        Spectrum all, arrived;
    };
    std::vector<Block> blocks = {};
    Spectrum distant = {};  ///< Sum over arriving rays from outside; `others` only.

    /// True if the mean of the rays' weights is the light; otherwise only their ratio matters.
    bool counts_weights() const { return kind == Kind::openings || kind == Kind::others; }
    Spectrum light() const;
    double variance(double missed) const;
    std::uint64_t sequence() const;  ///< Distinguishes the random numbers of parts.
};

/// Place from which rays start, or element on which they start at uniform points.
struct RayLight::Start {
    SurfacePoint at;    ///< The place, or a point of the element.
    std::uint64_t key;  ///< Random key.
    const ElementTree* tree = nullptr;
    ElementId element = {};  ///< Element of `tree`, if there is one.
};

/// Temporary storage; one per thread, for one RayLight.
class RayLight::Workspace {
  public:
    DirectLight::Workspace exact;

  private:
    friend RayLight;
    struct Ray {
        std::uint32_t part, block;
        bool is_distant;
        PieceId window;  ///< Window beyond which the ray must be continued; none: no window.
        Spectrum weight;
    };
    std::vector<Part> parts_;
    std::deque<SeenPolygon> seen_;
    SkyTree::Aim aim_;
    std::vector<PortalCell> cells_;  ///< Openings at which rays are aimed.
    PortalAim portals_;
    Normal disc_normal_;  ///< Receiver's normal, to which `disc_light_` belongs.
    /// Unoccluded light of each disc at a receiver with this normal; empty: not computed yet.
    std::vector<Spectrum> disc_light_;
    EmitterTree::Cut cut_;
    std::vector<double> chance_before_;  ///< Prefix sums of the chances of the terms of `others`.
    /// Term of the cut, as it shines on an element. Sorted by weakness.
    struct ElementTerm {
        double in_sight = 0;  ///< Visible light: all of it if a ray arrived, W/m^2.
        double astray = 0;    ///< Light that may vary over the element, W/m^2.
        std::uint32_t term = 0;
        double light = 0;  ///< Unoccluded light, W/m^2.

        auto operator<=>(const ElementTerm&) const = default;
    };
    std::vector<ElementTerm> terms_;
    std::vector<Ray> rays_;
    std::vector<RayEnd> from_, to_, onwards_from_, onwards_to_;
    std::vector<std::size_t> onwards_;
    std::vector<double> s_, t_, u_, start_s_, start_t_;
    std::unique_ptr<bool[]> blocked_;
    std::size_t blocked_size_ = 0;
};

}  // namespace exitance
