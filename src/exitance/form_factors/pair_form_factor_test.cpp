#include "exitance/form_factors/pair_form_factor.hpp"
#include "support/places.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace exitance {
namespace {

using Outline = std::vector<Point>;

Outline square(double z, bool up) {
    Outline p = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
    if (!up) p = {p[0], p[3], p[2], p[1]};
    return p;
}

TEST(PairFormFactor, OpposedUnitSquaresAtDistanceOne) {
    EXPECT_NEAR(pair_form_factor(square(0, true), square(1, false)), 0.1998248956983874, 1e-14);
}

TEST(PairFormFactor, PerpendicularUnitSquaresSharingAnEdge) {
    const Outline wall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};  // the wall's front faces +x
    EXPECT_NEAR(pair_form_factor(square(0, true), wall), 0.2000437760754032, 1e-13);
}

TEST(PairFormFactor, PerpendicularSquaresWhoseEdgesOverlapInPartAddUpToTheWhole) {
    const Outline wall = {{0, 0.37, 0}, {0, 1.37, 0}, {0, 1.37, 1}, {0, 0.37, 1}};
    const Outline low = {{0, 0.37, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0.37, 1}};
    const Outline high = {{0, 1, 0}, {0, 1.37, 0}, {0, 1.37, 1}, {0, 1, 1}};
    const double whole = exchange_area(square(0, true), wall);
    const double parts = exchange_area(square(0, true), low) + exchange_area(square(0, true), high);
    EXPECT_NEAR(whole / parts, 1, 1e-12);  // both results have a tolerance of 1e-12
}

TEST(PairFormFactor, IsZeroBehindOrInThePlaneOfTheOther) {
    EXPECT_EQ(pair_form_factor(square(0, true), square(1, true)), 0);
    EXPECT_EQ(pair_form_factor(square(0, false), square(1, false)), 0);
    const Outline beside = {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
    EXPECT_EQ(pair_form_factor(square(0, true), beside), 0);
}

TEST(PairFormFactor, RowsOfAClosedBoxSumToOne) {
    const double a = 5, b = 4, c = 3;
    const std::array<Outline, 6> faces = {{{{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}},
                                           {{0, 0, c}, {0, b, c}, {a, b, c}, {a, 0, c}},
                                           {{0, 0, 0}, {0, 0, c}, {a, 0, c}, {a, 0, 0}},
                                           {{0, b, 0}, {a, b, 0}, {a, b, c}, {0, b, c}},
                                           {{0, 0, 0}, {0, b, 0}, {0, b, c}, {0, 0, c}},
                                           {{a, 0, 0}, {a, 0, c}, {a, b, c}, {a, b, 0}}}};
    for (const Outline& receiver : faces) {
        double sum = 0;
        for (const Outline& source : faces) sum += pair_form_factor(receiver, source);
        EXPECT_NEAR(sum, 1, 5e-12);  // five entries, each with a tolerance of 1e-12
    }
}

TEST(PairFormFactor, AreaAndContourRulesAgreeAtTheirBoundary) {
    // Just inside ten sizes the contour integral is used, just outside quadrature points: both have an error of about
    // 1e-11 there.
    const Outline floor = square(0, true);
    for (double z : {28.2, 28.4}) {
        const double F = pair_form_factor(floor, square(z, false));
        const double X = 1 / z, q = std::sqrt(1 + X * X);  // identical squares, closed form
        const double exact =
            2 / (pi * X * X) *
            (std::log(q * q / std::sqrt(1 + 2 * X * X)) + 2 * X * q * std::atan(X / q) - 2 * X * std::atan(X));
        EXPECT_NEAR(F / exact, 1, 1e-8) << z;  // the closed form itself loses 1/X^4 of its digits
    }
}

/// A random triangle or quadrilateral in a random plane.
Outline random_outline(const std::array<int, 12>& v, const Point& shift) {
    const auto at = [&](int i) { return 0.01 * (v[static_cast<std::size_t>(i)] % 100); };
    const Point o = Point{at(0), at(1), at(2)} + shift;
    const Vec3 a = {at(3) + 0.3, at(4), at(5)}, b = {-at(6), at(7) + 0.3, at(8)};
    return {o, o + a, o + a + (0.5 + 0.5 * at(9)) * b, o + b};
}

TEST(PairFormFactorProperties, ExchangeIsReciprocalAndAdditiveUnderCuts) {
    rc::check([](const std::array<int, 12>& first, const std::array<int, 12>& second, int place) {
        auto low = first, high = second;
        for (int& v : low) v = std::abs(v % 100);
        for (int& v : high) v = std::abs(v % 100);
        const Outline receiver = random_outline(low, {0, 0, 0});
        Outline source = random_outline(high, {0.1, 0.2, 1.5});
        std::reverse(source.begin(), source.end());
        const double whole = exchange_area(receiver, source);
        // The two orders integrate over different edges; each has a tolerance of 1e-12.
        RC_ASSERT(std::abs(whole - exchange_area(source, receiver)) <= 1e-11 * whole + 1e-15);
        const double t = 0.1 + 0.8 * std::abs(place % 100) / 100.0;
        const Point p = source[0] + t * (source[1] - source[0]), q = source[3] + t * (source[2] - source[3]);
        const double parts = exchange_area(receiver, Outline{source[0], p, q, source[3]}) +
                             exchange_area(receiver, Outline{p, source[1], source[2], q});
        RC_ASSERT(std::abs(whole - parts) <= 1e-11 * whole + 1e-15);
    });
}

TEST(PairFormFactor, PolygonsWithTinyEdgesTakeNoLongTime) {
    // For an edge of a micrometre the inner integral is a difference of numbers of order one. If the tolerance were
    // below its rounding error, bisection would take hours.
    for (const double tiny : {1e-3, 1e-5, 1e-7}) {
        const Outline receiver = {{0, 0, 0}, {1, 0.1, 0}, {1, 0.1 + tiny, 0}, {0.3, 1.1, 0}, {0, 1, 0}};
        const Outline source = {{0.1, 1, 1.2}, {0.8 + tiny, 0.9, 1.2}, {0.8, 0.9, 1.2}, {0.9, 0, 1.2}, {0.2, 0.1, 1.2}};
        const double area = exchange_area(receiver, source, 1e-14);
        EXPECT_GT(area, 0.05);
        EXPECT_NEAR(area, exchange_area(source, receiver, 1e-14), 1e-11 * area);
    }
}

Outline outline_of(const nlohmann::json& json) {
    Outline outline;
    for (const auto& v : json) outline.push_back({v[0], v[1], v[2]});
    return outline;
}

TEST(PairFormFactor, ReproducesThePublishedUnoccludedPairs) {
    std::ifstream file(test::data_folder() + "/reference/view_factors.json");
    const nlohmann::json table = nlohmann::json::parse(file);
    for (const auto& c : table["cases"]) {
        if (c["kind"] != "polygon-polygon" || !c["occluders"].empty()) continue;
        const double exact = std::stod(c["F_ab_digits"].get<std::string>());
        const Outline a = outline_of(c["a"]), b = outline_of(c["b"]);
        EXPECT_NEAR(pair_form_factor(a, b) / exact, 1, 1e-9) << c["id"];
        EXPECT_NEAR(pair_form_factor(b, a) / c["F_ba"].get<double>(), 1, 1e-9) << c["id"];
        EXPECT_NEAR(pair_form_factor(a, b, 1e-5) / exact, 1, 2e-5) << c["id"];  // the comparison is an estimate
    }
}

}  // namespace
}  // namespace exitance
