#include "exitance/io/scenes/radiance/rad_sky_command.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "exitance/geometry/vec.hpp"

namespace exitance {
namespace {

CommandWords words_of(const std::string& line) {
    std::istringstream in(line);
    CommandWords out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

/// The numbers that follow a line, such as "solar source sun".
std::vector<double> numbers_after(const std::string& text, const std::string& line) {
    const std::size_t at = text.find(line);
    EXPECT_NE(at, std::string::npos) << text;
    if (at == std::string::npos) return std::vector<double>(16);
    std::istringstream in(text.substr(at + line.size()));
    int words = 0, count = 0;
    std::string word;
    in >> words;
    for (int i = 0; i < words; ++i) in >> word;
    in >> word >> count;
    std::vector<double> out(static_cast<std::size_t>(count));
    for (double& v : out) in >> v;
    return out;
}

std::string output(const std::string& line) {
    const Result<std::string> text = sky_command_output(words_of(line));
    EXPECT_TRUE(text) << (text ? "" : text.error().message);
    return text ? *text : "";
}

TEST(RadSkyCommand, GenskyPrintsWhatTheProgramPrints) {
    // A published run prints: light 6.73e+06, source 0.421409 -0.593560 0.685639, ground ambient level 14.6.
    const std::string text = output("gensky 3 20 10 -a 40 -o 98 -m 105 -g 1");
    const std::vector<double> light = numbers_after(text, "void light solar"), sun = numbers_after(text, "source sun");
    EXPECT_NEAR(light[0], 6.73e6, 0.005e6);
    EXPECT_NEAR(sun[0], 0.421409, 1e-6);
    EXPECT_NEAR(sun[1], -0.593560, 1e-6);
    EXPECT_NEAR(sun[2], 0.685639, 1e-6);
    EXPECT_EQ(sun[3], 0.5);
    const std::vector<double> sky = numbers_after(text, "skyfunc");
    ASSERT_EQ(sky.size(), 7u);
    EXPECT_EQ(sky[0], 1);
    EXPECT_NEAR(sky[2] - 6e-5 / pi * light[0] * sun[2], 14.6, 0.05);
}

TEST(RadSkyCommand, GenskyScalesItsSkyByWhatIsGiven) {
    EXPECT_NEAR(numbers_after(output("gensky -ang 45 0 -c -B 100"), "skyfunc")[1], 100 / (pi * 7 / 9), 1e-5);
    EXPECT_NEAR(numbers_after(output("gensky -ang 45 0 -u -B 100 -g 0.5"), "skyfunc")[2], 50 / pi, 1e-6);
    EXPECT_NEAR(numbers_after(output("gensky -ang 30 0 +s -R 300"), "void light solar")[0], 300 / (5.98e-5 * 0.5), 1);
    EXPECT_EQ(output("gensky -ang 30 0 -s").find("source sun"), std::string::npos);
    // Solar noon of an equinox or so: the sun stands in the south, at 90 degrees less the latitude.
    const std::vector<double> sun = numbers_after(output("gensky 3 22 +12 -a 40"), "source sun");
    EXPECT_NEAR(sun[0], 0, 1e-8);
    EXPECT_NEAR(std::asin(sun[2]) * 180 / pi, 50, 0.1);
    // A year's position is that of an almanac; the short formula lies within a degree of it.
    const std::vector<double> year = numbers_after(output("gensky 6 21 9:30EST -a 42 -o 71 -y 2021"), "source sun"),
                              plain = numbers_after(output("gensky 6 21 9.5 -a 42 -o 71 -m 75"), "source sun");
    EXPECT_GT(year[0] * plain[0] + year[1] * plain[1] + year[2] * plain[2], std::cos(pi / 180));
    EXPECT_NE(year[0], plain[0]);
}

TEST(RadSkyCommand, GendaylitHasPerezSky) {
    const std::string text = output("gendaylit -ang 40 30 -W 600 150 -O 1 -g 0");
    const std::vector<double> sky = numbers_after(text, "skyfunc"), light = numbers_after(text, "void light solar");
    ASSERT_EQ(sky.size(), 10u);
    EXPECT_NEAR(light[0] * 2 * pi * (1 - std::cos(0.2665 * pi / 180)), 600, 1e-5);
    EXPECT_EQ(sky[1], 0);
    // Clearness ((150 + 600) / 150 + k) / (1 + k), k = 1.041 (50 degrees)^3 = 0.6918: the fifth bin, to 4.5.
    const double Z = 50 * pi / 180, k = 1.041 * Z * Z * Z, clearness = (5 + k) / (1 + k);
    ASSERT_TRUE(clearness > 2.8 && clearness < 4.5);
    const double mass = 1 / (std::cos(Z) + 0.15 * std::pow(93.885 - 50, -1.253));
    const double day = 2 * pi * 149 / 365;
    const double orbit = 1.00011 + 0.034221 * std::cos(day) + 0.00128 * std::sin(day) + 0.000719 * std::cos(2 * day) +
                         0.000077 * std::sin(2 * day);
    const double delta = 150 * mass / (1367 * orbit);
    EXPECT_NEAR(sky[2], -1.0156 - 0.3670 * Z + delta * (1.0078 + 1.4051 * Z), 1e-7);
    EXPECT_NEAR(sky[5], -3.4 - 0.1078 * Z + delta * (-1.0750 + 1.5702 * Z), 1e-7);
    // The same state by its parameters.
    const std::vector<double> by_state = numbers_after(
        output("gendaylit -ang 40 30 -O 1 -P " + std::to_string(clearness) + " " + std::to_string(delta)), "skyfunc");
    EXPECT_NEAR(by_state[0], sky[0], 1e-3 * sky[0]);
    // Illuminances lead back to about the irradiances that they come from.
    const std::vector<double> lumens =
        numbers_after(output("gendaylit -ang 40 30 -W 600 150 -O 2"), "void light solar");
    const double direct = lumens[0] / light[0] * 600;
    EXPECT_NEAR(direct / 600, 95, 15);
}

TEST(RadSkyCommand, WhatIsNotReadIsNamed) {
    const auto fault = [](const std::string& line) {
        const Result<std::string> text = sky_command_output(words_of(line));
        return text ? "" : text.error().message + "|" + text.error().hint;
    };
    EXPECT_NE(fault("gensky 3 20").find("missing"), std::string::npos);
    EXPECT_NE(fault("gensky 13 20 12").find("'13 20'"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 25").find("no time"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12XYZ").find("no time"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12 -q").find("'-q'"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12 -a").find("-a needs"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12 -W 1 2").find("'-W'"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12").find("the light is missing"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12 -W 100").find("two numbers"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12 -W 100 0").find("above 0"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 +2 -W 100 10").find("below the horizon"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12 -E 300").find("--run-commands"), std::string::npos);
    EXPECT_NE(fault("gensky 2 30 12 -y 2021").find("no date"), std::string::npos);
    EXPECT_EQ(fault("gensky 3 20 12"), "");
}

}  // namespace
}  // namespace exitance
