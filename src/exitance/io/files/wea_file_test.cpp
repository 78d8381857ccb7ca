#include "exitance/io/files/wea_file.hpp"

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

TEST(WeaFile, MalformedFilesAreErrors) {
    const std::string light = "6 21 11.5 700 120\n", units = "weather_data_file_units 1\n";
    for (const std::string& text :
         {std::string(), header + light, units + light, header + units, header + "weather_data_file_units 7\n" + light,
          header + units + "6 31 11.5 1 1\n", header + units + "6 21 25 1 1\n", header + units + "6 21 11.5 700\n",
          header + units + "6 21 11.5 0 0\n"})
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
