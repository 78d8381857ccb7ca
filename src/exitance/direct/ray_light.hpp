#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "exitance/direct/emitter_tree.hpp"
#include "exitance/direct/light_accuracy.hpp"
#include "exitance/direct/sky_openings.hpp"
#include "exitance/direct/sky_tree.hpp"
#include "exitance/direct/source_point.hpp"
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
/// exact light. Rays are points of a scrambled Sobol sequence, so that the error falls about as n^(-3/4) where light is
/// cut by edges. The sequence depends on the coordinates of the place alone: every caller gets the same light there.
///
/// A pilot of a few rays per part estimates variances; rays are then added to each part in the proportion that reaches
/// the required accuracy with fewest. Panes let rays pass at random, in proportion to their transmission. Light of
/// punctual lights is exact.
class RayLight {
  public:
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

    /// Returns the light at x on region `own` (none: in free space). About 0.2 us per ray.
    Estimate at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room) const;

    /// Forecasts the work of at(), in rays.
    double forecast(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                    Workspace& room) const;

    /// Returns the number of rays after which stratified rays reach an error, relative to the unoccluded light of a
    /// source that is half hidden.
    static double rays_for(double relative_error);
    /// Returns the random key of a place.
    static std::uint64_t key_of(const Point& x, RegionId own);
    /// Returns the inverse of rays_for().
    static double error_of(double rays);

    /// The tree of the emitters that are not parts of the open sky.
    const EmitterTree& emitters() const { return tree_; }

  private:
    struct Part;
    class RayMaker;
    Estimate on_side(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                     Workspace& room) const;
    const SkyOpenings& openings() const;
    double find_parts(const Receiver& at, const LightAccuracy& accuracy, Workspace& room) const;
    void add_openings(const Receiver& at, const LightAccuracy& accuracy, Workspace& room) const;
    double variance(const Part& part) const;
    double light_through_openings(const Workspace& room) const;
    void add_discs(const Receiver& at, Workspace& room) const;
    void add_piece(const Receiver& at, const DirectLight::SourceName& source, Workspace& room) const;
    Spectrum open_light(const Receiver& at, const DirectLight::SourceName& source, Workspace& room) const;
    void add_rays(const Receiver& at, Part& part, std::uint32_t last, std::uint64_t key, Workspace& room) const;
    void trace(const Receiver& at, Workspace& room) const;
    void continue_through_windows(const Receiver& at, Workspace& room) const;

    const DirectLight* direct_;
    const RayTracer* tracer_;
    EmitterTree tree_;
    SkyTree sky_;
    /// A disc of the sun, as seen from every place.
    struct Disc {
        DirectLight::SourceName name;
        SeenPolygon seen;
    };
    std::vector<Disc> discs_;
    mutable std::once_flag searched_;  ///< Guards `openings_`, which is made at the first call of openings().
    mutable std::unique_ptr<const SkyOpenings> openings_;
    double size_ = 0;           ///< m
    bool is_coloured_ = false;  ///< True if a pane's transmission differs between bands.
};

/// A source of light, or group of sources, that is sampled by rays of its own.
struct RayLight::Part {
    enum class Kind : std::uint8_t { sky, openings, piece, others } kind = Kind::sky;
    DirectLight::SourceName source = {};  ///< The source, if `kind` is piece.
    Spectrum open;                        ///< Light without occlusion, W/m^2; for `openings`, `others` an estimate.
    const SeenPolygon* seen = nullptr;    ///< The source's polygon, if `kind` is piece.
    double unaimed = 0;                   ///< Light through openings at which no rays are aimed, W/m^2, of the sky.
    bool is_sun = false;                  ///< True for a disc of the sun.
    Point from = {};                      ///< Viewpoint of a piece: the place, or the scene's middle for the sun.
    std::uint32_t rays = 0;               ///< Rays cast so far: a power of two.
    std::uint32_t block = 1;              ///< Rays per block.
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
    std::vector<Ray> rays_;
    std::vector<SurfacePoint> from_, to_, onwards_from_, onwards_to_;
    std::vector<std::size_t> onwards_;
    std::vector<double> s_, t_, u_;
    std::unique_ptr<bool[]> blocked_;
    std::size_t blocked_size_ = 0;
};

}  // namespace exitance
