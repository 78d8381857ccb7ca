#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/scene/sky/sky_patches.hpp"

namespace exitance {

/// Number of independent estimates of reflected light. Each uses its share of the rays, from the transport to the
/// sensors, so that the spread of any result of them is the noise of that result.
constexpr std::size_t daylight_replicates = 8;

/// Settings of a daylight matrix. Rays are those of all replicates together.
struct DaylightOptions {
    double elements = 6000;         ///< Approximate number of elements for interreflection.
    double rays_an_element = 256;   ///< Average number of rays per element.
    unsigned rays_a_sensor = 2048;  ///< Rays per sensor for reflected light; a power of two.
    std::uint64_t seed = 1;
};

/// Light of every patch of the sky at every sensor: lx per cd/m^2 (or W/m^2 per W/(m^2 sr)), bands weighted by
/// `luminous_weights()`.
struct DaylightMatrix {
    std::size_t patches = 0;
    std::vector<float> direct;     ///< Row by row, one per sensor: light that arrives from the sky, also through glass.
    std::vector<float> reflected;  ///< Light after at least one reflection: the mean of the replicates.
    std::array<std::vector<float>, daylight_replicates> replicates;  ///< Independent estimates of it.

    std::size_t sensors() const { return patches > 0 ? direct.size() / patches : 0; }
    double total(std::size_t sensor, std::size_t patch) const {
        return double(direct[sensor * patches + patch]) + double(reflected[sensor * patches + patch]);
    }
};

/// Computes a daylight matrix with one transport and one right-hand side per patch:
///
///     E = S + F rho E,     S: light of patches on elements, F: transport between elements, both by the same rays,
///
/// by Jacobi iteration over all columns at once, for each replicate. Then computes the exact visible part of every
/// patch at the sensors, and a gather of rho E by rays. The scene's own emitters are off; its light from outside is
/// replaced by the patches. O(rays + iterations x rays x patches).
DaylightMatrix make_daylight_matrix(Scene scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                                    const DaylightOptions& options, Progress& progress);

/// The product of a daylight matrix with the luminances of all patches, as a matrix with one column: `sky` for light
/// straight from the patches, `reflected` for light after reflections. Uses the rays of `make_daylight_matrix`, but
/// solves for one right-hand side only: O(rays x iterations).
DaylightMatrix make_daylight_column(Scene scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                                    std::span<const double> sky, std::span<const double> reflected,
                                    const DaylightOptions& options, Progress& progress);

}  // namespace exitance
