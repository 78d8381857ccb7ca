#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "exitance/direct/beams.hpp"
#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/scene/sky/sky_window.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/shaft.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// The sources of direct light for one convex part of a surface: the emitters visible from some point of it, and their
/// possible blockers. Computed once per part, it saves every point of the part the tree search.
struct ReceiverLight {
    struct Source {
        std::uint32_t emitter = 0;
        PieceId piece;
        /// Range of the source's blockers in `candidates`; empty: the whole piece is visible.
        std::uint32_t first = 0, count = 0;
        /// The range holds only some of too many candidates: exact light must not be computed.
        bool is_crowded = false;
        bool in_batch = false;   ///< True if the source is in the batch `open`.
        double far_factor = -1;  ///< Form factor F of the sky's unoccluded part, the same at every point.
    };
    Normal n;
    RegionId own;
    std::vector<Source> sources;  ///< Sources that are not certainly hidden.
    std::vector<Beam> beams;      ///< Punctual lights that are not certainly hidden.
    std::vector<PieceId> candidates;
    QuadBatch open;                     ///< Fully visible sources of at most four corners, in the order of `sources`.
    std::vector<Spectrum> open_light;   ///< Exitances of the sources in `open`.
    std::vector<ReceiverLight> behind;  ///< For diffusing panes: one entry, the light on the other side.
    double through = 0;                 ///< Weight of the light in `behind` (Material::through).

    void clear();
    bool is_dark() const {  ///< True if certainly no light arrives.
        return sources.empty() && beams.empty() && (behind.empty() || behind[0].is_dark());
    }
    bool has_crowded() const {  ///< True if a source has more blocker candidates than the limit for counting them.
        return std::any_of(sources.begin(), sources.end(), [](const Source& s) { return s.is_crowded; }) ||
               (!behind.empty() && behind[0].has_crowded());
    }
    bool is_unshadowed() const {  ///< True if certainly no shadow edge crosses the part, so that its light is smooth.
        return candidates.empty() && (behind.empty() || behind[0].is_unshadowed());
    }
};

/// Direct light of emitters and punctual lights, exact at every point.
class DirectLight {
  public:
    using Workspace = VisibilityWorkspace;

    /// `scene` and `occluders` must outlive this object.
    DirectLight(const Scene& scene, const Occluders& occluders);

    /// Returns the irradiance (W/m^2) at x on a surface of normal n:
    ///
    ///     E = sum over emitters s of  M_s F(x, visible part of s),
    ///
    /// F is weighted by relative radiance if s is not diffuse (directed_form_factor.hpp). Adds the light of punctual
    /// lights (beams.hpp), and on a diffusing pane combines both sides (Material::through).
    /// x    point on region `own`; it is projected to the plane of the region
    /// own  region of the point, or none
    /// Does not check whether another surface covers the point (see Occluders::is_covered). Exact except for rounding
    /// (1e-12 relative unless F is tiny); error 1e-3 for directed emitters. About 1-5 microseconds per visible emitter.
    Spectrum irradiance(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const;

    /// Like irradiance(), if that takes no more work than `max_work` (VisibilityWorkspace::work); else none.
    std::optional<Spectrum> irradiance_within(const Point& x, const Normal& n, RegionId own, double max_work,
                                              Workspace& scratch) const;

    /// Identifies a convex piece of an emitter.
    struct SourceName {
        std::uint32_t emitter = 0;
        PieceId piece;
    };

    /// Returns the maximum number of blocker candidates of a source. A source with more is marked `is_crowded`, and
    /// irradiance() must not be called for a list of sources that contains it. Empty: no limit.
    using WorthCounting = std::function<std::size_t(const SourceName&)>;

    /// Finds the sources of a convex polygon of region `own` (metres, counter-clockwise about n). Fills `light`, whose
    /// memory is reused. About 1-2 microseconds per emitter, plus the traversal of the tree in the shaft.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, ReceiverLight& light,
                 Workspace& scratch, const WorthCounting& worth = {}) const;

