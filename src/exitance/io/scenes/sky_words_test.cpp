#include "exitance/io/scenes/sky_words.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/io/files/atomic_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

std::string fault(const std::string& words) {
    const Result<ChosenSky> sky = parse_sky(words, nullptr);
    if (sky) return "none";
    EXPECT_EQ(sky.error().code, ErrorCode::usage);
    EXPECT_EQ(sky.error().where, "--sky");
    return sky.error().message;
}

std::string weather_text(const std::string& hours) {
    std::string text = "LOCATION,Town,-,CHE,test,0,47.4,8.5,1.0,400\n";
    for (int i = 0; i < 7; ++i) text += "HEADER\n";
    return text + hours;
}
std::string hour_text(int month, int day, int hour, const std::string& direct, const std::string& diffuse) {
    return "2021," + std::to_string(month) + "," + std::to_string(day) + "," + std::to_string(hour) +
           ",0,flags,10,5,70,95000,0,1300,300,500," + direct + "," + diffuse + ",0,0,0\n";
}

}  // namespace

TEST(SkyWords, MakeSkySunAndGround) {
    const Result<ChosenSky> sky =
        parse_sky("perez,lat=47.4,lon=8.5,tz=1,time=2021-06-21T12:30,dni=700,dhi=120,ground=0.25,north=10", nullptr);
    ASSERT_TRUE(sky) << sky.error().message;
    const DistantLight& light = sky->in_watts;
    ASSERT_EQ(light.domes.size(), 2u);
    ASSERT_EQ(light.discs.size(), 1u);
    EXPECT_EQ(light.domes[0].irradiance[0], 120);
    EXPECT_NEAR(light.discs[0].towards.z, std::sin(66.0 * pi / 180), 2e-3);
    EXPECT_NEAR(light.domes[1].irradiance[0], 0.25 * (120 + 700 * light.discs[0].towards.z), 1e-9);
    EXPECT_TRUE(light.domes[1].model.below);
    EXPECT_EQ(sky->in_lumens.domes[0].irradiance[0], 120 * efficacy_of_sky);
    EXPECT_FALSE(sky->photometric);
    for (const char* kind : {"uniform", "overcast", "cie1", "cie5"})
        EXPECT_TRUE(parse_sky(std::string(kind) + ",dhi=100", nullptr)) << kind;
    for (const char* kind : {"clear", "cie2", "cie15"})
        EXPECT_TRUE(parse_sky(std::string(kind) + ",dhi=100,altitude=30,azimuth=200", nullptr)) << kind;
}

TEST(SkyWords, ReportErrors) {
    EXPECT_EQ(fault("blue,dhi=1"), "'blue' is not a kind of sky");
    EXPECT_EQ(fault("cie16,dhi=1"), "'cie16' is not a kind of sky");
    EXPECT_EQ(fault("uniform"), "dhi, the irradiance of the ground by the sky, is missing");
    EXPECT_EQ(fault("uniform,dhi=x"), "dhi 'x' is not a number");
    EXPECT_EQ(fault("uniform,dhi=-1"), "dhi is -1, not from 0 to 1e+06 (diffuse horizontal irradiance, W/m^2)");
    EXPECT_EQ(fault("uniform,dhi=1,dhi=2"), "'dhi' is given twice");
    EXPECT_EQ(fault("uniform,dhi=1,cloud=2"), "'cloud' is not known");
    EXPECT_EQ(fault("uniform,dhi"), "'dhi' is not name=value");
    EXPECT_EQ(fault("uniform,dhi=0"), "this sky has no light");
    EXPECT_EQ(fault("perez,dhi=100,altitude=30,azimuth=0"),
              "dni, the irradiance by the sun of a plane that faces it, is missing");
    EXPECT_EQ(fault("perez,dhi=100,dni=0"), "where the sun stands is missing for perez");
    EXPECT_EQ(fault("clear,dhi=100,altitude=20"),
              "the sun is given by altitude and azimuth together, or by time and place");
    EXPECT_EQ(fault("clear,dhi=100,time=06-21T12:00"), "a time needs a place: lat and lon are missing");
    EXPECT_EQ(fault("clear,dhi=100,lat=1,lon=2,time=02-30T12:00"), "time '02-30T12:00' is not a valid date and time");
    EXPECT_EQ(fault("clear,dhi=100,lat=1,lon=2,time=noon"), "time 'noon' is not a valid date and time");
    EXPECT_EQ(fault("perez,dhi=10,dni=5,altitude=-20,azimuth=0"), "the sun is below the horizon, and dni is not 0");
}

