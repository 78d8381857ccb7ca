#include "exitance/base/distinct_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace exitance {
namespace {

void expect_texts(const NumberTexts& texts, const std::string& first, const std::string& second) {
    EXPECT_EQ(texts.first, first);
    EXPECT_EQ(texts.second, second);
}

TEST(DistinctNumbers, HaveTheRequestedDigitsIfTheseDiffer) {
    expect_texts(distinct_texts(5.4321, 2, 2), "5.4", "2");
    expect_texts(distinct_percents(0.054321, 0.02), "5.43", "2");
    expect_texts(distinct_texts(1.5e-7, 1e-7, 2), "1.5e-07", "1e-07");
}

TEST(DistinctNumbers, HaveMoreDigitsIfTheyWouldLookEqual) {
    expect_texts(distinct_percents(0.0204, 0.02, 2), "2.04", "2");
    expect_texts(distinct_percents(0.02000004, 0.02, 2), "2.000004", "2");
    expect_texts(distinct_texts(1e-7 * (1 + 1e-5), 1e-7), "1.00001e-07", "1e-07");
}

TEST(DistinctNumbers, HaveAllDigitsBeforeTheDecimalPoint) {
    expect_texts(distinct_texts(12345.2, 12001), "12345", "12001");
    expect_texts(distinct_texts(12345.2, 12345), "12345.2", "12345");
    expect_texts(distinct_percents(12.5, 0.02), "1250", "2");
    expect_texts(distinct_texts(999.7, 500), "999.7", "500");
}

TEST(DistinctNumbers, NeighbouringNumbersHaveDifferentTextsInTheirOrder) {
    for (double x = 1e-12; x < 1e12; x *= 1.7) {
        for (const double y : {std::nextafter(x, HUGE_VAL), x * (1 + 1e-10), x * (1 + 1e-4)}) {
            const NumberTexts texts = distinct_texts(y, x, 2), percents = distinct_percents(y, x, 2);
            EXPECT_GT(std::stod(texts.first), std::stod(texts.second)) << x;
            EXPECT_GT(std::stod(percents.first), std::stod(percents.second)) << x;
        }
    }
}

TEST(DistinctNumbers, EqualAndUnusualNumbersHaveATextAsWell) {
    expect_texts(distinct_percents(0.02, 0.02, 2), "2", "2");
    expect_texts(distinct_texts(0, -0.0), "0", "-0");
    expect_texts(distinct_texts(HUGE_VAL, 1e300), "inf", "1e+300");
    EXPECT_EQ(distinct_texts(std::numeric_limits<double>::quiet_NaN(), 2).first, "nan");
}

}  // namespace
}  // namespace exitance
