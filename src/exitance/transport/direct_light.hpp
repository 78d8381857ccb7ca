#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"
#include "exitance/transport/occluders.hpp"
#include "exitance/transport/visible_part.hpp"

namespace exitance {

/// The light that arrives straight from the emitters, exact at every point.
class DirectLight {
  public:
    using Workspace = VisibilityWorkspace;

    /// Both must outlive it.
    DirectLight(const Scene& scene, const Occluders& occluders);

    /// Irradiance (W/m^2) at x on a surface of normal n:
    ///
    ///     E = sum over emitters s of  M_s F(x, visible part of s)
    ///
    /// Exact but for rounding (1e-12 relative where F is not tiny). x is to lie on region `own` (a point off its plane
    /// by more than rounding can be shaded by that region's neighbours), or own is none. A point that another surface
    /// covers is for the caller to ask about (Occluders::is_covered). About 1-5 microseconds an emitter in view.
    Spectrum irradiance(const Point& x, const Normal& n, RegionId own, Workspace& scratch) const;

    /// An emitting region: its convex pieces, and a ball around it for quick rejection.
    struct Emitter {
        RegionId region;
        Spectrum exitance;  ///< W/m^2
        Plane plane;
        Point centre;
        double radius = 0;  ///< m
        IdRange<PieceId> pieces;
    };
    const std::vector<Emitter>& emitters() const { return emitters_; }
    const Occluders& occluders() const { return *occluders_; }

    /// Form factor from a receiver to the visible part of an emitter.
    double form_factor(const Receiver& at, const Emitter& emitter, Workspace& scratch) const;

  private:
    const Occluders* occluders_;
    std::vector<Emitter> emitters_;
};

}  // namespace exitance
