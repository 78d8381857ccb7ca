#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "exitance/direct/clustered_light.hpp"

namespace exitance {

/// Light of many partly hidden sources at neighbouring points of one plane, such as the points shown by a tile of an
/// image. The points share the ends of their rays:
///
///     E = L sum over rays of  w_i V_i / sum over rays of  w_i,    w = M K / p,    K = cos cos / (pi r^2),
///
/// L is the exact unoccluded light of these sources, and p the density of the rays' ends. The ends are chosen once for
/// all points: 16 sets, of which every point uses one, and more if the spread of its rays requires it. A source gets
/// ends in proportion to its unoccluded light at the points, so that rays go where light may come from. Sources known
/// to be hidden from, or fully visible to, a part of the points are skipped there. Neighbouring points that use
/// different sets have independent noise. One object per thread.
class SharedRays {
  public:
    /// `direct` and `tracer` must outlive it.
    SharedRays(const DirectLight& direct, const RayTracer& tracer);

    /// True if rays can be used in this scene: not with panes, sky, or emitters with a directional profile.
    bool is_possible() const { return possible_; }

    /// Starts with the receiver for which `whole` was prepared.
    /// places  points of the receiver, used to distribute the ends
    /// seed    determines the ends
    void choose(const ReceiverLight& whole, std::span<const Point> places, std::uint64_t seed);

    /// The sources of a part of that receiver.
    struct Part {
        ReceiverLight exact;  ///< Sources computed exactly: fully visible or strong ones, and punctual lights.
        QuadBatch shadowed;   ///< The partly hidden others,
        std::vector<Spectrum> exitance;     ///< their exitances,
        std::vector<std::uint8_t> is_here;  ///< and, for each source of `choose`, whether it belongs to this part.
    };
    /// Moves the partly hidden sources of `light` (prepared for a part of `whole`) to rays if that is cheaper, measured
    /// at `middle`. Otherwise returns false, and `part` is invalid.
    bool share(const ReceiverLight& light, const Point& middle, const LightAccuracy& accuracy, Part& part,
               DirectLight::Workspace& scratch);

    /// Returns the light at a point of the part. `set` is the first set of ends to use, less than `sets`.
    ClusteredLight::Estimate at(const Part& part, const Point& x, std::uint32_t set, const LightAccuracy& accuracy,
                                DirectLight::Workspace& scratch);

    static constexpr std::uint32_t sets = 16, rays_a_set = 128;

  private:
    struct Source {
        DirectLight::SourceName name;
        RegionId region;
        double area = 0;         ///< m^2
        double probability = 0;  ///< Probability that a ray ends on it.
    };
    struct End {
        Point at;
        std::uint32_t source = 0;
    };
    /// Sums over the rays so far, by weight.
    struct Sums {
        Spectrum sent, arrived;
        double squares = 0;  ///< Variance of the band mean of `arrived`.
        std::size_t rays = 0;
    };
    std::span<const End> set(std::uint32_t number);
    double gather(const ReceiverLight& light, const Receiver& at, double most, Part& part);
    void cast(const Part& part, const Receiver& at, std::uint32_t number, Sums& sums);

    const DirectLight* direct_;
    const RayTracer* tracer_;
    bool possible_ = true;
    std::uint64_t seed_ = 0;
    std::vector<Source> sources_;
    std::vector<double> before_;               ///< Prefix sums of their probabilities.
    std::vector<std::uint32_t> number_;        ///< For each piece, the index of its source plus one; 0: none.
    std::array<std::vector<End>, sets> ends_;  ///< Each sorted by source; empty: not yet generated.
    std::vector<SurfacePoint> from_, to_;
    std::vector<Spectrum> weight_;
    std::vector<double> factors_;
    std::unique_ptr<bool[]> blocked_ = std::make_unique<bool[]>(rays_a_set);
};

}  // namespace exitance
