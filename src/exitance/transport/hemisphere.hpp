#pragma once

#include "exitance/core/random.hpp"
#include "exitance/geometry/vec.hpp"

namespace exitance {

/// A direction around frame.n with density cos / pi, from two numbers in [0, 1): area is kept from the square to the
/// disc and from the disc to the cosine-weighted hemisphere, so that stratified pairs give stratified directions.
/// Source: [Shirley97], [Malley88].
inline Vec3 cosine_direction(const Frame& frame, double a, double b) {
    const double s = 2 * a - 1, t = 2 * b - 1;
    double radius = 0, angle = 0;
    if (std::abs(s) > std::abs(t)) {
        radius = s, angle = pi / 4 * (t / s);
    } else if (t != 0) {
        radius = t, angle = pi / 2 - pi / 4 * (s / t);
    }
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    // A direction in the plane itself would never leave it.
    return frame.to_world(x, y, std::sqrt(std::max(1e-12, 1 - x * x - y * y)));
}

}  // namespace exitance
