#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "exitance/direct/emitter_tree.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Allowed RMS error of light at a point: relative * E + absolute.
struct LightAccuracy {
    double relative = 0;
    double absolute = 0;           ///< W/m^2, mean over bands.
    unsigned most_rays = 1 << 13;  ///< Per set of rays; limits the cost of nearly hidden sources.

    double allowed(double E) const { return relative * E + absolute; }
};

/// Accuracy for single points of a solution with the relative error `error`: adds almost nothing to that error.
constexpr LightAccuracy point_accuracy(double error) {
    constexpr double part = 0.1, least = 2e-4, most = 2.5e-3;
    return {.relative = std::clamp(part * error, least, most)};
}

/// Direct light of scenes with very many small emitters, such as thousands of triangles of a curved lamp. Computing all
/// of their visible parts exactly would be too expensive.
///
///     E ~ sum over strong sources of  M F(visible part)
///       + sum over clusters c of  L_c v_c,     v_c the part of the rays that get through to c
///
/// L_c is the unoccluded light of cluster c: computed from its mean position and normal if it is far away, exact for
/// single sources. Rays are stratified over the running sum of the L_c in the order of the tree; the difference of
/// neighbouring rays estimates the noise. A second set of rays follows, with its size chosen by the noise of the first.
/// The random points depend only on the coordinates of the point, so that repeated calls give the same light. A source
/// with more than an eighth of the light is strong. Clusters are as large as half of the allowed error permits. Source:
/// [Walter05] for the cut.
///
/// With few emitters this is DirectLight, bit for bit. Clusters are used if their cost (the cut and the rays needed for
/// the accuracy) is below that of exact visible parts of the effective number of sources.
class ClusteredLight {
  public:
    /// `direct` and `tracer` must outlive it.
    ClusteredLight(const DirectLight& direct, const RayTracer& tracer);

    class Workspace;
    struct Estimate {
        Spectrum irradiance;   ///< W/m^2
        double variance = 0;   ///< Variance of the mean over bands, by rays and clusters, (W/m^2)^2; 0: exact.
        std::size_t rays = 0;  ///< Number of rays used.
    };

    /// True if clusters are cheaper than exact light at this point. Always false with at most `few` sources, or if an
    /// emitter has a directional profile; then nothing is computed.
    bool pays(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room) const;
    bool is_possible() const { return possible_ && tree_.sources().size() > few; }

    /// Returns the light of all emitters by clusters, and of punctual lights exactly, at x on region `own` (none: in
    /// free space).
    Estimate by_clusters(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                         Workspace& room) const;

    /// Uses clusters if they are cheaper, else exact light.
    Estimate at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room) const;

    const EmitterTree& tree() const { return tree_; }

    static constexpr std::size_t few = 64;  ///< Up to this many sources, all are computed exactly.

  private:
    Receiver receiver(const Point& x, const Normal& n, RegionId own) const;
    double look_closely(const Receiver& at, Workspace& room, Spectrum& exact) const;
    double cast(const Receiver& at, double light, unsigned rays, std::uint64_t key, Workspace& room,
                Spectrum& sum) const;

    const DirectLight* direct_;
    const RayTracer* tracer_;
    EmitterTree tree_;
    /// Clusters are valid in this scene: no emitter has a directional profile, no sky, no panes, and enough sources.
    bool possible_ = true;
};

/// Temporary storage; one per thread.
class ClusteredLight::Workspace {
  public:
    DirectLight::Workspace exact;

  private:
    friend ClusteredLight;
    EmitterTree::Cut cut_;
    /// Prefix sums of the light of the terms left to rays; one entry more than there are terms.
    std::vector<double> light_before_;
    std::vector<SurfacePoint> from_, to_;
    std::vector<std::uint32_t> term_;  ///< Index of the term of each ray.
    std::unique_ptr<bool[]> blocked_ = std::make_unique<bool[]>(LightAccuracy().most_rays);
};

}  // namespace exitance
