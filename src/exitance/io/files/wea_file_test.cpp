#include "exitance/io/files/wea_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

Result<Weather> read(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder / "w.wea") << text;
    return load_weather(folder / "w.wea");
}

const std::string header = "place Zurich Town\nlatitude 47.4\nlongitude -8.5\ntime_zone -15\nsite_elevation 400\n";

}  // namespace

TEST(WeaFile, PlaceZoneAndHoursAreRead) {
    const Result<Weather> w =
        read(header + "weather_data_file_units 1\n6 21 11.500 700 120\n6 21 12.250 600 100\n6 21 12.750 400 140\n");
    ASSERT_TRUE(w) << w.error().message;
    EXPECT_EQ(w->city, "Zurich Town");
    EXPECT_EQ(w->place.longitude, 8.5);
    EXPECT_EQ(w->place.elevation, 400);
    EXPECT_EQ(w->zone, 1);
    ASSERT_EQ(w->hours.size(), 2u);
    EXPECT_EQ(w->hours[0].hour, 12);
    EXPECT_EQ(w->hours[0].direct_normal, 700);
    EXPECT_EQ(w->hours[1].direct_normal, 500);  // the mean of two half hours
    EXPECT_EQ(w->hours[1].diffuse_horizontal, 120);
}

TEST(WeaFile, IlluminancesBecomeIrradiances) {
    const Result<Weather> w = read(header + "weather_data_file_units 2\r\n1 1 0.5 0 -1\r\n6 21 11.5 70000 14400\r\n");
    ASSERT_TRUE(w) << w.error().message;
    EXPECT_EQ(w->hours[1].direct_normal, 700);
    EXPECT_EQ(w->hours[1].diffuse_horizontal, 120);
    EXPECT_EQ(w->warnings.size(), 1u);
}

/// Lines of ten minutes from the first time of each day on, for some days of a month.
std::string ten_minutes(int month, int first_day, int last_day, double first) {
    std::string out;
    for (int day = first_day; day <= last_day; ++day)
        for (int i = 0; i < 144; ++i) out += fmt::format("{} {} {:.3f} {} 10\n", month, day, first + i / 6.0, i);
    return out;
}

TEST(WeaFile, StepsOfTenMinutesAreAveragedByHours) {
    for (const double first : {0.0, 1 / 12.0}) {
        const Result<Weather> w = read(header + "weather_data_file_units 1\n" + ten_minutes(2, 27, 28, first));
        ASSERT_TRUE(w) << w.error().message;
        EXPECT_TRUE(w->warnings.empty());
        ASSERT_EQ(w->hours.size(), 48u);
        for (std::size_t h = 0; h < 48; ++h) EXPECT_EQ(w->hours[h].direct_normal, 6.0 * (h % 24) + 2.5) << h;
    }
}

TEST(WeaFile, TimesAfterMidnightAreThoseOfTheNextDay) {
    const auto last_of = [](const std::string& lines) {
        const Result<Weather> w = read(header + "weather_data_file_units 1\n" + lines);
        EXPECT_TRUE(w) << w.error().message;
        return *w;
    };
    const Weather w = last_of(ten_minutes(2, 27, 28, 0.5 + 1 / 12.0));  // up to 24.417
    EXPECT_EQ(w.warnings.size(), 1u);
    ASSERT_EQ(w.hours.size(), 49u);
    EXPECT_EQ(w.at(2, 27, 0.7)->direct_normal, 1);                                    // steps 0 to 2
    EXPECT_EQ(w.at(2, 28, 0.7)->direct_normal, (0 + 1 + 2 + 141 + 142 + 143) / 6.0);  // with the last of the 27th
    EXPECT_EQ(w.at(3, 1, 0.7)->direct_normal, 142);
    EXPECT_EQ(last_of(ten_minutes(12, 31, 31, 0.5)).at(1, 1, 0.5)->direct_normal, 142.5);
    EXPECT_EQ(last_of(ten_minutes(2, 28, 29, 0.5)).at(2, 29, 0.5)->year, leap_year);
    EXPECT_EQ(last_of("2 28 12 5 5\n2 28 24.25 1 1\n2 29 12 5 5\n").at(2, 29, 0.5)->direct_normal, 1);
}

TEST(WeaFile, TimesWithTwoMeaningsAreErrors) {
    const std::string units = "weather_data_file_units 1\n";
    // hours counted from 1 to 24
    const Result<Weather> from_one = read(header + units + ten_minutes(6, 1, 2, 1 + 1 / 12.0));
    ASSERT_FALSE(from_one);
    EXPECT_NE(from_one.error().message.find("24.583 is not a time of 6-1"), std::string::npos);
    const Result<Weather> twice = read(header + units + "6 1 24.250 5 5\n6 2 0.250 5 5\n");
    ASSERT_FALSE(twice);
    EXPECT_TRUE(twice.error().where.ends_with(":7")) << twice.error().where;
    EXPECT_NE(twice.error().message.find("occurs again, as 6-2 0.25"), std::string::npos);
}

TEST(WeaFile, MalformedFilesAreErrors) {
    const std::string light = "6 21 11.5 700 120\n", units = "weather_data_file_units 1\n";
    for (const std::string& text :
         {std::string(), header + light, units + light, header + units, header + "weather_data_file_units 7\n" + light,
          header + units + "6 31 11.5 1 1\n", header + units + "6 21 25 1 1\n", header + units + "6 21 inf 1 1\n",
          header + units + "6 21 11.5 700\n", header + units + "6 21 11.5 0 0\n"})
        EXPECT_FALSE(read(text)) << text;
    const auto with = [&](std::string key, const std::string& value) {
        const std::size_t at = header.find(key + ' ') + key.size() + 1;
        return header.substr(0, at) + value + header.substr(header.find('\n', at)) + units + light;
    };
    ASSERT_TRUE(read(with("latitude", "-90")));
    for (const std::string key : {"latitude", "longitude", "time_zone", "site_elevation"})
        for (const std::string value : {"447000", "-447000", "nan", "here"})
            EXPECT_FALSE(read(with(key, value))) << key << ' ' << value;
}

}  // namespace exitance
