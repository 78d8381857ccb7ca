#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "exitance/direct/beams.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// False if no pane mirrors anything or nothing emits.
bool panes_may_mirror_light(const Scene& scene);

/// Light of emitters, sky, sun and lights without extent that one pane mirrors onto a place. Direct light excludes it
/// everywhere. Light that surfaces have reflected is followed through mirrors by all rays and is not part of it.
///
///     E_m(x) = integral of R L cos dw over the directions in which a pane is seen,
///
/// where R is the pane's share of mirrored light (Fresnel) and L the radiance in the mirrored direction. Skies are
/// sampled by rays of density cos / pi, which `RayTracer` mirrors with probability R; emitters, sun and lights without
/// extent by their mirror images in panes, the latter two in up to `max_images`. Unbiased, except for light that panes
/// mirror twice.
class MirroredLight {
  public:
    /// Both must outlive it.
    MirroredLight(const Scene& scene, const RayTracer& tracer);

    /// Two independent estimates of E_m, mean over bands, W/m^2, by `rays` rays each. `key` selects the random numbers.
    std::array<double, 2> at(const Receiver& place, std::uint32_t rays, std::uint64_t key) const;

  private:
    double by_rays(const Receiver& place, std::uint32_t rays, std::uint64_t key) const;
    double by_emitters(const Receiver& place, std::uint64_t key) const;
    double by_emitter(const Receiver& place, const Piece& piece, const Point& on, const Pane& pane) const;
    double by_images(const Receiver& place, std::uint64_t key) const;
    Spectrum by_image(const Receiver& place, std::size_t light, const Pane& pane) const;
    bool is_open(const Receiver& from, const Point& mirror, const Vec3& onwards, const SurfacePoint& end) const;

    /// Limit on mirror images per place; of more, this many are chosen at random.
    static constexpr std::size_t max_images = 64;

    const Scene& scene_;
    const RayTracer& tracer_;
    std::vector<Piece> emitters_;
    std::vector<double> power_up_to_;  ///< Running sum of the emitters' power, W.
};

/// Light that panes mirror onto the surfaces of a solution, relative to the light that arrives there: RMS over the
/// surfaces of E_m / max(E, a tenth of the room's mean E), in the room (LightRooms) where it is largest.
struct MirroredShare {
    double share = 0;      ///< Estimate.
    double certainly = 0;  ///< Estimate less two standard errors.
};

/// Measures the share at 4096 places, about equally many in every room, by 64 rays each. E is that of
/// `solution.interpolant`. 0 if no pane mirrors light. Deterministic by `seed`, on any number of threads.
MirroredShare mirrored_share(const Solution& solution, const Stage& stage, std::uint64_t seed);

/// Number of points at which the share of mirrored light exceeds a limit.
struct MirroredAtPoints {
    std::size_t points = 0;  ///< Number of examined points.
    std::size_t above = 0;   ///< Number of points above the limit.
    double largest = 0;      ///< Largest share of these, E_m / (E + E_m).
};

/// Examines up to 64 of the points, at even steps, by 2 x 512 rays each. `light`: E at the points, without mirrored
/// light. A share counts if both of two independent estimates exceed the limit. Deterministic by `seed`.
MirroredAtPoints mirrored_at_points(const Scene& scene, std::span<const ProbePoint> points,
                                    std::span<const Spectrum> light, double limit, std::uint64_t seed);

}  // namespace exitance
