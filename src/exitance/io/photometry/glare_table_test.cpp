#include "exitance/io/photometry/glare_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace exitance {
namespace {

/// A Lambertian opening with sides of x and y metres, and `candela` cd straight down.
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

/// Luminaires of a standard room of X by Y mounting heights (2 m), as R, T and whether they count, computed
/// independently: 0.5 m apart, the first 0.25 m from the walls. Those nearer than R = 2 m / 1.7 are overhead. No
/// luminaire has H / R between 1.6 (R = 1.25 m) and 2.67 (R = 0.75 m), so the exact limit of Guth's rows does not
/// matter. 85 degrees from the nadir are at 22.86 m.
struct Hanging {
    double R, T;
    bool counts;
};
std::vector<Hanging> hanging_in(double x, double y) {
    std::vector<Hanging> out;
    for (int k = 0; k < 4 * y; ++k)
        for (int i = 0; i < 4 * x; ++i) {
            const double R = 0.25 + 0.5 * k, T = std::abs(0.25 + 0.5 * i - x);
            out.push_back({R, T, R > 1 && T <= 3 * R && std::hypot(R, T) <= 22.86});
        }
    return out;
}

/// Guth's position index for a luminaire 2 m above the eye.
double guth(double R, double T) {
    const double sigma = std::atan2(std::hypot(T, 2), R) * 180 / pi, tau = std::atan2(T, 2) * 180 / pi;
    return std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                    (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
}

/// Mean indirect illuminance of the walls of a room with reflectances 70/50/20 whose luminaires send `to_floor` and
/// `to_walls`, lm. F is the form factor between floor and ceiling.
double wall_illuminance(double x, double y, double F, double to_floor, double to_walls) {
    const double floor = 4 * x * y, walls = 8 * (x + y), wf = (1 - F) * floor / walls;
    double c = 0, w = 0, f = 0;
    for (int round = 0; round < 100; ++round) {
        const double Bc = 0.7 * c, Bw = 0.5 * (w + to_walls / walls), Bf = 0.2 * (f + to_floor / floor);
        c = F * Bf + (1 - F) * Bw, w = wf * (Bc + Bf) + (1 - 2 * wf) * Bw, f = F * Bc + (1 - F) * Bw;
    }
    return w;
}

TEST(GlareTable, OfALambertianPanelAgreesWithAHandCalculation) {
    // There are 64 panels in 2H x 2H, with L = 300 / 0.09 = 3333.3 cd/m^2, and 384 in 8H x 12H. They act as a uniform
    // Lambertian ceiling: F between floor and ceiling is 0.41525 for 4 x 4 x 2 m and 0.82036 for 16 x 24 x 2 m; the
    // flux is pi 300 lm per panel.
    const std::vector<GlareTableRow> table = make_glare_table(panel());
    ASSERT_EQ(table.size(), 95u);
    const double L = 300 / 0.09;
    for (const auto& [x, y, F] : {std::tuple{2.0, 2.0, 0.41525}, {8.0, 12.0, 0.82036}}) {
        double sum = 0, flux = 0;
        for (const Hanging& h : hanging_in(x, y)) {
            flux += pi * 300;
            const double r2 = h.R * h.R + h.T * h.T + 4, index = guth(h.R, h.T);
            if (h.counts) sum += L * L * 0.09 * 2 / std::pow(r2, 1.5) / (index * index);
        }
        const double E = wall_illuminance(x, y, F, F * flux, (1 - F) * flux);
        const double expected = 8 * std::log10(0.25 * pi / E * sum);
        EXPECT_NEAR(room(table, x, y).crosswise, expected, 0.1) << "luminaires are not quite a uniform ceiling";
        EXPECT_NEAR(room(table, x, y).crosswise, room(table, x, y).endwise, 1e-9);
    }
}

TEST(GlareTable, OfANarrowDownlightIgnoresLuminairesOverhead) {
    // A beam of 3800 cd around the axis and weak light elsewhere, from an opening of 66 mm diameter. Luminaires
    // overhead would add 12 to the UGR.
    const auto candela = [](double degrees) {
        return 3800 * std::exp(-std::pow(degrees / 16, 2)) + 12 * std::cos(degrees * pi / 180);
    };
    Photometry p;
    p.opening = {Opening::Shape::ellipse, {0.066, 0.066, 0}};
    for (int t = 0; t <= 180; ++t) {
        p.theta.push_back(t / 2.0);
        p.candela.push_back(candela(t / 2.0));
    }
    p.phi = {0};
    double sum = 0, to_floor = 0, flux = 0;
    for (const Hanging& h : hanging_in(2, 2)) {
        const double r2 = h.R * h.R + h.T * h.T + 4, gamma = std::acos(2 / std::sqrt(r2)) * 180 / pi;
        const double area = pi * 0.033 * 0.033 * 2 / std::sqrt(r2), index = guth(h.R, h.T);
        if (h.counts) sum += candela(gamma) * candela(gamma) / (area * r2 * index * index);
        constexpr int parts = 80;  // parts per side of the floor
        for (int i = 0; i < parts * parts; ++i) {
            const double dx = (i % parts + 0.5) * 4 / parts - (h.T + 2), dy = (i / parts + 0.5) * 4 / parts - h.R;
            const double d2 = dx * dx + dy * dy + 4;
            to_floor += candela(std::acos(2 / std::sqrt(d2)) * 180 / pi) * 2 / std::pow(d2, 1.5) * 16 / (parts * parts);
        }
    }
    for (double t = 0.05; t < 90; t += 0.1) flux += 64 * candela(t) * 2 * pi * std::sin(t * pi / 180) * 0.1 * pi / 180;
    const double E = wall_illuminance(2, 2, 0.41525, to_floor, flux - to_floor);
    const double found = room(make_glare_table(p), 2, 2).crosswise;
    EXPECT_NEAR(found, 8 * std::log10(0.25 * pi / E * sum), 0.1) << "rays of the table by 1 and 2.5 degrees";
}

TEST(GlareTable, HasNoValueIfAllLightGoesStraightDown) {
    Photometry p = panel();
    for (std::size_t t = 0; t < p.theta.size(); ++t)
        if (p.theta[t] > 25) p.candela[t] = 0;  // the nearest luminaires that count are seen at 32 degrees
    for (const GlareTableRow& row : make_glare_table(p)) EXPECT_FALSE(std::isfinite(row.crosswise));
}

TEST(GlareTable, OfAPointEqualsThatOfASmallSource) {
    // L^2 omega is I^2 / (0.005 m^2 r^2) in every direction for a point, I^2 / (A cos gamma r^2) for a plane opening.
    Photometry point = panel();
    point.opening = {};
    double of_panel = 0, of_point = 0;
    for (const Hanging& h : hanging_in(2, 2)) {
        if (!h.counts) continue;
        const double r = std::sqrt(h.R * h.R + h.T * h.T + 4), I = 300 * 2 / r, index = guth(h.R, h.T);
        of_panel += I * I / (0.09 * 2 / r * r * r * index * index);
        of_point += I * I / (0.005 * r * r * index * index);
    }
    const double higher = room(make_glare_table(point), 2, 2).endwise - room(make_glare_table(panel()), 2, 2).endwise;
    EXPECT_NEAR(higher, 8 * std::log10(of_point / of_panel), 1e-3) << "a table by degrees is linear between them";
}

TEST(GlareTable, OfAThinBoxUsesItsTrueHeight) {
    // At angle gamma, a box of a x b x h has the projected area a b cos gamma + a h sin gamma if seen along b.
    for (const double height : {0.001, 0.003, 0.02}) {
        Photometry box = panel();
        box.opening = {Opening::Shape::box, {0.024, 0.6, height}};
        Photometry flat = box;
        flat.opening = {Opening::Shape::rectangle, {0.024, 0.6, 0}};
        const double higher =
            room(make_glare_table(flat), 2, 2).crosswise - room(make_glare_table(box), 2, 2).crosswise;
        double of_flat = 0, of_box = 0;
        for (const Hanging& h : hanging_in(2, 2)) {
            if (!h.counts) continue;
            const double r = std::sqrt(h.R * h.R + h.T * h.T + 4), index = guth(h.R, h.T);
            const double I = 300 * 2 / r, A = 0.024 * 0.6 * 2 / r;
            const double sides = height * (0.6 * h.R + 0.024 * h.T) / r;  // crosswise: the long side faces the eye
            of_flat += I * I / (A * r * r * index * index), of_box += I * I / ((A + sides) * r * r * index * index);
        }
        EXPECT_NEAR(higher, 8 * std::log10(of_flat / of_box), 0.01) << height;
    }
}

TEST(GlareTable, RisesWithFluxAndFallsWithReflectance) {
    const std::vector<GlareTableRow> once = make_glare_table(panel()), twice = make_glare_table(panel(0.3, 0.3, 600));
    for (std::size_t i = 0; i < once.size(); ++i)
        EXPECT_NEAR(twice[i].crosswise - once[i].crosswise, 8 * std::log10(2), 1e-9);
    EXPECT_GT(room(once, 4, 8, 0.3).endwise, room(once, 4, 8, 0.5).endwise);
    EXPECT_GT(room(once, 8, 12).endwise, room(once, 2, 2).endwise);
}

TEST(GlareTable, IsWrittenWithOneDecimalAndEmptyWithoutGlare) {
    const std::string text = glare_table_csv(make_glare_table(panel()));
    EXPECT_EQ(text.find("ceiling,walls,floor,X,Y,crosswise,endwise\n70,50,20,2,2,"), 0u);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 96);
    EXPECT_NE(glare_table_csv(make_glare_table(panel(0.3, 0.3, 0))).find("\n70,50,20,2,2,,\n"), std::string::npos);
}

}  // namespace
}  // namespace exitance
