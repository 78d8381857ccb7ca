#pragma once

#include <vector>

#include "exitance/scene/locator.hpp"

namespace exitance {

/// The point at which the light of a measuring point is evaluated.
struct MeasuredPlace {
    Point x;            ///< Metres; at a distance from all walls and panes that touch the measuring point.
    SurfaceId surface;  ///< The face of the point; none in free space.
    RegionId region;    ///< The region of `surface`.
    /// True if the light differs between several sides, and the request does not say which one to use.
    bool is_between_sides = false;
};

/// Resolves the position of measuring points. Light is discontinuous at a point on the line of a wall; its value there
/// is the limit from one side:
///
/// - On a face that ends at the wall: the limit from inside the face.
/// - If the face or the measuring plane continues beyond the wall: the limit from the wall's front. Both sides of a
/// sheet or a pane are fronts.
/// - In a measuring plane parallel to the wall: the limit from the side to which the normal points.
///
/// If this leaves several sides, `is_between_sides` is set. The point's own position decides if it is off the wall by
/// more than rounding; otherwise the side of the face's centroid is used. The flag is also set if a wall ends at the
/// point or bends away from it, since the limit then depends on the direction of approach.
///
/// The result is the point moved by `step()` to that side, within its plane. A point that is at least as far from every
/// wall is not moved. The step is proportional to the scene's radius, so that rotating, translating or scaling the
/// scene gives the same result. The scene must outlive the finder. O(log faces) per query.
class PlaceFinder {
  public:
    explicit PlaceFinder(const Scene& scene);

    /// p        metres
    /// n        unit normal of the measuring plane
    /// towards  a point on the side to use if several are left (null: the centroid of the face, or of the scene)
    /// Thread-safe.
    MeasuredPlace find(const Point& p, const Normal& n, const Point* towards = nullptr) const;

    /// Returns the least distance of a result from walls, metres: about ten rounding errors of the single precision
    /// coordinates of rays.
    double step() const { return step_; }

  private:
    struct Wall;
    struct Blade;
    struct Sector;

    bool touches(const Wall& wall, const Point& p) const;
    bool rises_above(const Wall& wall, const Point& p, const Normal& n) const;
    template <class Visit>
    void visit_walls(const Point& p, const Visit& visit) const;
    std::vector<Blade> blades_at(const Point& p, const Normal& n, RegionId own) const;
    std::vector<Sector> sectors_at(const Point& p, const Normal& n, const std::vector<Blade>& blades) const;
    Sector make_sector(const Point& p, const Normal& n, std::span<const Blade> start, std::span<const Blade> end,
                       double angle) const;
    Point lifted_off_walls(const Point& p, const Normal& n) const;
    Point middle(SurfaceId surface) const;

    const Scene* scene_;
    Locator locator_;
    Point centroid_;  ///< Area-weighted centroid of the surfaces.
    double step_ = 0;
    Bvh tree_;  ///< Faces, then panes.
};

}  // namespace exitance
