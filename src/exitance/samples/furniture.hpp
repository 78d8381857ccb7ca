#pragma once

#include <span>

#include "exitance/samples/mersenne_twister.hpp"
#include "exitance/samples/polygon_kit.hpp"

namespace exitance {

// Furniture stands on the floor with open legs, so that no two faces coincide. Metres.

/// 27 polygons: seat, back rest and four legs, facing +y.
void add_chair27(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place);
/// 36 polygons: like chair27, with three aprons under the seat.
void add_chair36(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place);
/// 63 polygons: with posts, slats, stretchers and a cushion of the material "cushion".
void add_chair63(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place);
/// 32 polygons: top, four legs, aprons and a stretcher.
void add_table32(PolygonKit& kit, std::string_view group, std::string_view material, const Placement& place);
/// 30 polygons: a desk with a dark pad and a monitor, of the materials "desk" and "screen".
void add_desk(PolygonKit& kit, const std::string& group, const Placement& place);
/// 26 polygons of the material "shelf", and 5 per book on each of four boards; books differ in size and material.
void add_shelf(PolygonKit& kit, const std::string& group, const Placement& place, int books,
               std::span<const std::string> book_materials, MersenneTwister& random);

}  // namespace exitance
