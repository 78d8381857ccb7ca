#pragma once

#include <vector>

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// A punctual light that may illuminate one convex part of a surface, and its possible blockers.
struct Beam {
    std::uint32_t light = 0;
    /// Range of the beam's blockers in the list of candidates; empty if it is unoccluded.
    std::uint32_t first = 0, count = 0;
};

/// Direct light of point lights, spotlights and parallel light, exact at every point:
///
///     E = I(w) cos / r^2 V,  of parallel light  E_0 cos V,
///
/// V is decided in double precision by the convex pieces. A piece blocks the segment to the light if the segment's ends
/// are on different sides of its plane, by more than rounding, and the segment passes inside its outline (a shared edge
/// of two pieces lets no light through). The receiver's own region, and pieces in its plane or at the light's position,
/// never block.
class Beams {
  public:
    /// `lights` and `occluders` must outlive this object.
    Beams(const std::vector<PunctualLight>& lights, const Occluders& occluders)
        : lights_(&lights), occluders_(&occluders) {}

    bool empty() const { return lights_->empty(); }

    /// Returns the irradiance at a point, W/m^2. If `parallel` is given, adds to it the part of this irradiance that is
    /// due to parallel light. O(log pieces) per light.
    Spectrum irradiance(const SurfacePoint& at, Spectrum* parallel = nullptr) const;

    /// Appends to `out` the lights that may illuminate a convex polygon (metres, counter-clockwise about n) of region
    /// `own`, and to `candidates` the pieces that may block them. Omits lights that a single piece hides from the whole
    /// polygon.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::vector<Beam>& out,
                 std::vector<PieceId>& candidates) const;
    /// Like prepare() above, for a part of a prepared polygon.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::span<const Beam> whole,
                 std::span<const PieceId> whole_candidates, std::vector<Beam>& out,
                 std::vector<PieceId>& candidates) const;

    /// Like irradiance() above, for a point of a prepared polygon: tests only the polygon's `beams` and `candidates`.
    Spectrum irradiance(const SurfacePoint& at, std::span<const Beam> beams, std::span<const PieceId> candidates,
                        Spectrum* parallel = nullptr) const;

  private:
    /// Unoccluded light at a receiver, and the point from which the light comes.
    struct Arrival {
        Spectrum E;
        Point from;
    };
    Arrival arrival(const PunctualLight& light, const SurfacePoint& at) const;
    bool is_blocked(const SurfacePoint& at, const Point& from) const;
    bool blocks(PieceId piece, const SurfacePoint& at, const Point& from) const;
    Vec3 far_away(const PunctualLight& light, const Point& x) const;

    template <class EachPiece>
    void prepare_light(std::uint32_t light, std::span<const Point> receiver, const Normal& n, RegionId own,
                       const EachPiece& each_piece, std::vector<Beam>& out, std::vector<PieceId>& candidates) const;

    const std::vector<PunctualLight>* lights_;
    const Occluders* occluders_;
};

}  // namespace exitance
