#pragma once

#include <span>

#include "exitance/base/processor.hpp"
#include "exitance/base/random.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Returns a direction of density cos / pi around frame.n from two numbers in [0, 1). The maps from the square to the
/// disc and from the disc to the hemisphere preserve (cosine-weighted) area, so that stratified pairs give stratified
/// directions. Source: [Shirley97], [Malley88].
Vec3 cosine_direction(const Frame& frame, double a, double b);

/// Like cosine_direction() for many pairs (a[i], b[i]), with bit-identical results: about 3 ns each with AVX-512, 6 ns
/// without.
void cosine_directions(const Frame& frame, std::span<const double> a, std::span<const double> b,
                       std::span<Vec3> directions, Processor processor = Processor::fastest);

}  // namespace exitance
