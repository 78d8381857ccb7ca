#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "exitance/direct/clustered_light.hpp"

namespace exitance {

/// Light of the many sources that something stands before, at neighbouring places of one plane, such as those that a
/// tile of a picture shows:
///
///     E = L sum over rays of  w_i V_i / sum over rays of  w_i,    w = M K / p,    K = cos cos / (pi r^2),
///
/// L what these sources bring if nothing stands in between, exact, p the density of the rays' ends. Ends are chosen
/// once for all places: sixteen sets of them, of which every place takes one, and more as far as the spread of
/// neighbouring rays asks for. A source is given ends by the light it would bring to places about, so that rays go
/// where light may come from; what is known of a part of the places (sources that are hidden from there, or in full
/// view) leaves ends out. Neighbours that take different sets have noise of their own. One object serves one thread.
class SharedRays {
  public:
    /// Both must outlive it.
    SharedRays(const DirectLight& direct, const RayTracer& tracer);

    /// Can any of it be done by rays in this scene? Not through panes, nor of the sky or of emitters with a profile.
    bool is_possible() const { return possible_; }

    /// Begins with the receiver that `whole` was made for; `places` are some of it, `seed` names the ends.
    void choose(const ReceiverLight& whole, std::span<const Point> places, std::uint64_t seed);

    /// What is known of a part of that receiver.
    struct Part {
        ReceiverLight exact;                ///< What is looked at exactly: sources in full view or strong, lights.
        QuadBatch shadowed;                 ///< The others,
        std::vector<Spectrum> exitance;     ///< their exitances,
        std::vector<std::uint8_t> is_here;  ///< and are they this part's, by their numbers in `choose`?
    };
    /// Takes the sources that something stands before from `light`, a part of `whole`, if rays find them for less
    /// (about `middle`); else returns false, and `part` is of no use.
    bool share(const ReceiverLight& light, const Point& middle, const LightAccuracy& accuracy, Part& part,
               DirectLight::Workspace& scratch);

    /// Light at a place of the part. `set`: the first set of ends that it takes, below `sets`.
    ClusteredLight::Estimate at(const Part& part, const Point& x, std::uint32_t set, const LightAccuracy& accuracy,
                                DirectLight::Workspace& scratch);

    static constexpr std::uint32_t sets = 16, rays_a_set = 128;

  private:
    struct Source {
        DirectLight::SourceName name;
        RegionId region;
        double area = 0;         ///< m^2
        double probability = 0;  ///< That an end is its.
    };
    struct End {
        Point at;
        std::uint32_t source = 0;
    };
    /// What rays have told so far, by weight.
    struct Sums {
        Spectrum sent, arrived;
        double squares = 0;  ///< Variance of the mean band of `arrived`.
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
    std::vector<double> before_;               ///< Sums of their probabilities.
    std::vector<std::uint32_t> number_;        ///< One past a source's number, by piece.
    std::array<std::vector<End>, sets> ends_;  ///< Each in the order of sources; empty: not yet made.
    std::vector<SurfacePoint> from_, to_;
    std::vector<Spectrum> weight_;
    std::vector<double> factors_;
    std::unique_ptr<bool[]> blocked_ = std::make_unique<bool[]>(rays_a_set);
};

}  // namespace exitance
