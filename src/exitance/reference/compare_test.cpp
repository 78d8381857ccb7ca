#include "exitance/reference/compare.hpp"

#include <gtest/gtest.h>

#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// Points on the floor (reflectance 0.3, 0.2 ..., 0.1), a wall, the lamp (reflects nothing) and in free space.
struct Samples {
    Scene scene = sample_scene();
    std::vector<Spectrum> irradiance, reference, errors;
    std::vector<SurfaceId> surfaces;

    void add(SurfaceId s, double e, double ref, double se = 0) {
        surfaces.push_back(s);
        irradiance.emplace_back(e), reference.emplace_back(ref), errors.emplace_back(se);
    }
    ErrorSamples view(bool with_errors = true) const {
        return {irradiance, reference, with_errors ? errors : std::span<const Spectrum>(), surfaces};
    }
};

const SurfaceId floor_face(0u), wall(2u), lamp(3u);

/// Means over the bands of rho and of rho^2.
double mean_of(const Spectrum& s) {
    return mean(s);
}
double mean_square(const Spectrum& s) {
    return squared(s) / double(bands);
}

TEST(ErrorMeasure, IsTheRmsOfRadiosityOverTheMeanReflectedRadiosity) {
    Samples s;
    s.add(floor_face, 11, 10);
    s.add(wall, 4, 5);
    const Spectrum f = s.scene.material(floor_face).reflectance, w = s.scene.material(wall).reflectance;
    const double level = (10 * mean_of(f) + 5 * mean_of(w)) / 2;
    const ErrorMeasure m = measure_error(s.view(), s.scene);
    const double rounding = 1e-14;
    EXPECT_NEAR(m.raw_relative_rms_error, std::sqrt((mean_square(f) + mean_square(w)) / 2) / level, rounding);
    EXPECT_NEAR(m.bias, (mean_of(f) - mean_of(w)) / 2 / level, rounding);
    EXPECT_EQ(m.relative_rms_error, m.raw_relative_rms_error);
    EXPECT_EQ(m.reference_noise, 0);
    EXPECT_EQ(m.points, 2u);
    EXPECT_FALSE(m.of_irradiance);
    EXPECT_NEAR(m.median_relative_error, 0.2, rounding);  // the upper one of 0.1 and 0.2
}

TEST(ErrorMeasure, SubtractsTheNoiseOfTheReference) {
    Samples s;
    s.add(floor_face, 12, 10, 1);
    s.add(floor_face, 8, 10, 1);
    const ErrorMeasure m = measure_error(s.view(), s.scene), exact = measure_error(s.view(false), s.scene);
    EXPECT_NEAR(m.reference_noise, m.raw_relative_rms_error / 2, 1e-14);  // rounding
    EXPECT_NEAR(m.relative_rms_error, std::sqrt(3) / 2 * m.raw_relative_rms_error, 1e-14);
    EXPECT_EQ(exact.relative_rms_error, m.raw_relative_rms_error);
    s.irradiance = s.reference;
    EXPECT_EQ(measure_error(s.view(), s.scene).relative_rms_error, 0);
}

TEST(ErrorMeasure, IsOfIrradianceIfNothingReflects) {
    Samples s;
    s.add(lamp, 11, 10);
    s.add(lamp, 30, 30);
    const ErrorMeasure m = measure_error(s.view(), s.scene);
    EXPECT_TRUE(m.of_irradiance);
    EXPECT_NEAR(m.relative_rms_error, std::sqrt(0.5) / 20, 1e-14);  // rounding
    EXPECT_NEAR(m.bias, 0.5 / 20, 1e-14);
}

TEST(ErrorMeasure, SkipsFreeSpaceUnlessAllPointsAreInIt) {
    Samples s;
    s.add(SurfaceId(), 100, 1);
    EXPECT_NEAR(measure_error(s.view(), s.scene).relative_rms_error, 99, 1e-12);  // rounding
    s.add(floor_face, 10, 10);
    EXPECT_EQ(measure_error(s.view(), s.scene).relative_rms_error, 0);
    EXPECT_EQ(measure_error(s.view(), s.scene).points, 1u);
}

TEST(ErrorMeasure, OfADarkReferenceIsZeroOrInfinite) {
    Samples s;
    s.add(floor_face, 0, 0);
    EXPECT_EQ(measure_error(s.view(), s.scene).relative_rms_error, 0);
    EXPECT_EQ(measure_error(s.view(), s.scene).median_relative_error, 0);
    s.add(floor_face, 1, 0);
    EXPECT_EQ(measure_error(s.view(), s.scene).relative_rms_error, HUGE_VAL);
}

TEST(ErrorMeasure, OfAResultThatIsNotFiniteIsInfinite) {
    Samples s;
    s.add(floor_face, 10, 10);
    s.add(floor_face, NAN, 10);
    EXPECT_EQ(measure_error(s.view(), s.scene).relative_rms_error, HUGE_VAL);
}

}  // namespace
}  // namespace exitance
