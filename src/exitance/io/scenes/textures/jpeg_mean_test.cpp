#include <gtest/gtest.h>

#include <string_view>

#include "exitance/io/scenes/textures/texture_mean.hpp"

namespace exitance {
namespace {

// A picture of 16 x 16 pixels in four squares, each of one colour: red and blue are 200 and 40 on the left, 40 and 200
// on the right; green is 100 above and 60 below. Written with quality 100, once with one scan and once with ten.
constexpr std::string_view baseline =
    "ffd8ffdb0043000101010101010101010101010101010101010101010101010101010101010101010101010101010101"
    "0101010101010101010101010101010101010101010101ffc00011080010001003011100021100031100ffc400150001"
    "0100000000000000000000000000000608ffc40014100100000000000000000000000000000000ffc400150101010000"
    "0000000000000000000000000a09ffc40014110100000000000000000000000000000000ffda000c0301000211031100"
    "3f002e90eb7083cd6045ce043cdc1079ac08bbffd9";
constexpr std::string_view progressive =
    "ffd8ffdb0043000101010101010101010101010101010101010101010101010101010101010101010101010101010101"
    "0101010101010101010101010101010101010101010101ffc20011080010001003011100021100031100ffc400150001"
    "0100000000000000000000000000000507ffc4001501010100000000000000000000000000000908ffda000c03010002"
    "1003100000012e43b720ed6116e10edc41dac22fffc40014100100000000000000000000000000000020ffda00080101"
    "000105021fffc40014110100000000000000000000000000000020ffda0008010301013f011fffc40014110100000000"
    "000000000000000000000020ffda0008010201013f011fffc40014100100000000000000000000000000000020ffda00"
    "08010100063f021fffc40014100100000000000000000000000000000020ffda0008010100013f211fffda000c030100"
    "02000300000010000fffc40014110100000000000000000000000000000020ffda0008010301013f101fffc400141101"
    "00000000000000000000000000000020ffda0008010201013f101fffc400141001000000000000000000000000000000"
    "20ffda0008010100013f101fffd9";

std::vector<std::uint8_t> bytes_of(std::string_view hex) {
    std::vector<std::uint8_t> out;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        out.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    return out;
}

TEST(MeanColour, IsEqualForProgressiveAndBaselineJpeg) {
    for (const std::string_view hex : {baseline, progressive}) {
        const Result<std::array<double, 3>> mean = mean_colour(bytes_of(hex), linear_curve());
        ASSERT_TRUE(mean);
        constexpr double step = 1.5 / 255;  // rounding in another colour space
        EXPECT_NEAR((*mean)[0], 120.0 / 255, step);
        EXPECT_NEAR((*mean)[1], 80.0 / 255, step);
        EXPECT_NEAR((*mean)[2], 120.0 / 255, step);
    }
}

TEST(MeanColour, OfATruncatedJpegIsAnErrorOrAColour) {
    const std::vector<std::uint8_t> whole = bytes_of(progressive);
    for (std::size_t length = 0; length < whole.size(); length += 7) {
        const Result<std::array<double, 3>> mean = mean_colour(std::span(whole).first(length), linear_curve());
        if (!mean) continue;
        for (const double c : *mean) EXPECT_TRUE(c >= 0 && c <= 1);
    }
}

}  // namespace
}  // namespace exitance
