#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "exitance/direct/beams.hpp"
#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/scene/sky/sky_window.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/shaft.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// What is known about the emitters from everywhere on one convex part of a surface: which of them can be seen, and
/// what can stand in between. Made once a part, it saves every point of it the search of the tree.
struct ReceiverLight {
    struct Source {
        std::uint32_t emitter = 0;
        PieceId piece;
        std::uint32_t first = 0, count = 0;  ///< Of `candidates`; none: all of the piece is visible.
        bool is_crowded = false;             ///< They are some of more than are worth counting: exact light wants all.
        bool in_batch = false;               ///< One of `open`.
        double far_factor = -1;              ///< Of a part of the sky that is all visible: F, alike everywhere.
    };
    Normal n;
    RegionId own;
    std::vector<Source> sources;  ///< Those that are not certainly hidden.
    std::vector<Beam> beams;      ///< Of lights without extent, likewise.
    std::vector<PieceId> candidates;
    QuadBatch open;                     ///< Sources of four corners or less that are all visible, in their order,
    std::vector<Spectrum> open_light;   ///< and their exitances.
    std::vector<ReceiverLight> behind;  ///< Of a diffusing pane, one: that of its other side,
    double through = 0;                 ///< and what it counts (Material::through).

    void clear();
    bool is_dark() const {  ///< No light from anywhere, certainly.
        return sources.empty() && beams.empty() && (behind.empty() || behind[0].is_dark());
    }
    bool is_unshadowed() const {  ///< Smooth: no shadow edge crosses it, certainly.
        return candidates.empty() && (behind.empty() || behind[0].is_unshadowed());
    }
};

/// The light that arrives straight from the emitters and from lights without extent, exact at every point.
class DirectLight {
  public:
    using Workspace = VisibilityWorkspace;

    /// Both must outlive it.
    DirectLight(const Scene& scene, const Occluders& occluders);

    /// Irradiance (W/m^2) at x on a surface of normal n:
    ///
    ///     E = sum over emitters s of  M_s F(x, visible part of s),
    ///
    /// F weighted by relative radiance where s is not diffuse (directed_form_factor.hpp; to 1e-3 there), and what
    /// lights without extent bring (beams.hpp); of a diffusing pane what both sides have (Material::through). Exact but
    /// for rounding (1e-12 relative where F is not tiny). x lies on region `own`, into whose plane it is moved, or own
    /// is none. A point that another surface covers is for the caller to ask about (Occluders::is_covered). About 1-5
    /// microseconds an emitter in view.
    Spectrum irradiance(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const;

    /// A convex piece of an emitter.
    struct SourceName {
        std::uint32_t emitter = 0;
        PieceId piece;
    };

    /// How many candidates of a source are worth counting: one with more is crowded, and light at points is not to be
    /// asked for while it is among the sources. Empty: all are counted. On diffusing panes all are in any case.
    using WorthCounting = std::function<std::size_t(const SourceName&)>;

    /// Looks at the emitters from a convex polygon of region `own` (metres, counter-clockwise about n); fills `light`,
    /// whose memory is used again. About 1-2 microseconds an emitter, and what the shaft meets of the tree.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, ReceiverLight& light,
                 Workspace& scratch, const WorthCounting& worth = {}) const;

    /// The same for these sources alone, and no beams.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::span<const SourceName> sources,
                 ReceiverLight& light, Workspace& scratch, const WorthCounting& worth = {}) const;

    /// The same for a part of the polygon that `whole` was made for: only what reached into its shafts is looked at.
    void prepare(std::span<const Point> receiver, const ReceiverLight& whole, ReceiverLight& light,
                 Workspace& scratch) const;

    /// The irradiance at a point of the polygon that `light` was made for: as above, up to rounding. What comes from
    /// outside, by parallel light and from the sky, is added to `parallel`, if given.
    Spectrum irradiance(const ReceiverLight& light, const Point& x, Workspace& scratch,
                        Spectrum* parallel = nullptr) const;

    const Beams& beams() const { return beams_; }

    /// An emitting region: its convex pieces, and a ball around it for quick rejection.
    struct Emitter {
        RegionId region;
        Spectrum exitance;  ///< W/m^2
        Plane plane;
        Point centre;
        double radius = 0;  ///< m
        IdRange<PieceId> pieces;
        RelativeRadiance radiance = {};
        /// A part of the sky: all of it, for whom the enclosure does not hold, or what is seen through a pane, for the
        /// others.
        enum class Sky : std::uint8_t { none, open, window } sky = Sky::none;
    };
    const std::vector<Emitter>& emitters() const { return emitters_; }
    /// Leaves these emitters, by their numbers in rising order, and lights without extent only if they are to stay.
    void keep_only(std::span<const std::uint32_t> emitters, bool beams);
    /// Can its light come to a region (or none) at all?
    bool shines_on(const Emitter& emitter, RegionId own) const {
        return !is_own(emitter, own) && (emitter.sky == Emitter::Sky::none ||
                                         occluders_->enclosure().holds(own) == (emitter.sky == Emitter::Sky::window));
    }
    /// Those of the sky come last; they are no regions.
    bool is_distant(std::size_t emitter) const { return emitter >= first_distant_; }
    /// Is it a part of the sky that no pane bounds, and as far away?
    bool looks_far(std::size_t emitter) const {
        return is_distant(emitter) && emitters_[emitter].sky != Emitter::Sky::window;
    }
    static bool is_own(const Emitter& emitter, RegionId own) { return !own.is_none() && emitter.region == own; }
    const Occluders& occluders() const { return *occluders_; }

    /// Form factor from a receiver to the visible part of an emitter, weighted by its relative radiance.
    double form_factor(const Receiver& at, const Emitter& emitter, Workspace& scratch) const;

    /// A point of region `own` (or none) as visible parts are seen from it: in the region's plane.
    Receiver receiver(const Point& x, const Normal& n, RegionId own) const;

  private:
    void add_distant_emitters(const Scene& scene);
    void add_windows(const Scene& scene);
    Emitter emitter_of(PieceId piece, const Spectrum& exitance) const;
    /// Do panes stand before it? That of a window is a part of it.
    bool is_glazed(const Emitter& emitter) const {
        return !occluders_->scene().panes().empty() && emitter.sky != Emitter::Sky::window;
    }
    Spectrum light_of(const Emitter& emitter, const Receiver& at, Workspace& scratch) const;
    Spectrum on_side(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const;
    Spectrum on_side(const ReceiverLight& light, const Point& x, Workspace& scratch, Spectrum* parallel) const;
    void prepare_side(std::span<const Point> receiver, const Normal& n, RegionId own, ReceiverLight& light,
                      Workspace& scratch, const WorthCounting& worth) const;
    void look_at(const SourceName& source, std::span<const Point> receiver, ReceiverLight& light, Workspace& scratch,
                 const WorthCounting& worth) const;
    /// x: any point of the receiver.
    void add_source(const SourceName& source, View view, const Point& x, ReceiverLight& light,
                    Workspace& scratch) const;
    void add_open(const SourceName& source, const Point& x, ReceiverLight& light, Workspace& scratch) const;
    /// Does any of either polygon rise over the plane of the other?
    bool face_each_other(const Plane& receiver_plane, std::span<const Point> receiver, const Plane& source_plane,
                         std::span<const Point> source) const;

    const Occluders* occluders_;
    std::vector<Emitter> emitters_;
    std::size_t first_distant_ = 0;
    std::vector<std::unique_ptr<const SkyWindow>> windows_;
    Beams beams_;
};

}  // namespace exitance
