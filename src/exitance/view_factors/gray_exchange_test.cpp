#include "exitance/view_factors/gray_exchange.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

namespace exitance {
namespace {

SparseFactors table(std::vector<double> areas, const std::vector<std::vector<double>>& F) {
    SparseFactors out;
    out.areas = std::move(areas);
    for (const auto& row : F) {
        for (std::size_t j = 0; j < row.size(); ++j)
            if (row[j] != 0) out.columns.push_back(static_cast<std::uint32_t>(j)), out.values.push_back(row[j]);
        out.starts.push_back(out.columns.size());
    }
    return out;
}

double black(double t) {
    return stefan_boltzmann * std::pow(t, 4);
}

GrayExchange solved(const SparseFactors& F, const std::vector<ThermalSurface>& surfaces,
                    std::optional<double> surroundings = {}) {
    const Result<GrayExchange> out = solve_gray_exchange(F, surfaces, surroundings, StopRequest());
    EXPECT_TRUE(out) << (out ? "" : out.error().message);
    return out ? *out : GrayExchange();
}

/// Concentric spheres of areas 1 and 4: Q = A_1 sigma (T_1^4 - T_2^4) / (1 / e_1 + A_1 / A_2 (1 / e_2 - 1)).
TEST(GrayExchange, BetweenConcentricSpheresIsTheClosedForm) {
    const SparseFactors F = table({1, 4}, {{0, 1}, {0.25, 0.75}});
    for (const double e1 : {0.05, 0.5, 1.0})
        for (const double e2 : {0.1, 0.8, 1.0}) {
            const GrayExchange out = solved(F, {{e1, 500.0}, {e2, 300.0}});
            const double Q = (black(500) - black(300)) / (1 / e1 + 0.25 * (1 / e2 - 1));
            EXPECT_NEAR(out.heat[0], Q, 1e-9 * Q);
            EXPECT_NEAR(out.heat[1], -Q, 1e-9 * Q);
        }
}

/// Two surfaces and a third that is adiabatic [Howell20]: a resistance of 1 / (A F_12 + 1 / (1 / (A F_13) + 1 / (A
/// F_23))).
TEST(GrayExchange, AnAdiabaticSurfaceReradiates) {
    const SparseFactors F = table({2, 2, 4}, {{0, 0.4, 0.6}, {0.4, 0, 0.6}, {0.3, 0.3, 0.4}});
    const double e1 = 0.7, e2 = 0.3;
    const GrayExchange out = solved(F, {{e1, 800.0}, {e2, 400.0}, {0.5, {}, 0.0}});
    const double between = 0.8 + 1 / (1 / 1.2 + 1 / 1.2);
    const double Q = (black(800) - black(400)) / ((1 - e1) / (2 * e1) + 1 / between + (1 - e2) / (2 * e2));
    EXPECT_NEAR(out.heat[0], Q, 1e-9 * Q);
    EXPECT_NEAR(out.heat[2], 0, 1e-9 * Q);
    EXPECT_GT(out.temperature[2], 400);
    EXPECT_LT(out.temperature[2], 800);
}

TEST(GrayExchange, GivenHeatLeadsToTheTemperatureThatHasIt) {
    const SparseFactors F = table({2, 2, 4}, {{0, 0.4, 0.6}, {0.4, 0, 0.6}, {0.3, 0.3, 0.4}});
    const GrayExchange first = solved(F, {{0.7, 800.0}, {0.3, 400.0}, {0.5, 350.0}});
    const GrayExchange again = solved(F, {{0.7, {}, first.heat[0]}, {0.3, 400.0}, {0.5, {}, first.heat[2]}});
    EXPECT_NEAR(again.temperature[0], 800, 1e-6);
    EXPECT_NEAR(again.temperature[2], 350, 1e-6);
}

TEST(GrayExchange, HeatsAddUpWithSurroundingsAndWithout) {
    const SparseFactors open = table({1, 1}, {{0, 0.2}, {0.2, 0}});
    const std::vector<ThermalSurface> surfaces{{0.6, 400.0}, {0.9, {}, 0.0}};
    const GrayExchange out = solved(open, surfaces, 250);
    EXPECT_GT(out.surroundings, 0);
    EXPECT_NEAR(out.heat[0] + out.heat[1], out.surroundings, 1e-9 * out.surroundings);
    // Rows that miss 0.1% by the factors' error lose nothing in an enclosure.
    const SparseFactors inexact = table({1, 4}, {{0, 0.999}, {0.24975, 0.7492}});
    const GrayExchange closed = solved(inexact, {{0.5, 500.0}, {0.5, 300.0}});
    EXPECT_NEAR(closed.heat[0] + closed.heat[1], 0, 1e-9 * closed.heat[0]);
}

TEST(GrayExchange, ExchangeFactorsAreReciprocalCloseAndGiveTheSameHeat) {
    const SparseFactors F = table({2, 2, 4}, {{0, 0.4, 0.6}, {0.4, 0, 0.6}, {0.3, 0.3, 0.4}});
    const std::vector<ThermalSurface> surfaces{{0.7, 800.0}, {0.3, 400.0}, {0.5, 350.0}};
    const auto f = exchange_factors(F, surfaces, {}, StopRequest());
    ASSERT_TRUE(f) << f.error().message;
    const GrayExchange direct = solved(F, surfaces);
    for (std::size_t i = 0; i < 3; ++i) {
        double heat = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            EXPECT_NEAR(F.areas[i] * (*f)[i][j], F.areas[j] * (*f)[j][i], 1e-10);
            heat += F.areas[i] * (*f)[i][j] * (black(*surfaces[i].temperature) - black(*surfaces[j].temperature));
        }
        EXPECT_NEAR(heat, direct.heat[i], 1e-8 * std::abs(direct.heat[0]));
        EXPECT_NEAR(std::accumulate((*f)[i].begin(), (*f)[i].end(), 0.0), surfaces[i].emissivity, 1e-10);
    }
}

TEST(GrayExchange, WhatIsWrongIsReported) {
    const SparseFactors F = table({1, 4}, {{0, 1}, {0.25, 0.75}});
    const auto message = [&](const std::vector<ThermalSurface>& surfaces) {
        const Result<GrayExchange> out = solve_gray_exchange(F, surfaces, {}, StopRequest());
        return out ? std::string() : out.error().message;
    };
    EXPECT_NE(message({{0.5, 300.0}}).find("1 surfaces for 2 rows"), std::string::npos);
    EXPECT_NE(message({{0, 300.0}, {0.5, 300.0}}).find("emissivity"), std::string::npos);
    EXPECT_NE(message({{0.5, -1.0}, {0.5, 300.0}}).find("out of range"), std::string::npos);
    EXPECT_NE(message({{0.5, {}, 0.0}, {0.5, {}, 10.0}}).find("nothing determines"), std::string::npos);
    const std::vector<ThermalSurface> warm{{0.5, 300.0}, {0.5, 400.0}};
    const auto open = solve_gray_exchange(table({1, 1}, {{0, 0.2}, {0.2, 0}}), warm, {}, StopRequest());
    ASSERT_FALSE(open);
    EXPECT_NE(open.error().message.find("2 of 2 surfaces see openings"), std::string::npos) << open.error().message;
    EXPECT_NE(message({{0.5, {}, -1e6}, {0.5, 300.0}}).find("absolute zero"), std::string::npos);
}

/// Number that follows a text in a message.
double number_after(const std::string& message, const std::string& text) {
    const std::size_t at = message.find(text);
    EXPECT_NE(at, std::string::npos) << message;
    return at == std::string::npos ? 0 : std::stod(message.substr(at + text.size()));
}

TEST(GrayExchange, AHeatThatCannotBeTakenUpIsReportedWithItsLimit) {
    // Surface 1 is adiabatic and would also be too cold, but the heat of surface 2 is at fault.
    const SparseFactors F = table({2, 2, 4}, {{0, 0.4, 0.6}, {0.4, 0, 0.6}, {0.3, 0.3, 0.4}});
    const auto heated = [&](double heat, double temperature) {
        return solve_gray_exchange(F, std::vector<ThermalSurface>{{0.9, {}, 0}, {0.5, {}, heat}, {0.5, temperature}},
                                   {}, StopRequest());
    };
    const auto excess = heated(-1e6, 300);
    ASSERT_FALSE(excess);
    EXPECT_EQ(excess.error().code, ErrorCode::bad_input);
    const double most =
        number_after(excess.error().message, "surface 2 cannot take up 1000000 W: at absolute zero it takes up ");
    EXPECT_GT(most, 0);
    EXPECT_NEAR(number_after(excess.error().hint, "give it a heat of "), -most, 1e-9 * most);
    // Both remedies help: a heat nearer to 0, and a hotter surface. A heat further from 0 does not.
    EXPECT_TRUE(heated(-most, 300));
    EXPECT_FALSE(heated(-1.001 * most, 300));
    EXPECT_TRUE(heated(-1.001 * most, 303));
    EXPECT_NEAR(heated(-most, 300)->temperature[1], 0, 100);
    // With surroundings, for two such surfaces: the message names one and counts the other.
    const auto two = solve_gray_exchange(F, std::vector<ThermalSurface>{{0.9, {}, -1e5}, {0.5, {}, -1e6}, {0.5, 300.0}},
                                         280, StopRequest());
    ASSERT_FALSE(two);
    EXPECT_NE(two.error().message.find("surface 2 cannot"), std::string::npos) << two.error().message;
    EXPECT_NE(two.error().message.find("(1 more"), std::string::npos) << two.error().message;
}

TEST(GrayExchange, AHeatThatMakesASurfaceHotterThanAnyMaterialIsReported) {
    const SparseFactors F = table({2, 2, 4}, {{0, 0.4, 0.6}, {0.4, 0, 0.6}, {0.3, 0.3, 0.4}});
    const auto out = solve_gray_exchange(F, std::vector<ThermalSurface>{{0.9, {}, 0}, {0.5, {}, 1e15}, {0.5, 300.0}},
                                         {}, StopRequest());
    ASSERT_FALSE(out);
    EXPECT_GT(number_after(out.error().message, "surface 2 would have "), 1e5);
    EXPECT_NE(out.error().hint.find("a smaller heat"), std::string::npos);
    EXPECT_TRUE(solve_gray_exchange(F, std::vector<ThermalSurface>{{0.9, {}, 0}, {0.5, {}, 1e9}, {0.5, 300.0}}, {},
                                    StopRequest()));
}

TEST(GrayExchange, EmissivitiesOfAnySizeHaveAResultOrAnError) {
    const SparseFactors F = table({2, 2, 4}, {{0, 0.4, 0.6}, {0.4, 0, 0.6}, {0.3, 0.3, 0.4}});
    for (const double e : {0.5, 1e-6, 1e-12, 1e-13, 1e-17, 1e-200, 1e-310, 0.0, -1e-310}) {
        const auto out =
            solve_gray_exchange(F, std::vector<ThermalSurface>{{e, {}, 0}, {e, 400.0}, {e, 300.0}}, {}, StopRequest());
        ASSERT_EQ(static_cast<bool>(out), e >= 1e-12) << e;
        if (!out) {
            EXPECT_NE(out.error().message.find("surface 1: emissivity"), std::string::npos) << e;
        } else if (e < 0.1) {
            EXPECT_GT(out->temperature[0], 300) << e;
            EXPECT_LT(out->temperature[0], 400) << e;
        }
    }
    // An adiabatic surface of small emissivity has the temperature of one of large emissivity.
    const auto adiabatic = [&](double e) {
        return solved(F, {{e, {}, 0.0}, {0.5, 400.0}, {0.5, 300.0}}).temperature[0];
    };
    EXPECT_NEAR(adiabatic(1e-12), adiabatic(0.9), 1e-9 * 400);
}

TEST(GrayExchange, HeatsOfAnySizeHaveAResultOrAnError) {
    const SparseFactors F = table({2, 2, 4}, {{0, 0.4, 0.6}, {0.4, 0, 0.6}, {0.3, 0.3, 0.4}});
    const auto heated = [&](double heat, double temperature) {
        return solve_gray_exchange(F, std::vector<ThermalSurface>{{0.9, {}, 0}, {0.5, {}, heat}, {0.5, temperature}},
                                   {}, StopRequest());
    };
    for (const double heat : {1e15, 1e80, 1e100, 1e101, 1e200, 1e308, double(HUGE_VAL), double(NAN)}) {
        const auto hot = heated(heat, 300), cold = heated(-heat, 300);
        ASSERT_FALSE(hot) << heat;
        ASSERT_FALSE(cold) << heat;
        const bool is_in_range = heat <= 1e100;
        EXPECT_NE(hot.error().message.find(is_in_range ? "would have" : "out of range"), std::string::npos) << heat;
        EXPECT_NE(cold.error().message.find(is_in_range ? "cannot take up" : "out of range"), std::string::npos)
            << heat;
    }
    // The balance is linear: a heat 10^-4k as large leads to temperatures 10^-k as large.
    const double usual = heated(1e3, 0)->temperature[1];
    for (const double k : {10, 30, 60}) {
        const auto small = heated(1e3 * std::pow(10, -4 * k), 0);
        ASSERT_TRUE(small);
        EXPECT_NEAR(small->temperature[1] * std::pow(10, k), usual, 1e-9 * usual) << k;
    }
}

}  // namespace
}  // namespace exitance
