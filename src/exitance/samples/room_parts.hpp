#pragma once

#include "exitance/samples/mersenne_twister.hpp"
#include "exitance/samples/polygon_kit.hpp"

// Parts of generated rooms and buildings.

namespace exitance {

/// An opening in a rectangle, in the rectangle's coordinates.
struct WallOpening {
    double u0, v0, u1, v1;
};

/// Adds a rectangle p + u a + v b, u in [0, width] and v in [0, height], without the opening.
void add_around(PolygonKit& kit, const char* group, const char* material, const Point& p, const Vec3& a, const Vec3& b,
                double width, double height, const WallOpening& o, const Point& seen);

/// Adds the inside of a box: floor, ceiling and walls.
void add_room(PolygonKit& kit, const Point& lo, const Point& hi, const char* floor, const char* ceiling,
              const char* wall);

/// Adds materials for the parts of rooms, and `light` with this radiance, W/(m^2 sr).
void add_materials(PolygonKit& kit, double radiance);

/// Adds a lamp that faces down, with a housing above it.
void add_lamp(PolygonKit& kit, double x, double y, double z, double width, double length, double thickness);

/// Adds a triangle that reflects on both sides.
void add_sheet(PolygonKit& kit, const char* group, const char* material, const Point& a, const Point& b,
               const Point& c);

/// Adds a bar with flat ends around the line between two points. `width`, `height`: the edges of its cross section, m.
void add_beam(PolygonKit& kit, const char* group, const char* material, const Point& from, const Point& to,
              const Vec3& width, const Vec3& height);

/// Adds a square emitter with the sun's solid angle, at a distance from `target`, m. It causes this irradiance, W/m^2,
/// on a surface that faces it. `azimuth`: clockwise from +y, degrees; `altitude`: above the horizon, degrees.
void add_sun(PolygonKit& kit, const Point& target, double distance, double azimuth, double altitude, double irradiance);

/// Returns a unit vector that is uniform over all directions.
Vec3 random_direction(MersenneTwister& random);

}  // namespace exitance
