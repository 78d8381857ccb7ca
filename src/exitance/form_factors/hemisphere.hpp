#pragma once

#include <span>

#include "exitance/base/processor.hpp"
#include "exitance/base/random.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// A direction around frame.n with density cos / pi, from two numbers in [0, 1): area is kept from the square to the
/// disc and from the disc to the cosine-weighted hemisphere, so that stratified pairs give stratified directions.
/// Source: [Shirley97], [Malley88].
Vec3 cosine_direction(const Frame& frame, double a, double b);

/// The same for many, from as many of the first and of the second numbers, with the same bits: about 3 ns each with
/// AVX-512, 6 without.
void cosine_directions(const Frame& frame, std::span<const double> a, std::span<const double> b,
                       std::span<Vec3> directions, Processor processor = Processor::fastest);

}  // namespace exitance
