#pragma once

#include <span>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// The exchange area A_i F_ij = A_j F_ji of two polygons with nothing in between, m^2.
///
///     A_i F_ij = Int_i Int_j cos_i cos_j / (pi r^2) = 1/(2 pi) ContourInt_i ContourInt_j ln r dx . dy
///
/// after each has been clipped to the front of the other, which is exact. The inner integral along an edge is closed,
/// the outer one is adaptive Gauss quadrature: edges are cut where they pass another edge's end points, and a quintic
/// map takes the logarithm out of ends that touch. Pairs further apart than ten sizes lose digits in the contour sum
/// and take Gauss points on both areas instead. Source: [Schroder93], [Baum89]; after Lambert's contour sum.
/// receiver, source  simple planar polygons, metres, counter-clockwise seen from the front; need not be convex
/// tolerance         relative error asked for, down to 1e-13; double rounding leaves about 1e-13 of touching pairs
/// returns 0 when either lies behind the other. O(corners^2) logarithms: about 5 us for squares at 1e-4, 30 us at
/// 1e-10.
double exchange_area(std::span<const Point> receiver, std::span<const Point> source, double tolerance = 1e-12);

/// F_ij, the share of the receiver's diffuse flux that would reach the front of `source`, nothing in between.
double pair_form_factor(std::span<const Point> receiver, std::span<const Point> source, double tolerance = 1e-12);

}  // namespace exitance
