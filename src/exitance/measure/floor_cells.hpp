#pragma once

#include <cstdint>
#include <vector>

#include "exitance/measure/floor_shapes.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Square cells over a floor, grouped into parts that walls separate. A wall is geometry that blocks the way between
/// two cells at all heights from above a door up to the ceiling. Hence furniture and partitions that end below the
/// ceiling do not separate parts, nor do beams and lamps; the wall above a door does.
class FloorCells {
  public:
    static constexpr std::uint32_t none = ~0u;

    /// A part of the floor that walls or the floor's outline enclose.
    struct Part {
        std::size_t cells = 0;
        double area = 0;     ///< m^2
        double breadth = 0;  ///< Side of the largest square of its cells, metres.
        /// Free height above the floor that a quarter of the cells exceed, metres. Below the open sky it reaches to
        /// `top`.
        double height = 0;
        bool is_inside_body = false;  ///< True if the back of a face is above more than half of the cells.
        bool has_ceiling = false;     ///< True if something is above at least half of the cells.
    };

    /// A place on the outline of a part: the centre of a cell at its edge, and that of the neighbouring cell outside.
    struct Edge {
        Point inner, outer;
        bool has_wall = false;
    };

    /// `top`: highest point of the scene, metres. The tracer must outlive the object. Casts about ten rays per cell;
    /// cells are 0.1 m wide, or wider if there would be more than 40,000.
    FloorCells(Floor floor, double top, const RayTracer& tracer);

    const Floor& floor() const { return floor_; }
    const std::vector<Part>& parts() const { return parts_; }
    std::size_t size() const { return part_.size(); }
    /// Part to which a cell belongs; `none` outside the floor.
    std::uint32_t part(std::size_t cell) const { return part_[cell]; }
    Point centre(std::size_t cell) const;

    /// True if a point of the floor's plane is in a part, by at least `border` metres from its walls and outline.
    bool holds(std::uint32_t part, const Point& p, double border) const;
    /// All edges of a part's cells, in the order of cells.
    std::vector<Edge> edges(std::uint32_t part) const;
    double cell_size() const { return width_; }  ///< Metres.
    /// Bounding rectangle of a part along the sides of the floor's rectangle, exact to 1e-6 of the scene's size.
    MeasuringPlane rectangle(std::uint32_t part) const;

  private:
    void measure_heights(double top);
    void join_cells();
    void find_parts();
    bool is_wall_between(const Point& p, const Point& q, double height) const;
    bool are_linked(std::size_t a, std::size_t b) const;
    /// Cell of a part from which a point can be reached; size() if there is none.
    std::size_t cell_of(std::uint32_t part, const Point& p) const;
    double reach(std::size_t cell, const Vec3& way) const;

    Floor floor_;
    const RayTracer* tracer_;
    MeasuringPlane frame_;
    Vec3 u_, v_;
    double width_ = 0;  ///< Width of a cell, metres.
    std::size_t columns_ = 0, rows_ = 0;
    std::vector<double> free_;  ///< Height of the first hit above each cell, metres; `top` if nothing is hit.
    /// Equal to free_, except below furniture, where it is the height of a neighbouring cell.
    std::vector<double> height_;
    std::vector<std::uint8_t> is_open_;    ///< True if nothing is above.
    std::vector<std::uint8_t> is_inside_;  ///< True if the back of a face is above.
    std::vector<std::uint32_t> part_;
    std::vector<Part> parts_;
};

}  // namespace exitance