TEST(WeatherFile, SuppliesPlaceAndIrradiances) {
    const TemporaryFolder folder;
    const std::string path = folder / "w.epw";
    ASSERT_TRUE(
        write_file(path, weather_text(hour_text(6, 21, 12, "650", "130") + hour_text(6, 21, 13, "9999", "9999"))));
    const Result<Weather> weather = load_epw(path);
    ASSERT_TRUE(weather) << weather.error().message;
    EXPECT_EQ(weather->place.latitude, 47.4);
    EXPECT_EQ(weather->zone, 1);
    ASSERT_EQ(weather->hours.size(), 2u);
    EXPECT_EQ(weather->hours[0].direct_normal, 650);
    EXPECT_TRUE(weather->hours[1].is_missing);
    const Result<ChosenSky> sky = parse_sky("perez,time=06-21T11:30", &*weather);
    ASSERT_TRUE(sky) << sky.error().message;
    EXPECT_EQ(sky->in_watts.domes[0].irradiance[0], 130);
    EXPECT_EQ(sky->in_watts.discs[0].irradiance[0], 650);
    EXPECT_FALSE(parse_sky("perez,time=06-21T12:30", &*weather)) << "the hour is missing";
    EXPECT_FALSE(parse_sky("perez,time=06-22T11:30", &*weather));
    EXPECT_FALSE(parse_sky("perez", &*weather));
}

TEST(WeatherFile, LeapDaysAndMissingIrradiancesAreHandled) {
    const TemporaryFolder folder;
    const std::string path = folder / "w.epw";
    std::string no_diffuse = hour_text(6, 21, 12, "600", "9999"), no_direct = hour_text(6, 21, 13, "9999", "120");
    const auto with_global = [](std::string line, const char* global) {
        std::size_t at = 0;
        for (int i = 0; i < 13; ++i) at = line.find(',', at) + 1;
        return line.replace(at, line.find(',', at) - at, global);
    };
    ASSERT_TRUE(write_file(
        path, weather_text(hour_text(2, 29, 12, "500", "100") + with_global(no_diffuse, "640") +
                           with_global(no_direct, "650") + with_global(hour_text(6, 21, 14, "9999", "9999"), "600"))));
    const Result<Weather> weather = load_epw(path);
    ASSERT_TRUE(weather) << weather.error().message;
    ASSERT_EQ(weather->hours.size(), 4u);
    EXPECT_EQ(weather->hours[0].day, 29);
    EXPECT_TRUE(parse_sky("perez,time=02-29T11:30", &*weather));
    const auto sine = [&](std::size_t i) {
        const WeatherHour& hour = weather->hours[i];
        return std::sin(sun_position(hour.middle(weather->zone), weather->place).altitude * pi / 180);
    };
    EXPECT_NEAR(weather->hours[1].diffuse_horizontal, 640 - 600 * sine(1), 1e-9);
    EXPECT_NEAR(weather->hours[2].direct_normal, (650 - 120) / sine(2), 1e-9);
    EXPECT_FALSE(weather->hours[1].is_missing || weather->hours[2].is_missing);
    EXPECT_TRUE(weather->hours[3].is_missing);
}

TEST(WeatherFile, ErrorsNameTheirLine) {
    const TemporaryFolder folder;
    const std::string path = folder / "w.epw";
    const auto first = [&](const std::string& text) {
        EXPECT_TRUE(write_file(path, text));
        const Result<Weather> weather = load_epw(path);
        return weather ? std::string("none") : weather.error().where.substr(weather.error().where.rfind('/') + 1);
    };
    EXPECT_EQ(first("hello\n"), "w.epw:1");
    EXPECT_EQ(first(weather_text("2021,13,1,1,0,f,1,2,3,4,5,6,7,8,9,10,11\n")), "w.epw:9");
    EXPECT_EQ(first(weather_text("2021,1,1\n")), "w.epw:9");
    EXPECT_EQ(first(weather_text(hour_text(1, 1, 25, "1", "1"))), "w.epw:9");
    EXPECT_EQ(first(weather_text(hour_text(1, 1, 1, "x", "1"))), "w.epw:9");
    EXPECT_EQ(first(weather_text(hour_text(1, 1, 1, "1", "1") + hour_text(1, 1, 1, "1", "1"))), "w.epw:10");
    EXPECT_NE(first(weather_text("")), "none");
    EXPECT_FALSE(load_epw(folder / "none.epw"));
}

}  // namespace exitance
