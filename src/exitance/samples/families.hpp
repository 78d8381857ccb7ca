#pragma once

#include <map>
#include <string>

#include "exitance/samples/polygon_kit.hpp"

namespace exitance {

/// Complete and checked values of a family's parameters.
using FamilyValues = std::map<std::string, double>;

// Scenes with analytic solutions, and rooms.
PolygonKit make_blocker(const FamilyValues& values);
PolygonKit make_tube(const FamilyValues& values);
PolygonKit make_furnace(const FamilyValues& values);
PolygonKit make_complex(const FamilyValues& values);
PolygonKit make_cornell(const FamilyValues& values);
PolygonKit make_gcr1(const FamilyValues& values);
PolygonKit make_gcr2(const FamilyValues& values);
PolygonKit make_office(const FamilyValues& values);
PolygonKit make_carpet(const FamilyValues& values);

// Open scenes under one to four lights of equal power.
PolygonKit make_flat(const FamilyValues& values);
PolygonKit make_boxes(const FamilyValues& values);
PolygonKit make_table(const FamilyValues& values);
PolygonKit make_chair(const FamilyValues& values);
PolygonKit make_float(const FamilyValues& values);
PolygonKit make_spiral(const FamilyValues& values);

// Closed rooms in which light paths are hard to find.
PolygonKit make_cove(const FamilyValues& values);
PolygonKit make_blinds(const FamilyValues& values);
PolygonKit make_clutter(const FamilyValues& values);
PolygonKit make_gaps(const FamilyValues& values);
PolygonKit make_door(const FamilyValues& values);
PolygonKit make_keyhole(const FamilyValues& values);
PolygonKit make_bright(const FamilyValues& values);
PolygonKit make_tree(const FamilyValues& values);
PolygonKit make_lightwell(const FamilyValues& values);

// Parts of buildings, in daylight or lamplight.
PolygonKit make_atrium(const FamilyValues& values);
PolygonKit make_stair(const FamilyValues& values);
PolygonKit make_colonnade(const FamilyValues& values);
PolygonKit make_greenhouse(const FamilyValues& values);
PolygonKit make_furniture(const FamilyValues& values);
PolygonKit make_canopy(const FamilyValues& values);

/// Formats a value for a file name: 0.7 becomes 0p7.
std::string in_a_name(double value);

}  // namespace exitance
