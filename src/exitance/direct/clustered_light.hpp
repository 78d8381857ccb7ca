#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "exitance/direct/emitter_tree.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// How far light at a point may be off: an RMS error of relative E + absolute.
struct LightAccuracy {
    double relative = 0;
    double absolute = 0;           ///< W/m^2, mean over bands.
    unsigned most_rays = 1 << 13;  ///< In one set of them: what is nearly hidden may cost no more.

    double allowed(double E) const { return relative * E + absolute; }
};

/// Of single points of a solution that is off by `error` (relative): as good as nothing is added to that.
constexpr LightAccuracy point_accuracy(double error) {
    constexpr double part = 0.1, least = 2e-4, most = 2.5e-3;
    return {.relative = std::clamp(part * error, least, most)};
}

/// Direct light where many emitters shine that are small beside it: thousands of triangles of a curved lamp, a sky.
/// Exact visible parts of all of them would cost more than they are worth there.
///
///     E ~ sum over strong sources of  M F(visible part)
///       + sum over clusters c of  L_c v_c,     v_c the part of the rays that get through to c
///
/// L_c is what cluster c brings if nothing stands in between: of its mean place and normal where it is far, exact of
/// single sources. Rays are dealt out evenly over the running sum of the L_c in the order of the tree, one a stratum,
/// so that neighbours tell of the noise; a second set follows, as large as the first one's noise asks for. Their places
/// follow from the point alone: the same point has the same light, whoever asks. A source of more than an eighth of the
/// light is strong. Clusters are as large as half of the error allowed lets them be. Source: [Walter05] for the cut.
///
/// Where emitters are few this is DirectLight, to the last bit: clusters are used where their cost, that of the cut and
/// of as many rays as the accuracy asks for, is below that of visible parts of as many sources as matter.
class ClusteredLight {
  public:
    /// Both must outlive it.
    ClusteredLight(const DirectLight& direct, const RayTracer& tracer);

    class Workspace;
    struct Estimate {
        Spectrum irradiance;   ///< W/m^2
        double variance = 0;   ///< Of its mean over bands, by rays and clusters, (W/m^2)^2; 0: exact.
        std::size_t rays = 0;  ///< That it took.
    };

    /// Does it pay at this point? Never with `few` sources or less, nor where any emits by a
    /// profile: then nothing is done to find out.
    bool pays(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room) const;
    bool is_possible() const { return possible_ && tree_.sources().size() > few; }

    /// Light of all emitters, and of lights without extent (exact), at x on region `own` (none: in free space), by
    /// clusters.
    Estimate by_clusters(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                         Workspace& room) const;

    /// By clusters where that pays, else exact.
    Estimate at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room) const;

    const EmitterTree& tree() const { return tree_; }

    static constexpr std::size_t few = 64;  ///< Sources that are always looked at one by one.

  private:
    Receiver receiver(const Point& x, const Normal& n, RegionId own) const;
    double look_closely(const Receiver& at, Workspace& room, Spectrum& exact) const;
    double cast(const Receiver& at, double light, unsigned rays, std::uint64_t key, Workspace& room,
                Spectrum& sum) const;

    const DirectLight* direct_;
    const RayTracer* tracer_;
    EmitterTree tree_;
    bool possible_ = true;  ///< No source emits by a profile.
};

/// Room to work in; one a thread.
class ClusteredLight::Workspace {
  public:
    DirectLight::Workspace exact;

  private:
    friend ClusteredLight;
    EmitterTree::Cut cut_;
    std::vector<double> light_before_;  ///< Of terms that are left to rays: the sum of those before, and of all.
    std::vector<SurfacePoint> from_, to_;
    std::vector<std::uint32_t> term_;  ///< Of each ray.
    std::unique_ptr<bool[]> blocked_ = std::make_unique<bool[]>(LightAccuracy().most_rays);
};

}  // namespace exitance
