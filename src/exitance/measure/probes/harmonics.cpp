#include "exitance/measure/probes/harmonics.hpp"

#include <cmath>

namespace exitance {

Harmonics<double> harmonics_at(const Vec3& w) {
    // Norms of the polynomials of degrees 0, 1 and 2 over the sphere [Ramamoorthi01].
    static const double zero = std::sqrt(1 / (4 * pi)), one = std::sqrt(3 / (4 * pi));
    static const double mixed = std::sqrt(15 / (4 * pi)), axial = std::sqrt(5 / (16 * pi));
    return {zero,
            one * w.y,
            one * w.z,
            one * w.x,
            mixed * w.x * w.y,
            mixed * w.y * w.z,
            axial * (3 * w.z * w.z - 1),
            mixed * w.x * w.z,
            0.5 * mixed * (w.x * w.x - w.y * w.y)};
}

Spectrum irradiance_of(const Harmonics<Spectrum>& radiance, const Normal& n) {
    const Harmonics<double> Y = harmonics_at(n);
    Spectrum E;
    for (std::size_t i = 0; i < harmonic_count; ++i) E += irradiance_factors[degree_of(i)] * Y[i] * radiance[i];
    return E;
}

}  // namespace exitance
