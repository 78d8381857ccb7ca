#include "exitance/solve/shooting.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Inside of a sphere, where F_ij = A_j / sum A for all i. Each patch has two or three receivers with non-consecutive
/// numbers. Initially every patch sends 1 W/m^2.
struct Sphere {
    explicit Sphere(std::size_t patches) : patch_area(patches), unshot(patches, Spectrum(1)) {
        const std::size_t receivers = 2 * patches + patches / 2;
        for (std::size_t i = 0; i < receivers; ++i) {
            patch_of.push_back(static_cast<std::uint32_t>(7 * i % patches));
            receiver_area.push_back(1 + static_cast<double>(i % 3));
            patch_area[patch_of[i]] += receiver_area[i];
            reflectance.push_back(rho);
            area += receiver_area[i];
        }
        irradiance.resize(receivers);
        column.resize(receivers);
    }

    SolveReport shoot(const ShootingOptions& options) {
        const ShootingProblem problem{patch_of, receiver_area, patch_area, reflectance, [&](std::size_t p) {
                                          std::fill(column.begin(), column.end(),
                                                    static_cast<float>(patch_area[p] / area));
                                          return std::span<const float>(column);
                                      }};
        return exitance::shoot(problem, options, unshot, irradiance);
    }

    Spectrum rho = [] {
        Spectrum r;
        for (std::size_t b = 0; b < bands; ++b) r[b] = 0.8 / static_cast<double>(b + 1);
        return r;
    }();
    double area = 0;
    std::vector<std::uint32_t> patch_of;
    std::vector<double> receiver_area, patch_area;
    std::vector<Spectrum> reflectance, unshot, irradiance;
    std::vector<float> column;
};

}  // namespace

/// E = M / (1 - rho), less the unshot share. That is 1e-3 in the mean over bands, and at most `bands` times that in one
/// band.
TEST(Shooting, LightsASphereEvenly) {
    for (const bool overshooting : {false, true}) {
        Sphere sphere(600);  // more than one block of patches
        const SolveReport report = sphere.shoot({.overshooting = overshooting, .unshot = 1e-3});
        EXPECT_TRUE(report.converged);
        for (const Spectrum& E : sphere.irradiance)
            for (std::size_t b = 0; b < bands; ++b) EXPECT_NEAR(E[b] * (1 - sphere.rho[b]), 1, 1.01e-3 * bands);
    }
}

TEST(Shooting, IsTheSameOnAnyNumberOfThreads) {
    std::vector<Spectrum> alone;
    for (int threads : {1, 3}) {
        set_threads(threads);
        Sphere sphere(1300);
        sphere.shoot({.unshot = 1e-2});
        if (threads == 1) alone = sphere.irradiance;
        EXPECT_EQ(sphere.irradiance, alone);
    }
    set_threads(0);
}

}  // namespace exitance
