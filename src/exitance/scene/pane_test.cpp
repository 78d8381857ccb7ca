#include "exitance/scene/pane.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {

TEST(Pane, TransmissionFollowsFresnel) {
    Pane clear;
    clear.transmissivity = Spectrum(1.0);
    const double r = std::pow(0.52 / 2.52, 2);
    EXPECT_NEAR(clear.transmission(1)[0], (1 - r) / (1 + r), 1e-12);  // includes all reflections between the two faces
    // At Brewster's angle one polarisation is transmitted completely: T = (1 + T_s) / 2.
    const double brewster = std::atan(1.52), c = std::cos(brewster),
                 inside = std::sqrt(1 - std::pow(std::sin(brewster) / 1.52, 2));
    const double rs = std::pow((c - 1.52 * inside) / (c + 1.52 * inside), 2);
    EXPECT_NEAR(clear.transmission(c)[0], 0.5 * (1 + (1 - rs) / (1 + rs)), 1e-12);
    EXPECT_LT(clear.transmission(1e-6)[0], 1e-4);
    EXPECT_EQ(clear.transmission(0)[0], 0);
}

TEST(Pane, ClearGlassReflectsAllThatItDoesNotTransmit) {
    Pane clear;
    clear.transmissivity = Spectrum(1.0);
    for (const double cosine : {1e-3, 0.1, 0.5, 0.9, 1.0})
        EXPECT_NEAR(clear.transmission(cosine)[0] + clear.reflection(cosine)[0], 1, 1e-12) << cosine;
    EXPECT_EQ(clear.reflection(0)[0], 1);
    clear.index = 1;
    EXPECT_EQ(clear.reflection(0.5)[0], 0);
    // Opaque glass reflects only at its first face.
    Pane dark;
    dark.transmissivity = Spectrum(0.0);
    EXPECT_NEAR(dark.reflection(1)[0], std::pow(0.52 / 2.52, 2), 1e-12);
}

TEST(Pane, RadiancesArgumentIsTheTransmissivity) {
    Pane pane;
    pane.transmissivity = Spectrum(0.96);
    EXPECT_NEAR(pane.transmission(1)[0], 0.88, 0.002);
    EXPECT_NEAR(transmissivity_of(pane.transmission(1))[0], 0.96, 1e-9);
    EXPECT_EQ(transmissivity_of(Spectrum(1.0))[0], 1);
    for (const double index : {1.0, 1.0001}) EXPECT_NEAR(transmissivity_of(Spectrum(0.3), index)[0], 0.3, 1e-6);
    EXPECT_EQ(transmissivity_of(Spectrum(0.0))[0], 0);
}

TEST(Pane, ConcavePanesAreSplit) {
    Pane bent;
    bent.transmissivity = Spectrum(0.9);
    bent.corners = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    const std::vector<Pane> cut = convex_panes({bent, Pane()});
    ASSERT_GT(cut.size(), 1u);
    for (const Pane& pane : cut) EXPECT_EQ(pane.n, (Normal{0, 0, 1}));
}

}  // namespace exitance
