#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {

struct Stage;
struct LeafNumbering;
class RayRows;
class LightPortals;
class BodySurroundings;

/// A part of the scene is a room of its own if it has at least this share of all area, or of the area that is not
/// outdoors. Chosen by trial. With double, a small room joins the large one around it, which takes four times as many
/// rays; with half nothing changes: measured by `exitance solve keyhole.obj --error 0.02`.
inline constexpr double min_room_share = 0.05;

/// Largest `LightRooms::multiplicity`: that of 1,000 rooms, the most for which times and memory were measured.
inline constexpr double max_multiplicity = 50;

/// The rooms of a scene: parts of free space, separated at openings smaller than a tenth of their walls' area. Light
/// levels of rooms differ by orders of magnitude, so that errors are judged room by room; otherwise the light outdoors
/// would hide any error in a cellar. The rooms of a building, as users count them, are `FloorRooms`. A room with less
/// area than `min_room_share` (not counting ground or sky) is merged with a neighbour. Outdoors, bodies and the
/// ground around them are a room of their own if the rest is at least three times as large (`BodySurroundings`).
class LightRooms {
  public:
    /// Treats the whole scene as one room.
    LightRooms() = default;

    std::size_t count() const { return areas_.size(); }  ///< Number of rooms; 0 if the whole scene is one room.
    /// Area of a room without sides that no light reaches, unless there are no others; m^2.
    double area(std::size_t room) const { return areas_[room]; }
    /// Number of closed rooms, between which no light passes; counts also those that are too small to be judged on
    /// their own: (sum of areas)^2 / sum of squared areas, so that small ones beside large ones hardly count. At least
    /// 1. Rooms that doors or windows connect count as one.
    double spaces() const { return spaces_; }
    /// Factor on numbers of elements that are sufficient for one room. With up to 1 / `min_room_share` spaces it is 1:
    /// all of them can be rooms of their own, and are meshed finer if they are smaller than others.
    double multiplicity() const { return std::clamp(min_room_share * spaces_, 1.0, max_multiplicity); }
    /// Index of the room that contains a point of a region; rooms are sorted by descending area.
    std::size_t at(RegionId region, const Point& x) const;
    /// Room of an element's centre.
    std::size_t of(const ElementTree& tree, ElementId e) const;
    /// Share of the light leaving the surface at x that does not arrive at any front, estimated by few rays.
    double lost_share(RegionId region, const Point& x) const {
        return locator_ ? lost_[locator_->find(region, x).element] : 0;
    }
    /// Factor on the area of an element that gives all rooms equal total weight: the mean area of a lit room over the
    /// area of this one. The weighted areas of lit rooms sum to their area. 1 if the whole scene is one room.
    double weight(const ElementTree& tree, ElementId e) const;
    /// Like weight(), plus the weight that the element's light has in the other rooms that it illuminates: the ground
    /// outside a window counts by the room behind the window. It counts more if that room is darker.
    double importance(const ElementTree& tree, ElementId e) const;
    /// Smallest importance() of the elements of a piece.
    double importance_of_piece(std::size_t piece) const { return count() > 0 ? piece_importance_[piece] : 1; }

    /// Openings between rooms at which rays from the darker room are aimed; null if there are none.
    const LightPortals* portals() const { return portals_.get(); }
    /// Surroundings of bodies that are a room of their own; null if there are none.
    const BodySurroundings* surroundings() const { return surroundings_.get(); }
    /// True if a room consists of surroundings of bodies.
    bool is_surroundings(std::size_t room) const { return room < is_surroundings_.size() && is_surroundings_[room]; }

  private:
    void set(std::span<const std::size_t> room_of, std::size_t rooms, const Stage& stage, const ElementTree& tree,
             const LeafNumbering& numbering);
    void weigh(const ElementTree& tree, const LeafNumbering& numbering, const RayRows& rows,
               std::span<const double> light);

    friend LightRooms find_light_rooms(const Stage&, std::uint64_t, const StopRequest&);
    std::vector<double> areas_;
    double spaces_ = 1;
    double mean_area_ = 0;
    /// Locates leaves of a coarse mesh over all pieces; null if the scene is one room that loses no
    /// light, without bodies that have surroundings.
    std::shared_ptr<const ElementLocator> locator_;
    Field<ElementId, std::uint16_t> room_of_;  ///< Room of each leaf of that mesh.
    std::vector<double> piece_importance_;
    Field<ElementId, float> lost_, importance_;
    std::shared_ptr<const LightPortals> portals_;
    std::shared_ptr<const BodySurroundings> surroundings_;
    std::vector<std::uint8_t> is_surroundings_;  ///< Per room; empty if there are no surroundings.
};

/// Finds the rooms of a scene. Light exchanged between coarse elements becomes even within a room long before it does
/// between rooms, so that cuts are searched along the differences that decay slowest [Lovasz93]. A cut is accepted at
/// an opening narrower than a tenth of the smaller side's walls and than half of the openings of neighbouring cuts.
/// Casts some dozens of rays per element. Deterministic on any number of threads. O(elements x rays x log rooms).
LightRooms find_light_rooms(const Stage& stage, std::uint64_t seed, const StopRequest& stop);

}  // namespace exitance
