#pragma once

#include <vector>

#include "exitance/scene/locator.hpp"

namespace exitance {

/// Where the light of a measuring point is evaluated.
struct MeasuredPlace {
    Point x;                        ///< Metres; off all walls and panes that the measuring point lies on.
    SurfaceId surface;              ///< The face that it lies on; none in free space.
    RegionId region;                ///< That of the face.
    bool is_between_sides = false;  ///< Is the light there that of one of several sides, any of which could be meant?
};

/// Finds out where measuring points lie. Light jumps at a point on the line of a wall, and the value there is the limit
/// from one side:
///
/// - On a face that ends at the wall, the limit from inside the face.
/// - Where the face or the measuring plane goes on beyond the wall, the limit from before the wall's front. Both sides
///   of a sheet or a pane are fronts.
/// - In a plane of measuring that is parallel to the wall, the limit from the side that the normal points to.
///
/// Where this leaves several sides, `is_between_sides` is set. The point's own position decides if it is off the wall
/// by more than rounding, else the side where the face's centroid lies. The flag is set as well where a wall ends at
/// the point or bends away from it, since the limit then depends on the direction of approach.
///
/// The returned place is the point moved by `step()` into that side, within its plane. A place that is at least as far
/// from every wall stays where it is. The step is a share of the scene's radius, so that a scene that is turned, moved
/// or scaled gives the same places. The scene must outlive the finder. O(log faces) a query.
class PlaceFinder {
  public:
    explicit PlaceFinder(const Scene& scene);

    /// `p`: metres; `n`: the normal of the measuring plane, of length 1. `towards`: a point on the side to take where
    /// several are left (null: the face's centroid, or the scene's). Safe to call from any thread.
    MeasuredPlace find(const Point& p, const Normal& n, const Point* towards = nullptr) const;

    /// How far from a wall a place lies at least, metres: about ten roundings of coordinates in the single precision of
    /// rays.
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
    Point centroid_;  ///< Of the surfaces' area.
    double step_ = 0;
    Bvh tree_;  ///< Faces, then panes.
};

}  // namespace exitance
