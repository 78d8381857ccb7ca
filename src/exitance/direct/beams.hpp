#pragma once

#include <vector>

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Light of sources without extent on one convex part of a surface: which of them can shine there, past what.
struct Beam {
    std::uint32_t light = 0;
    std::uint32_t first = 0, count = 0;  ///< Of the candidates; none: nothing stands between.
};

/// Direct light of points, spots and parallel light, exact at every point:
///
///     E = I(w) cos / r^2 V,  of parallel light  E_0 cos V,
///
/// V decided in double precision against the convex pieces: a piece blocks the segment to the light if its ends lie on
/// either side of its plane, by more than rounding, and it passes inside (an edge that two pieces share lets nothing
/// through). The receiver's own region, and what lies in its plane or in the light's place, never blocks.
class Beams {
  public:
    /// Both must outlive it.
    Beams(const std::vector<PunctualLight>& lights, const Occluders& occluders)
        : lights_(&lights), occluders_(&occluders) {}

    bool empty() const { return lights_->empty(); }

    /// Irradiance at a point, W/m^2; O(log pieces) a light. Adds what comes from parallel light to `parallel`, if
    /// given.
    Spectrum irradiance(const Receiver& at, Spectrum* parallel = nullptr) const;

    /// Lights that may shine on a convex polygon (metres, counter-clockwise about n) of region `own`, and the pieces
    /// that reach between, appended to `out` and `candidates`. A light that one piece hides from all of it is left out.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::vector<Beam>& out,
                 std::vector<PieceId>& candidates) const;
    /// The same for a part of a polygon that was looked at.
    void prepare(std::span<const Point> receiver, const Normal& n, RegionId own, std::span<const Beam> whole,
                 std::span<const PieceId> whole_candidates, std::vector<Beam>& out,
                 std::vector<PieceId>& candidates) const;

    /// Irradiance at a point of a polygon that was looked at: as above.
    Spectrum irradiance(const Receiver& at, std::span<const Beam> beams, std::span<const PieceId> candidates,
                        Spectrum* parallel = nullptr) const;

  private:
    /// Light at a receiver if nothing stands between, and where it comes from.
    struct Arrival {
        Spectrum E;
        Point from;
    };
    Arrival arrival(const PunctualLight& light, const Receiver& at) const;
    bool is_blocked(const Receiver& at, const Point& from) const;
    bool blocks(PieceId piece, const Receiver& at, const Point& from) const;
    Vec3 far_away(const PunctualLight& light, const Point& x) const;

    template <class EachPiece>
    void prepare_light(std::uint32_t light, std::span<const Point> receiver, const Normal& n, RegionId own,
                       const EachPiece& each_piece, std::vector<Beam>& out, std::vector<PieceId>& candidates) const;

    const std::vector<PunctualLight>* lights_;
    const Occluders* occluders_;
};

}  // namespace exitance
