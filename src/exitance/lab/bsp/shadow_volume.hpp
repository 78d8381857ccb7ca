#pragma once

#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// The shadow of one convex polygon that is lit by a convex source, as two convex volumes behind the polygon. Each
/// volume is a list of planes, the simplest SVBSP tree. The penumbra is bounded by planes through an edge of one
/// polygon and a corner of the other that separate the two (VE and EV planes). The umbra is bounded by planes through
/// an edge of the occluder and a corner of the source that have both on one side (VE planes only). The occluder's plane
/// bounds both. Source: [Chin89], [Gatenby95].
class ShadowVolume {
  public:
    /// Position of a receiver relative to a volume.
    enum class Place { outside, partly, inside };

    /// source, occluder  planar polygons, counter-clockwise about the normals of their planes, metres. The part of the
    /// occluder behind the source's plane hides nothing and is cut off.
    /// thickness  metres: points nearer to a plane than this are in the plane
    /// There is no umbra if the occluder's plane crosses or touches the source. O((|S| + |O|)^3).
    ShadowVolume(std::span<const Point> source, const Plane& source_plane, std::span<const Point> occluder,
                 const Plane& occluder_plane, double thickness);

    bool is_empty() const { return penumbra_.empty(); }  ///< True if the occluder certainly hides nothing.
    bool has_umbra() const { return !umbra_.empty(); }
    std::span<const Plane> penumbra() const { return penumbra_; }  ///< The inside is in front of all planes.
    std::span<const Plane> umbra() const { return umbra_; }

    /// Classifies a convex polygon or a point as outside, partly inside or inside a volume. A polygon that passes a
    /// corner of the volume outside may be reported as `partly`. Adds the number of plane tests to `tests`.
    Place in_penumbra(std::span<const Point> receiver, std::size_t& tests) const;
    Place in_umbra(std::span<const Point> receiver, std::size_t& tests) const;

  private:
    Place place(std::span<const Plane> planes, std::span<const Point> receiver, std::size_t& tests) const;
    void add_once(const Plane& plane, std::vector<Plane>& planes) const;
    void add_planes(std::span<const Point> edges, std::span<const Point> corners, bool of_occluder);

    double thickness_;
    std::vector<Point> source_, occluder_;
    std::vector<Plane> penumbra_, umbra_;
};

}  // namespace exitance
