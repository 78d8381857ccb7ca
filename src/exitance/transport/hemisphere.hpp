#pragma once

#include "exitance/core/random.hpp"
#include "exitance/geometry/vec.hpp"

namespace exitance {

struct SineAndCosine {
    double sine, cosine;
};

/// Of an angle in [-pi/4, pi/4], by their series; exact but for rounding (terms left out are below 1e-17), alike on
/// every machine, and several times as fast as the library's.
inline SineAndCosine sine_and_cosine(double angle) {
    const double q = angle * angle;
    constexpr auto term = [](int n) { return 1.0 / (n * (n - 1.0)); };  // each from the one before it
    double sine = 1, cosine = 1;
    for (int n = 17; n > 1; n -= 2) {
        sine = 1 - q * term(n) * sine;
        cosine = 1 - q * term(n - 1) * cosine;
    }
    return {angle * sine, cosine};
}

/// A direction around frame.n with density cos / pi, from two numbers in [0, 1): area is kept from the square to the
/// disc and from the disc to the cosine-weighted hemisphere, so that stratified pairs give stratified directions.
/// Source: [Shirley97], [Malley88].
inline Vec3 cosine_direction(const Frame& frame, double a, double b) {
    const double s = 2 * a - 1, t = 2 * b - 1;
    const bool wide = std::abs(s) > std::abs(t);
    const double radius = wide ? s : t, other = wide ? t : s;
    const auto [sine, cosine] = sine_and_cosine(radius != 0 ? pi / 4 * (other / radius) : 0);
    const double x = radius * (wide ? cosine : sine), y = radius * (wide ? sine : cosine);
    // A direction in the plane itself would never leave it.
    return frame.to_world(x, y, std::sqrt(std::max(1e-12, 1 - x * x - y * y)));
}

}  // namespace exitance
