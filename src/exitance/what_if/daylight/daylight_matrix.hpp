#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/scene/sky/sky_patches.hpp"

namespace exitance {

/// How a daylight matrix is made.
struct DaylightOptions {
    double elements = 6000;         ///< About how many, that interreflection goes between.
    double rays_an_element = 256;   ///< On average.
    unsigned rays_a_sensor = 2048;  ///< For reflected light; a power of two.
    std::uint64_t seed = 1;
};

/// Light of every patch of the sky at every sensor, lx of 1 cd/m^2 (or W/m^2 of 1 W/(m^2 sr)), bands weighted by
/// `luminous_weights()`.
struct DaylightMatrix {
    std::size_t patches = 0;
    std::vector<float> direct;     ///< Row by sensor: from the sky itself, and through glass.
    std::vector<float> reflected;  ///< After at least one reflection.

    std::size_t sensors() const { return patches > 0 ? direct.size() / patches : 0; }
    double total(std::size_t sensor, std::size_t patch) const {
        return double(direct[sensor * patches + patch]) + double(reflected[sensor * patches + patch]);
    }
};

/// One transport with as many right-hand sides as there are patches:
///
///     E = S + F rho E,     S what elements see of the patches, F what they see of each other, both by the same rays,
///
/// by Jacobi's iteration over all columns at once; then at the sensors the exact visible part of every patch, and a
/// gather of rho E by rays. The scene's own emitters are off. O(rays + iterations x rays x patches).
/// scene    its light from outside is replaced
DaylightMatrix make_daylight_matrix(Scene scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                                    const DaylightOptions& options, Progress& progress);

}  // namespace exitance
