#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#ifndef EXITANCE_BANDS
#define EXITANCE_BANDS 3
#endif

namespace exitance {

/// Number of spectral bands of the build (CMake: -DEXITANCE_BANDS=N). Transport does not depend on the band: visibility
/// and form factors are computed once for all bands.
inline constexpr std::size_t bands = EXITANCE_BANDS;

/// Defined by the library for its own number of bands only: a program that is compiled for another number does not
/// link, instead of misreading every structure that holds a Spectrum.
template <std::size_t n>
struct LibraryOfBands {
    static const char linked;
};
[[gnu::used]] inline const char* const library_of_bands = &LibraryOfBands<bands>::linked;

/// One value per band: W/m^2 for exitance, irradiance and radiosity, dimensionless for reflectance.
struct Spectrum {
    std::array<double, bands> value{};

    constexpr Spectrum() = default;
    constexpr explicit Spectrum(double every_band) { value.fill(every_band); }

    constexpr double& operator[](std::size_t band) { return value[band]; }
    constexpr double operator[](std::size_t band) const { return value[band]; }
    constexpr bool operator==(const Spectrum&) const = default;

    constexpr Spectrum& operator+=(const Spectrum& o) {
        for (std::size_t b = 0; b < bands; ++b) value[b] += o.value[b];
        return *this;
    }
    constexpr Spectrum& operator-=(const Spectrum& o) {
        for (std::size_t b = 0; b < bands; ++b) value[b] -= o.value[b];
        return *this;
    }
    constexpr Spectrum& operator*=(const Spectrum& o) {
        for (std::size_t b = 0; b < bands; ++b) value[b] *= o.value[b];
        return *this;
    }
    constexpr Spectrum& operator*=(double s) {
        for (std::size_t b = 0; b < bands; ++b) value[b] *= s;
        return *this;
    }
};

constexpr Spectrum operator+(Spectrum a, const Spectrum& b) {
    return a += b;
}
constexpr Spectrum operator-(Spectrum a, const Spectrum& b) {
    return a -= b;
}
constexpr Spectrum operator*(Spectrum a, const Spectrum& b) {
    return a *= b;
}
constexpr Spectrum operator*(Spectrum a, double s) {
    return a *= s;
}
constexpr Spectrum operator*(double s, Spectrum a) {
    return a *= s;
}
constexpr Spectrum operator/(Spectrum a, double s) {
    return a *= 1 / s;
}

/// Mean over the bands: the scalar by which refinement and ordering compare spectra.
constexpr double mean(const Spectrum& s) {
    double sum = 0;
    for (double v : s.value) sum += v;
    return sum / static_cast<double>(bands);
}

/// True if all bands are equal.
constexpr bool is_grey(const Spectrum& s) {
    for (const double v : s.value)
        if (v != s.value[0]) return false;
    return true;
}
constexpr double max(const Spectrum& s) {
    return *std::max_element(s.value.begin(), s.value.end());
}

/// Sum of squares over the bands.
constexpr double squared(const Spectrum& s) {
    double sum = 0;
    for (double v : s.value) sum += v * v;
    return sum;
}

inline bool is_finite(const Spectrum& s) {
    return std::all_of(s.value.begin(), s.value.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace exitance
