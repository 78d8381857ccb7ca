#pragma once

#include <memory>
#include <vector>

#include "exitance/direct/possible_sources.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Divides the sources of direct light on each region of a building into strong and weak ones. The light of weak
/// sources is estimated by rays:
///
///     E of weak sources ~ sum over sources s of  M_s F_s(x) sum over points of  K_i V_i / sum of  K_i,
///
/// where F_s is the form factor without blockers, K = cos cos / (pi r^2), and V_i is 1 if point y_i of s is visible
/// from x. The points y_i of a source are the same for all x. E is then smooth except for steps too small for the mesh
/// to follow. Curves, wedges and exact visible parts are computed for strong sources only.
///
/// A region's n rays are shared among its sources in proportion to their bounds U_s (PossibleSources), so that the RMS
/// error at a point is at most (sum of U) / (2 sqrt(n)). A source with a share of less than one ray is selected at
/// random. Sources count as weak, starting with the weakest, for as long as `max_rays` rays suffice.
class WeakLight {
  public:
    static constexpr unsigned max_rays = 128;

    struct Asked {
        double negligible = 0;  ///< Permitted irradiance of all omitted sources together, W/m^2.
        double noise = 0;       ///< Permitted RMS error of rays, W/m^2 of w E.
        double max_noise = 0;   ///< Largest permitted RMS error on regions smaller than `area`, W/m^2 of w E.
        /// Below this area (m^2) the permitted error grows with (area / region)^(1/2), up to `max_noise`.
        double area = 0;
        /// Regions where all sources count as strong; null or empty: none.
        const Field<RegionId, std::uint8_t>* exact = nullptr;
    };
    WeakLight(const DirectLight& direct, const RayTracer& tracer, const Asked& asked, const StopRequest& stop);

    /// True if there are too many emitters and regions for exact light of all sources, and rays can estimate them.
    static bool pays(const DirectLight& direct);

    /// Sources to be evaluated exactly on this region.
    std::span<const DirectLight::SourceName> strong(RegionId r) const { return regions_[r].strong; }
    bool shines_on(RegionId r) const { return !regions_[r].weak.empty(); }
    /// True if any strong or weak source may light the region.
    bool is_reached(RegionId r) const { return shines_on(r) || !regions_[r].strong.empty(); }
    /// Upper bound on the irradiance from a strong source on the region, W/m^2, mean of the bands; 0 for other sources.
    double bound(RegionId r, std::uint32_t emitter) const;

    class Workspace;
    /// Irradiance from the region's weak sources at a point x, W/m^2.
    Spectrum irradiance(const Point& x, const Normal& n, RegionId r, Workspace& room) const;
    /// Irradiance from all sources at x, W/m^2: strong ones exactly, weak ones by rays. `strong` was prepared from the
    /// strong sources. If a source has many candidates, the tree is searched again, since the pyramid between one point
    /// and the source meets far fewer blockers than the shaft of a whole face.
    Spectrum irradiance(const ReceiverLight& strong, const Point& x, Workspace& room) const;

  private:
    struct Weak {
        std::uint32_t source = 0;  ///< Index in `sources_`.
        std::uint32_t rays = 1;
        float weight = 1;  ///< Weight of the source's light; above 1 if it was selected at random.
    };
    struct OfRegion {
        std::vector<DirectLight::SourceName> strong;
        std::vector<double> bounds;  ///< Per strong source: upper bound of its irradiance on the region, W/m^2.
        std::vector<Weak> weak;
    };
    struct Emitting {
        DirectLight::SourceName name;
        std::vector<Point> places;
    };
    void choose(RegionId r, std::span<const PossibleSources::Source> from, const Asked& asked);

    const DirectLight* direct_;
    const RayTracer* tracer_;
    std::vector<Emitting> sources_;
    std::vector<std::uint32_t> first_of_emitter_;  ///< Index in `sources_` of each emitter's first piece.
    Field<RegionId, OfRegion> regions_;
};

/// Working memory. Each thread has its own.
class WeakLight::Workspace {
  public:
    VisibilityWorkspace exact;

  private:
    friend WeakLight;
    RegionId region_;  ///< The region whose sources are in `quads_`.
    const WeakLight* owner_ = nullptr;
    QuadBatch quads_;
    std::vector<double> factors_, kernels_;
    std::vector<RayEnd> from_, to_;
    std::unique_ptr<bool[]> blocked_;
    std::size_t room_for_ = 0;
};

}  // namespace exitance
