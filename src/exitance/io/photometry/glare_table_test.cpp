#include "exitance/io/photometry/glare_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// A Lambertian opening of 0.3 x 0.3 m, or of other sides, with 300 cd straight down.
Photometry panel(double x = 0.3, double y = 0.3, double candela = 300) {
    Photometry p;
    p.opening = {Opening::Shape::rectangle, {x, y, 0}};
    for (int t = 0; t <= 90; t += 1) {
        p.theta.push_back(t);
        p.candela.push_back(candela * std::max(0.0, std::cos(t * pi / 180)));
    }
    p.phi = {0};
    return p;
}

const GlareTableRow& room(const std::vector<GlareTableRow>& table, double x, double y, double walls = 0.5) {
    return *std::find_if(table.begin(), table.end(),
                         [&](const GlareTableRow& r) { return r.x == x && r.y == y && r.walls == walls; });
}

TEST(GlareTable, OfALambertianPanelIsThatWorkedOutByHand) {
    // Room 2H x 2H, 4 x 4 x 2 m, 70/50/20, 64 panels of L = 300 / 0.09 = 3333.3 cd/m^2: sum and background below.
    const std::vector<GlareTableRow> table = make_glare_table(panel());
    ASSERT_EQ(table.size(), 95u);
    const double L = 300 / 0.09;
    double sum = 0;
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 8; ++k) {
            const double x = 0.25 + 0.5 * i - 2, y = 0.25 + 0.5 * k, off = std::hypot(x, 2.0), r2 = x * x + y * y + 4;
            const double sigma = std::atan2(off, y) * 180 / pi, tau = std::atan2(std::abs(x), 2.0) * 180 / pi;
            const double p = std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                                      (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
            sum += L * L * 0.09 * 2 / std::pow(r2, 1.5) / (p * p);
        }
    // A uniform ceiling of Lambertian light: F between floor and ceiling of 4 x 4 x 2 m is 0.41525; phi = 64 pi 300 lm.
    const double F = 0.41525, flux = 64 * pi * 300, floor = 16, walls = 32, wf = (1 - F) * floor / walls;
    double c = 0, w = 0, f = 0;
    for (int round = 0; round < 100; ++round) {
        const double Bc = 0.7 * c, Bw = 0.5 * (w + flux * (1 - F) / walls), Bf = 0.2 * (f + flux * F / floor);
        c = F * Bf + (1 - F) * Bw, w = wf * (Bc + Bf) + (1 - 2 * wf) * Bw, f = F * Bc + (1 - F) * Bw;
    }
    const double expected = 8 * std::log10(0.25 * pi / w * sum);
    EXPECT_NEAR(room(table, 2, 2).crosswise, expected, 0.1);  // luminaires are not quite a uniform ceiling
    EXPECT_NEAR(room(table, 2, 2).crosswise, room(table, 2, 2).endwise, 1e-9);
}

TEST(GlareTable, RisesWithFluxAndFallsWithReflectance) {
    const std::vector<GlareTableRow> once = make_glare_table(panel()), twice = make_glare_table(panel(0.3, 0.3, 600));
    for (std::size_t i = 0; i < once.size(); ++i)
        EXPECT_NEAR(twice[i].crosswise - once[i].crosswise, 8 * std::log10(2), 1e-9);
    EXPECT_GT(room(once, 4, 8, 0.3).endwise, room(once, 4, 8, 0.5).endwise);
    EXPECT_GT(room(once, 8, 12).endwise, room(once, 2, 2).endwise);
}

TEST(GlareTable, IsWrittenInTenthsAndWithoutValuesWhereNothingShines) {
    const std::string text = glare_table_csv(make_glare_table(panel()));
    EXPECT_EQ(text.find("ceiling,walls,floor,X,Y,crosswise,endwise\n70,50,20,2,2,"), 0u);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 96);
    EXPECT_NE(glare_table_csv(make_glare_table(panel(0.3, 0.3, 0))).find("\n70,50,20,2,2,,\n"), std::string::npos);
}

}  // namespace
}  // namespace exitance
