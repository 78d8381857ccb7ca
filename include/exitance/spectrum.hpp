#pragma once

#include <array>
#include <cstddef>

#ifndef EXITANCE_BANDS
#define EXITANCE_BANDS 3
#endif

namespace exitance::api {

/// Number of spectral bands of the library: 3 (red, green, blue) unless it was built with another number. The CMake
/// package defines EXITANCE_BANDS accordingly.
inline constexpr std::size_t bands = EXITANCE_BANDS;

/// Defined by the library for its own number of bands only: a program that is compiled for another number does not
/// link.
template <std::size_t n>
struct LibraryOfBands {
    static const char linked;
};
[[gnu::used]] inline const char* const library_of_bands = &LibraryOfBands<bands>::linked;

/// One value per band: W/m^2 for irradiance, radiosity and exitance (lx and lm/m^2 if the scene's light is in lumens),
/// dimensionless for reflectance.
struct Spectrum {
    std::array<double, bands> value{};

    constexpr Spectrum() = default;
    constexpr explicit Spectrum(double every_band) { value.fill(every_band); }

    constexpr double& operator[](std::size_t band) { return value[band]; }
    constexpr double operator[](std::size_t band) const { return value[band]; }
    constexpr bool operator==(const Spectrum&) const = default;
};

/// Mean over the bands. Totals in watts are this mean.
constexpr double mean(const Spectrum& s) {
    double sum = 0;
    for (const double v : s.value) sum += v;
    return sum / static_cast<double>(bands);
}

}  // namespace exitance::api
