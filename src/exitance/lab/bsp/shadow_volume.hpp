#pragma once

#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// What one convex polygon hides of a convex source, as two convex volumes behind it: a chain of planes each, the
/// simplest SVBSP tree. A plane through an edge of one and a corner of the other that has both on different sides
/// bounds the penumbra (VE and EV planes); one through an edge of the occluder and a corner of the source that has both
/// on one side, the umbra (VE planes alone). Both end at the occluder's own plane. Source: [Chin89], [Gatenby95].
class ShadowVolume {
  public:
    /// How a receiver lies to a volume.
    enum class Place { outside, partly, inside };

    /// `source` and `occluder`: counter-clockwise about `normal` and in one plane each, metres. What is nearer to a
    /// plane than `thickness` lies in it. What of the occluder is behind the source's plane hides nothing and is cut
    /// off. A source that the occluder's plane passes through or touches has no umbra. O((|S| + |O|)^3).
    ShadowVolume(std::span<const Point> source, const Plane& source_plane, std::span<const Point> occluder,
                 const Plane& occluder_plane, double thickness);

    bool is_empty() const { return penumbra_.empty(); }  ///< It hides nothing, certainly.
    bool has_umbra() const { return !umbra_.empty(); }
    std::span<const Plane> penumbra() const { return penumbra_; }  ///< Inside is in front of all of them.
    std::span<const Plane> umbra() const { return umbra_; }

    /// Does a convex polygon or a point lie outside, partly within or within? A polygon may be called partly within
    /// that passes by a corner of the volume. `tests` counts looks at a plane.
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
