#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "exitance/direct/beams.hpp"
#include "exitance/direct/light_accuracy.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/visibility/glass/glass_colours.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// False if no pane mirrors anything or nothing emits.
bool panes_may_mirror_light(const Scene& scene);

/// Light of emitters, sky, sun and lights without extent that one pane mirrors onto a place: a part of direct light.
///
///     E_m(x) = integral of R L cos dw over the directions in which a pane is seen,
///
/// where R is the pane's share of mirrored light (Fresnel) and L the radiance in the mirrored direction. Skies are
/// sampled by points of panes (SeenPolygon), emitters by the mirror images of their points, sun and lights without
/// extent by their mirror images in all panes (in 64 chosen at random, if there are more). Other panes let
/// rays pass at random. Unbiased, except for light that panes mirror twice, which is left out.
class MirroredLight {
  public:
    /// Both arguments must outlive this object.
    MirroredLight(const Scene& scene, const RayTracer& tracer);

    struct Estimate {
        Spectrum irradiance = {};  ///< E_m, W/m^2
        Spectrum parallel = {};    ///< The part of `irradiance` from sky, sun and parallel lights.
        double variance = 0;       ///< Variance of the mean over bands, (W/m^2)^2.
        std::size_t rays = 0;      ///< Number of points that were tried.
    };
    /// Returns E_m with the accuracy required of it and the other light `E` at the place, W/m^2. `key` selects the
    /// random numbers. O(panes + rays).
    Estimate at(const SurfacePoint& place, double E, const LightAccuracy& accuracy, std::uint64_t key) const;

    /// Returns the part of E_m from sun and lights without extent: from all mirror images, or from `most` of them
    /// chosen at random.
    Estimate images(const SurfacePoint& place, std::size_t most, std::uint64_t key) const;

  private:
    class Panes;
    struct Sums;
    /// A sample of E_m, W/m^2.
    struct Sample {
        Spectrum light;
        double open = 0;  ///< Its light if nothing were in the way and the pane were unbounded; mean over bands.
    };
    Sample by_sky(const SurfacePoint& place, Panes& panes, double s, double t, double choice) const;
    Sample by_emitters(const SurfacePoint& place, const Panes& panes, const std::array<double, 4>& random) const;
    Sample by_emitter(const SurfacePoint& place, const Piece& piece, const Point& on, const Pane& pane) const;
    Spectrum by_image(const SurfacePoint& place, std::size_t light, const Pane& pane) const;
    Spectrum passing(const SurfacePoint& from, const Point& mirror, const Vec3& onwards, const RayEnd& end) const;

    const Scene& scene_;
    const RayTracer& tracer_;
    GlassColours glass_;
    std::vector<Piece> emitters_;
    std::vector<double> power_up_to_;  ///< Running sum of the emitters' power, W.
    std::vector<double> pane_area_;    ///< m^2
};

}  // namespace exitance
