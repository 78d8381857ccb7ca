#include "exitance/error/error_factors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/wrong_furnace.hpp"

namespace exitance {
namespace {

/// Returns the factors for the samples of a furnace, whose residual is known, if the coarse response has this share of
/// the light that its errors cause by further reflections.
ErrorFactors factors_of(WrongFurnace& furnace, double share, std::uint64_t seed) {
    const double late = share * WrongFurnace::late_part;
    ErrorDomains domains{.light_of_room = {1.0}, .bodies = 2, .max_factor = 4};
    for (ResidualSample& s : furnace.samples) {
        s.r1 = s.r2 = s.delivered = Spectrum(WrongFurnace::residual);
        s.squared = std::pow(WrongFurnace::residual + late, 2);
        domains.body_of.push_back(s.region == RegionId(0) ? 0 : 1);
    }
    const std::vector<Spectrum> response{Spectrum(late)};
    return measure_error_factors(furnace.late_paths(), furnace.samples, response, domains, seed, 1 << 18);
}

// The true error is (residual + late_part), the one by the coarse response (residual + share late_part).
TEST(ErrorFactors, AreTheShareOfLightThatTheCoarseResponseLacks) {
    for (const double share : {0.0, 0.5}) {
        WrongFurnace furnace;
        const double right = (WrongFurnace::residual + WrongFurnace::late_part) /
                             (WrongFurnace::residual + share * WrongFurnace::late_part);
        const ErrorFactors found = factors_of(furnace, share, 1);
        // Some 3000 paths, each with a standard deviation of sqrt(2) times its mean, give the light of all paths, which
        // is as large as the residual, an error of 3%; those from one of six faces, 6%.
        const double noise = 0.03 / (1 + share);
        EXPECT_NEAR(found.whole, right, 4 * noise) << share;
        EXPECT_DOUBLE_EQ(found.rooms[0], found.whole);
        for (const double body : found.bodies) EXPECT_NEAR(body, right, 4 * 2 * noise) << share;
        const double added = (1 - share) * WrongFurnace::late_part;
        EXPECT_NEAR(std::sqrt(found.explained), std::abs(added), 0.2 * std::abs(added)) << share;
    }
}

TEST(ErrorFactors, AreOneWhereTheCoarseResponseIsRight) {
    WrongFurnace furnace;
    int raised = 0;
    std::size_t rays = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const ErrorFactors found = factors_of(furnace, 1.0, seed);
        raised += found.whole > 1;
        EXPECT_GE(found.whole, 1);
        rays = std::max(rays, found.rays);
    }
    // Noise exceeds one standard error in one of 6 cases, and two in one of 40: both in one of 250.
    EXPECT_LE(raised, 1);
    EXPECT_LE(rays, 2u << 18);
}

}  // namespace
}  // namespace exitance
