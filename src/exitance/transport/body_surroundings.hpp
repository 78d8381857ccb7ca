#pragma once

#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/transport/room_finder.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// The surroundings of bodies outdoors: balls of twice the radius of each body. On a ground that is far larger, an
/// error of the light beside a building hardly counts among all surfaces, although it is there that people look at it.
/// These surroundings are therefore judged as a room of their own (`LightRooms`).
class BodySurroundings {
  public:
    /// Finds the bodies that see the sky, if the scene consists mostly of large bodies, such as a ground. Considers the
    /// 64 largest of the small bodies, without those inside the surroundings of larger ones. Empty if their
    /// surroundings together are a large part of the scene. O(n log n) in faces.
    explicit BodySurroundings(const Stage& stage);

    bool are_empty() const { return balls_.empty(); }
    /// True if a point is in the surroundings of a body. O(log bodies).
    bool contain(const Point& x) const;
    /// The first face of every body, the largest body first.
    const std::vector<SurfaceId>& bodies() const { return bodies_; }

    /// Splits elements until they are small beside each body that they surround. Ends early if a stop is requested.
    /// O(log bodies) per element.
    void refine(ElementTree& tree, const StopRequest* stop) const;

    /// The room of every leaf, and the number of rooms. Rooms of surroundings have the largest numbers.
    struct Division {
        std::vector<std::size_t> room_of;
        std::size_t rooms = 0;
    };
    /// Divides every room below the sky in two, if the surroundings are at most a quarter of it: these and the
    /// bodies become a room of their own. `room_of`: room of every leaf. O(log bodies) per leaf.
    Division divide(std::span<const std::size_t> room_of, std::size_t rooms, const CoarseElements& in) const;

  private:
    struct Ball {
        Point centre;
        double radius;  ///< Metres; twice that of the body.
    };
    static bool holds(const Ball& ball, const Point& x);

    std::vector<Ball> balls_;
    std::vector<SurfaceId> bodies_;
    Bvh tree_;  ///< Boxes of the balls.
};

}  // namespace exitance
