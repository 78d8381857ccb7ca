#pragma once

#include <span>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Returns the exchange area A_i F_ij = A_j F_ji of two polygons without occlusion, m^2.
///
///     A_i F_ij = Int_i Int_j cos_i cos_j / (pi r^2) = 1/(2 pi) ContourInt_i ContourInt_j ln r dx . dy
///
/// after each polygon has been clipped to the front side of the other, which is exact. The inner integral along an edge
/// has a closed form; the outer one is adaptive Gauss quadrature. Outer edges are split where they pass end points of
/// the inner edge, and a quintic map removes the logarithmic singularity at touching ends. For pairs more than ten
/// sizes apart the contour integral loses digits; Gauss points on both areas are used instead.
/// receiver, source  simple planar polygons, metres, counter-clockwise seen from the front; need not be convex
/// tolerance         relative error, at least 1e-13; rounding leaves about 1e-13 for touching pairs
/// Returns 0 if either polygon is behind the other. Cost: O(corners^2) logarithms, about 5 us for squares at 1e-4, 30
/// us at 1e-10.
/// Source: [Schroder93], [Baum89]; after Lambert's contour sum.
double exchange_area(std::span<const Point> receiver, std::span<const Point> source, double tolerance = 1e-12);

/// Returns F_ij, the share of the receiver's diffuse flux that reaches the front of `source` without occlusion.
double pair_form_factor(std::span<const Point> receiver, std::span<const Point> source, double tolerance = 1e-12);

}  // namespace exitance
