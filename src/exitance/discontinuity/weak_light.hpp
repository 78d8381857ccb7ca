#pragma once

#include <memory>
#include <vector>

#include "exitance/direct/possible_sources.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Which sources of direct light matter on each region of a building, and by rays what all others bring there:
///
///     E of weak sources ~ sum over sources s of  M_s F_s(x) sum over places of  K_i V_i / sum of  K_i,
///
/// F_s as if nothing stood in between, K = cos cos / (pi r^2), V_i whether place y_i of s is seen. The places of a
/// source are the same from everywhere, so that E is smooth but for steps as small as its rays are many, which no mesh
/// needs to follow: curves, wedges and exact visible parts are for the sources that are strong.
///
/// Of n rays a region's sources have shares in proportion to their bounds U_s (PossibleSources), so that a place is off
/// by (sum of U) / (2 sqrt(n)) in the mean square at most; a source of less than a ray is drawn by lot. As many sources
/// are weak, from the weakest on, as most_rays do for.
class WeakLight {
  public:
    static constexpr unsigned most_rays = 128;

    struct Asked {
        double negligible = 0;  ///< W/m^2 of E: what sources that are left out may bring together.
        double noise = 0;       ///< What rays may miss in the root mean square, W/m^2 of w E,
        double most_noise = 0;  ///< or more where a region is smaller than
        double area = 0;        ///< this, m^2: in proportion to (area / region)^(1/2), at most so much.
    };
    WeakLight(const DirectLight& direct, const RayTracer& tracer, const Asked& asked, const StopRequest& stop);

    /// Are emitters and regions so many that not all of them can be looked at exactly, and such that this can tell?
    static bool pays(const DirectLight& direct);

    /// Sources to be looked at exactly from this region.
    std::span<const DirectLight::SourceName> strong(RegionId r) const { return regions_[r].strong; }
    bool shines_on(RegionId r) const { return !regions_[r].weak.empty(); }
    /// By either kind?
    bool is_reached(RegionId r) const { return shines_on(r) || !regions_[r].strong.empty(); }
    /// What a source may bring to the region at most, W/m^2 of E, mean of the bands; 0 of one that is not strong.
    double bound(RegionId r, std::uint32_t emitter) const;

    class Workspace;
    /// At x on a region, W/m^2, of its weak sources.
    Spectrum irradiance(const Point& x, const Normal& n, RegionId r, Workspace& room) const;
    /// And of its strong ones, exact, which `strong` was prepared for. Many candidates are searched for in the tree
    /// once more: what the pyramid of one point meets is few of what stands before all of a face.
    Spectrum irradiance(const ReceiverLight& strong, const Point& x, Workspace& room) const;

  private:
    struct Weak {
        std::uint32_t source = 0;  ///< Of `sources_`.
        std::uint32_t rays = 1;
        float weight = 1;  ///< Above 1 where it was drawn by lot.
    };
    struct OfRegion {
        std::vector<DirectLight::SourceName> strong;
        std::vector<double> bounds;  ///< Of the strong ones.
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
    std::vector<std::uint32_t> first_of_emitter_;  ///< In sources_.
    Field<RegionId, OfRegion> regions_;
};

/// Room to work in; one a thread.
class WeakLight::Workspace {
  public:
    VisibilityWorkspace exact;

  private:
    friend WeakLight;
    RegionId region_;  ///< Whose sources stand in `quads_`.
    const WeakLight* owner_ = nullptr;
    QuadBatch quads_;
    std::vector<double> factors_, kernels_;
    std::vector<SurfacePoint> from_, to_;
    std::unique_ptr<bool[]> blocked_;
    std::size_t room_for_ = 0;
};

}  // namespace exitance
