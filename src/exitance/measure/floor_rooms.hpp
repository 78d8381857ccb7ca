#pragma once

#include "exitance/measure/floor_cells.hpp"

namespace exitance {

/// A room of a building: a part of a floor that walls enclose.
struct FloorRoom {
    std::string name;          ///< Name, from the name of its floor's faces; empty: none.
    double area = 0;           ///< Area of its floor, m^2.
    double height = 0;         ///< Free height, metres.
    MeasuringPlane rectangle;  ///< Bounding rectangle of its floor.
    std::size_t storey = 0;    ///< Index of the floor.
    std::uint32_t part = 0;    ///< Part of that floor.
};

/// The rooms of a building, found from its floors and walls; those of the largest floor come first. Error estimates use
/// other rooms, which are the parts of a scene between which little light passes (`LightRooms`). A floor is a group of
/// touching faces that point up, of at least 1 m^2 (in small models: a tenth of the largest). Five kinds of faces are
/// no floors: those of spaces too low to stand in; those too narrow for people, such as treads; furniture, which is
/// less than the height of a person above a floor; the tops of higher bodies, which nothing bounds (`is_top_of_body`);
/// and, if some floors have ceilings, those without, which are roofs and the ground outside.
class FloorRooms {
  public:
    FloorRooms() = default;  ///< No rooms.
    /// The tracer must outlive the object.
    FloorRooms(const Scene& scene, const RayTracer& tracer);

    std::size_t count() const { return rooms_.size(); }
    const FloorRoom& operator[](std::size_t room) const { return rooms_[room]; }
    const Floor& floor(std::size_t room) const { return storeys_[rooms_[room].storey].floor(); }
    /// "room 2 (kitchen)", or "room 2" if it has no name.
    std::string label(std::size_t room) const;
    /// True if a point of the room's floor is at least `border` metres from its walls.
    bool holds(std::size_t room, const Point& on_floor, double border) const {
        return storeys_[rooms_[room].storey].holds(rooms_[room].part, on_floor, border);
    }
    /// Index of the room that contains a point, on its floor or above it; count() if none does.
    std::size_t at(const Point& p) const;

  private:
    void find_rooms(const Scene& scene, const RayTracer& tracer);
    void leave_out_roofs();
    void leave_out_furniture(const Scene& scene, const RayTracer& tracer);
    bool is_body_in(const std::vector<FloorRoom>& lower, const FloorRoom& room, const Scene& scene,
                    const RayTracer& tracer) const;
    /// True if a point is straight above a room's floor, or above a hole in it.
    bool is_above(const Point& p, const FloorRoom& room) const;
    double level(const FloorRoom& room) const { return storeys_[room.storey].floor().shapes[0].loops[0][0].z; }
    void name_rooms(const Scene& scene);

    std::vector<FloorCells> storeys_;
    std::vector<FloorRoom> rooms_;
};

}  // namespace exitance
