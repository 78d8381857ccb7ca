#include "exitance/io/scenes/radiance/rad_sky_command.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "exitance/base/vec.hpp"
#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {
namespace {

CommandWords words_of(const std::string& line) {
    std::istringstream in(line);
    CommandWords out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

/// Returns the numbers after a line such as "solar source sun".
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

std::string output(const std::string& line, bool older = false) {
    const Result<PrintedSky> printed = sky_command_output(words_of(line), older);
    EXPECT_TRUE(printed) << (printed ? "" : printed.error().message);
    return printed ? printed->text : "";
}

std::vector<std::string> warnings(const std::string& line) {
    const Result<PrintedSky> printed = sky_command_output(words_of(line));
    EXPECT_TRUE(printed) << (printed ? "" : printed.error().message);
    return printed ? printed->warnings : std::vector<std::string>();
}

/// Factor of solar irradiance from the Earth's distance on a day of the year.
double orbit(double day) {
    const double angle = 2 * pi * (day - 1) / 365;
    return 1.00011 + 0.034221 * std::cos(angle) + 0.00128 * std::sin(angle) + 0.000719 * std::cos(2 * angle) +
           0.000077 * std::sin(2 * angle);
}

TEST(RadSkyCommand, GenskyAgreesWithTheProgram) {
    // The program of 2021 printed these values, with four digits.
    const std::string text = output("gensky 12 09 14:00 -a 51 -o 0 -m 0");
    const std::vector<double> light = numbers_after(text, "void light solar"), sun = numbers_after(text, "source sun");
    EXPECT_NEAR(light[0], 2.629e6, 0.5e3);
    EXPECT_NEAR(sun[0], -0.488361, 1e-6);
    EXPECT_NEAR(sun[1], -0.852180, 1e-6);
    EXPECT_NEAR(sun[2], 0.187862, 1e-6);
    EXPECT_EQ(sun[3], 0.5);
    const std::vector<double> sky = numbers_after(text, "skyfunc");
    ASSERT_EQ(sky.size(), 7u);
    EXPECT_EQ(sky[0], 1);
    EXPECT_NEAR(sky[1], 3.343, 5e-4);
    EXPECT_NEAR(sky[2], 3.429, 5e-4);
    EXPECT_NEAR(sky[3], 0.2971, 5e-5);
    EXPECT_TRUE(warnings("gensky 12 09 14:00 -a 51 -o 0 -m 0").empty());
}

TEST(RadSkyCommand, OlderGenskyAgreesWithThatProgram) {
    // A published run of the older program printed light 6.73e+06, this sun, and ground ambient level 14.6.
    const std::string text = output("gensky 3 20 10 -a 40 -o 98 -m 105 -g 1", true);
    const std::vector<double> light = numbers_after(text, "void light solar"), sun = numbers_after(text, "source sun");
    EXPECT_NEAR(light[0], 6.73e6, 0.005e6);
    EXPECT_NEAR(sun[0], 0.421409, 1e-6);
    EXPECT_NEAR(sun[1], -0.593560, 1e-6);
    EXPECT_NEAR(sun[2], 0.685639, 1e-6);
    const std::vector<double> sky = numbers_after(text, "skyfunc");
    ASSERT_EQ(sky.size(), 7u);
    EXPECT_NEAR(sky[2] - 6e-5 / pi * light[0] * sun[2], 14.6, 0.05);
    // The declinations of the two programs differ in the period of the sine, 368 and 365 days. At solar noon, the sun's
    // altitude is 90 degrees - latitude + declination.
    const auto noon = [](bool older) {
        return std::asin(numbers_after(output("gensky 10 23 +12 -a 20", older), "source sun")[2]);
    };
    const double day = 296 - 81;
    EXPECT_NEAR(noon(false), 70 * pi / 180 + 0.4093 * std::sin(2 * pi / 365 * day), 1e-8);
    EXPECT_NEAR(noon(true), 70 * pi / 180 + 0.4093 * std::sin(2 * pi / 368 * day), 1e-8);
}

TEST(RadSkyCommand, AYearSelectsTheAlmanacPosition) {
    // The two algorithms agree within 0.02 degrees (the almanac's error is 0.01 without refraction).
    for (const int year : {1960, 1999, 2021, 2024})
        for (const double hour : {8.0, 12.25, 16.5}) {
            const std::string date = "gensky 3 1 " + std::to_string(hour);
            const std::vector<double> sun =
                numbers_after(output(date + " -a -33 -o -151 -m -150 -y " + std::to_string(year)), "source sun");
            const SunPosition at = sun_position({year, 3, 1, hour, 10}, {-33, 151, 0, 0, 12});
            const Normal right = sky_direction(at.altitude, at.azimuth);
            EXPECT_GT(sun[0] * right.x + sun[1] * right.y + sun[2] * right.z, std::cos(0.02 * pi / 180)) << hour;
        }
    // With solar time, only the declination depends on the year.
    const std::vector<double> noon = numbers_after(output("gensky 6 21 +12 -a 45 -y 2021"), "source sun");
    EXPECT_NEAR(std::asin(noon[2]) * 180 / pi, 45 + 23.44, 0.01);
    EXPECT_NEAR(noon[0], 0, 1e-8);
}

TEST(RadSkyCommand, GenskyScalesItsSkyByTheOptions) {
    EXPECT_NEAR(numbers_after(output("gensky -ang 45 0 -c -B 100"), "skyfunc")[1], 100 / (pi * 7 / 9), 1e-5);
    EXPECT_NEAR(numbers_after(output("gensky -ang 45 0 -u -B 100 -g 0.5"), "skyfunc")[2], 50 / pi, 1e-6);
    EXPECT_NEAR(numbers_after(output("gensky -ang 30 0 +s -R 300"), "void light solar")[0], 300 / (5.98e-5 * 0.5), 1);
    EXPECT_EQ(output("gensky -ang 30 0 -s").find("source sun"), std::string::npos);
    // Solar noon near the equinox: the sun is in the south, at 90 degrees minus the latitude.
    const std::vector<double> sun = numbers_after(output("gensky 3 22 +12 -a 40"), "source sun");
    EXPECT_NEAR(sun[0], 0, 1e-8);
    EXPECT_NEAR(std::asin(sun[2]) * 180 / pi, 50, 0.1);
    // With a year, the position is the almanac's; the short formula agrees within a degree.
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
    // The clearness is ((150 + 600) / 150 + k) / (1 + k) with k = 1.041 (50 degrees)^3 = 0.6918, in the fifth bin (up
    // to 4.5).
    const double Z = 50 * pi / 180, k = 1.041 * Z * Z * Z, clearness = (5 + k) / (1 + k);
    ASSERT_TRUE(clearness > 2.8 && clearness < 4.5);
    const double mass = 1 / (std::cos(Z) + 0.15 * std::pow(93.885 - 50, -1.253));
    const double delta = 150 * mass / (1367 * orbit(0));  // the program uses day 0 if there is no date
    EXPECT_NEAR(sky[2], -1.0156 - 0.3670 * Z + delta * (1.0078 + 1.4051 * Z), 1e-7);
    EXPECT_NEAR(sky[5], -3.4 - 0.1078 * Z + delta * (-1.0750 + 1.5702 * Z), 1e-7);
    // Specifies the same state of the sky by its parameters.
    const std::vector<double> by_state = numbers_after(
        output("gendaylit -ang 40 30 -O 1 -P " + std::to_string(clearness) + " " + std::to_string(delta)), "skyfunc");
    EXPECT_NEAR(by_state[0], sky[0], 1e-3 * sky[0]);
    // Illuminances computed from irradiances agree approximately with the original irradiances.
    const std::vector<double> lumens =
        numbers_after(output("gendaylit -ang 40 30 -W 600 150 -O 2"), "void light solar");
    const double direct = lumens[0] / light[0] * 600;
    EXPECT_NEAR(direct / 600, 95, 15);
}

TEST(RadSkyCommand, GendaylitUsesDayZeroForAngles) {
    // With -P, irradiances are proportional to extraterrestrial irradiance, so their ratio is that of the orbit
    // factors.
    const auto scale = [](const std::string& line, bool older) {
        return numbers_after(output(line, older), "skyfunc")[0];
    };
    const double today = scale("gendaylit -ang 60 10 -P 6.3 0.12", false),
                 older = scale("gendaylit -ang 60 10 -P 6.3 0.12", true);
    EXPECT_NEAR(today / older, orbit(0) / orbit(150), 1e-7);
    EXPECT_GT(today / older, 1.06);
    EXPECT_EQ(scale("gendaylit 5 30 +10 -a 40 -P 6.3 0.12", false) > 0, true);
}

TEST(RadSkyCommand, GendaylitPrintsSkiesOfNightHours) {
    // A sun below the horizon is treated as on the horizon for the state and the sky's coefficients; its direction is
    // unchanged.
    const std::string line = "gendaylit -ang -7 80 -W 0 23";
    const std::vector<double> sky = numbers_after(output(line), "skyfunc");
    ASSERT_EQ(sky.size(), 10u);
    EXPECT_NEAR(sky[9], std::sin(-7 * pi / 180), 1e-8);
    const double delta = 23 / (0.15 * std::pow(93.885 - 90, -1.253) * 1367 * orbit(0)), Z = pi / 2;
    ASSERT_TRUE(delta > 0.01 && delta < 0.6);
    EXPECT_NEAR(sky[2], 1.3525 - 0.2576 * Z + delta * (-0.2690 - 1.4366 * Z), 1e-8);
    EXPECT_TRUE(warnings(line).empty());
    // The illuminance is the irradiance times the efficacy of [Perez90], over 179 lm/W. The program replaces the
    // integral over the sky by a sum over 145 directions and puts the sun on the horizon: a difference of 6%.
    SkyModel model;
    model.a = sky[2], model.b = sky[3], model.c = sky[4], model.d = sky[5], model.e = sky[6];
    model.sun = {sky[7], sky[8], sky[9]};
    const double irradiance = pi * sky[0] * horizontal_mean(model);
    EXPECT_NEAR(irradiance, 23 * (97.24 - 2 * 0.46 - 8.91 * std::log(delta)) / 179, 0.08 * irradiance);
    // Dates with an hour before sunrise or after sunset have no light, with a warning.
    for (const char* dark :
         {"gendaylit 3 20 +2 -a 40 -W 100 10", "gendaylit 12 1 +22 -a 40 -P 2 0.1", "gendaylit -ang -1 0 -G 100 10",
          "gendaylit -ang -1 0 -E 100", "gendaylit -ang 30 0 -W 0 0", "gendaylit -ang 30 0 -W 1400 100",
          "gendaylit -ang 30 0 -L 0 0"}) {
        EXPECT_EQ(numbers_after(output(dark), "skyfunc")[0], 0) << dark;
        EXPECT_EQ(output(dark).find("source sun"), std::string::npos) << dark;
        ASSERT_EQ(warnings(dark).size(), 1u) << dark;
        EXPECT_NE(warnings(dark)[0].find("no light"), std::string::npos);
    }
    // With an interval, the hour of sunrise is replaced by the middle of its daylight: sunrise is at 6 h at the
    // equinox.
    EXPECT_TRUE(warnings("gendaylit 3 22 +5.75 -a 40 -W 50 40 -i 60").empty());
    EXPECT_EQ(warnings("gendaylit 3 22 +5.25 -a 40 -W 50 40 -i 60").size(), 1u);
    const double rising = numbers_after(output("gendaylit 3 22 +5.75 -a 40 -W 50 40 -i 60"), "skyfunc")[9];
    // Daylight is from 6 to 6.25 h.
    EXPECT_NEAR(std::asin(rising) * 180 / pi, 0.125 * 15 * std::cos(40 * pi / 180), 0.05);
}

TEST(RadSkyCommand, GendaylitSupportsGlobalLightAndDewPoint) {
    // For k = 0.2, below 0.22, the diffuse share is 1 - 0.09 k [Erbs82].
    // extraterrestrial irradiance of a horizontal plane, with the sun at 30 degrees
    const double outside = 1367 * orbit(0) * 0.5;
    const std::string global = std::to_string(0.2 * outside);
    const std::vector<double> split = numbers_after(output("gendaylit -ang 30 0 -O 1 -E " + global), "skyfunc");
    const double diffuse = 0.2 * outside * (1 - 0.09 * 0.2), direct = (0.2 * outside - diffuse) / 0.5;
    const std::vector<double> same = numbers_after(
        output("gendaylit -ang 30 0 -O 1 -W " + std::to_string(direct) + " " + std::to_string(diffuse)), "skyfunc");
    for (std::size_t i = 0; i < same.size(); ++i) EXPECT_NEAR(split[i], same[i], 1e-5 * (1 + std::abs(same[i])));
    // More water in the air gives more lumens per watt of diffuse light [Perez90], but no change in watts (-O 1).
    const auto scale = [](const std::string& line) { return numbers_after(output(line), "skyfunc")[0]; };
    EXPECT_GT(scale("gendaylit -ang 40 0 -W 500 150 -d 20"), 1.01 * scale("gendaylit -ang 40 0 -W 500 150 -d 0"));
    EXPECT_EQ(scale("gendaylit -ang 40 0 -W 500 150 -O 1 -d 20"), scale("gendaylit -ang 40 0 -W 500 150 -O 1"));
    EXPECT_EQ(output("gendaylit -ang 40 0 -W 500 150 -c").find("source sun"), std::string::npos);
    // If diffuse light is zero, only the sun is left.
    const std::string sun_alone = output("gendaylit -ang 40 0 -O 1 -W 500 0");
    EXPECT_EQ(numbers_after(sun_alone, "skyfunc")[0], 0);
    EXPECT_NE(sun_alone.find("source sun"), std::string::npos);
}

TEST(RadSkyCommand, UnsupportedWordsAreNamed) {
    const auto fault = [](const std::string& line) {
        const Result<PrintedSky> text = sky_command_output(words_of(line));
        return text ? "" : text.error().message + "|" + text.error().hint;
    };
    EXPECT_NE(fault("gensky 3 20").find("missing"), std::string::npos);
    EXPECT_NE(fault("gensky 13 20 12").find("'13 20'"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 25").find("not a time"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12XYZ").find("not a time"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12 -q").find("'-q'"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12 -a").find("-a needs"), std::string::npos);
    EXPECT_NE(fault("gensky 3 20 12 -W 1 2").find("'-W'"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12").find("the light is missing"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12 -W 100").find("two numbers"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12:30 -W 100 10").find("ignores them"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12EST -W 100 10").find("-m"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 24 -W 100 10").find("below 24"), std::string::npos);
    EXPECT_NE(fault("gendaylit 3 20 12 -C -W 1 2").find("--run-commands"), std::string::npos);
    EXPECT_NE(fault("gensky 2 30 12 -y 2021").find("not a date"), std::string::npos);
    EXPECT_EQ(fault("gensky 3 20 12"), "");
}

}  // namespace
}  // namespace exitance