    /// Like prepare() above, for the given sources only, without beams.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::span<const SourceName> sources,
                 ReceiverLight& light, Workspace& scratch, const WorthCounting& worth = {}) const;

    /// Like prepare() above, for a part of the polygon of `whole`. Tests only the candidates of `whole`.
    void prepare(std::span<const Point> receiver, const ReceiverLight& whole, ReceiverLight& light,
                 Workspace& scratch) const;

    /// Returns the irradiance at a point of the polygon for which `light` was prepared, equal to irradiance() above up
    /// to rounding. Adds the light from outside (parallel light and the sky) to `parallel`, if given.
    Spectrum irradiance(const ReceiverLight& light, const Point& x, Workspace& scratch,
                        Spectrum* parallel = nullptr) const;

    const Beams& beams() const { return beams_; }

    /// An emitting region: its convex pieces, and a bounding ball for quick rejection.
    struct Emitter {
        RegionId region;
        Spectrum exitance;  ///< W/m^2
        Plane plane;
        Point centre;
        double radius = 0;  ///< m
        IdRange<PieceId> pieces;
        RelativeRadiance radiance = {};
        /// Part of the sky. `open`: the open sky, for receivers outside of the enclosure; `window`: the sky through a
        /// pane, for receivers inside.
        enum class Sky : std::uint8_t { none, open, window } sky = Sky::none;
    };
    const std::vector<Emitter>& emitters() const { return emitters_; }
    /// Keeps only these emitters (indices in ascending order), and the punctual lights only if `beams`.
    void keep_only(std::span<const std::uint32_t> emitters, bool beams);
    /// True unless light of the emitter certainly cannot reach region `own` (or none).
    bool shines_on(const Emitter& emitter, RegionId own) const {
        return !is_own(emitter, own) && (emitter.sky == Emitter::Sky::none ||
                                         occluders_->enclosure().holds(own) == (emitter.sky == Emitter::Sky::window));
    }
    /// True for parts of the sky, which are last in the list and are not regions.
    bool is_distant(std::size_t emitter) const { return emitter >= first_distant_; }
    /// True for a part of the open sky, which is infinitely far away and not bounded by a pane.
    bool looks_far(std::size_t emitter) const {
        return is_distant(emitter) && emitters_[emitter].sky != Emitter::Sky::window;
    }
    static bool is_own(const Emitter& emitter, RegionId own) { return !own.is_none() && emitter.region == own; }
    const Occluders& occluders() const { return *occluders_; }
    /// The scene whose materials and lights emit; the occluders have the same geometry.
    const Scene& scene() const { return *scene_; }

    /// Returns the form factor from a receiver to the visible part of an emitter, weighted by its relative radiance.
    double form_factor(const SurfacePoint& at, const Emitter& emitter, Workspace& scratch) const;

    /// Returns a receiver for visibility computations: x projected to the plane of region `own` (or unchanged if none).
    SurfacePoint receiver(const Point& x, const Normal& n, RegionId own) const;

  private:
    void add_distant_emitters(const Scene& scene);
    void add_windows(const Scene& scene);
    Emitter emitter_of(PieceId piece, const Spectrum& exitance) const;
    /// True if light of this emitter may have to pass panes. A window's own pane is part of its emitter.
    bool is_glazed(const Emitter& emitter) const {
        return emitter.sky == Emitter::Sky::window ? !occluders_->enclosure().others.empty()
                                                   : !occluders_->scene().panes().empty();
    }
    Spectrum light_of(const Emitter& emitter, const SurfacePoint& at, Workspace& scratch) const;
    Spectrum on_side(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const;
    Spectrum on_side(const ReceiverLight& light, const Point& x, Workspace& scratch, Spectrum* parallel) const;
    void prepare_side(std::span<const Point> receiver, const Normal& n, RegionId own, ReceiverLight& light,
                      Workspace& scratch, const WorthCounting& worth) const;
    void look_at(const SourceName& source, std::span<const Point> receiver, ReceiverLight& light, Workspace& scratch,
                 const WorthCounting& worth) const;
    /// Adds a source with its blockers to `light`. `x`: any point of the receiver.
    void add_source(const SourceName& source, View view, const Point& x, ReceiverLight& light,
                    Workspace& scratch) const;
    void add_open(const SourceName& source, const Point& x, ReceiverLight& light, Workspace& scratch) const;
    /// True if each polygon has a corner in front of the plane of the other.
    bool face_each_other(const Plane& receiver_plane, std::span<const Point> receiver, const Plane& source_plane,
                         std::span<const Point> source) const;

    const Scene* scene_;
    const Occluders* occluders_;
    std::vector<Emitter> emitters_;
    std::size_t first_distant_ = 0;
    std::vector<std::unique_ptr<const SkyWindow>> windows_;
    Beams beams_;
};

}  // namespace exitance
