#include "exitance/io/files/epw_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/io/files/atomic_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

constexpr const char* location = "LOCATION,Town,-,CHE,test,0,47.4,8.5,1.0,400\n";
constexpr const char* periods = "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";

/// One hour of a weather file. `watts` and `lux` hold global, direct and diffuse light.
std::string line(int month, int day, int hour, const std::string& minute, const std::string& watts,
                 const std::string& lux = "999999,999999,999999", char separator = ',') {
    std::string out = "2019," + std::to_string(month) + "," + std::to_string(day) + "," + std::to_string(hour) + "," +
                      minute + ",*,10,5,70,95000,0,1300,300," + watts + "," + lux + ",0,0,0\n";
    for (char& c : out)
        if (c == ',') c = separator;
    return out;
}

/// Irradiances at an hour of a short day.
std::string watts_of(int hour) {
    return hour > 8 && hour < 17 ? "300,400," + std::to_string(90 + hour) : "0,0,0";
}

std::string day_of_hours(int month, int day, int first = 1) {
    std::string out;
    for (int hour = first; hour < first + 24; ++hour) out += line(month, day, hour, "0", watts_of(hour - first + 1));
    return out;
}

class EpwFile : public ::testing::Test {
  protected:
    Result<Weather> read(const std::string& text) {
        EXPECT_TRUE(write_file(folder_ / "w.epw", text));
        return load_epw(folder_ / "w.epw");
    }
    Weather good(const std::string& text) {
        Result<Weather> weather = read(text);
        EXPECT_TRUE(weather) << (weather ? "" : weather.error().where + ": " + weather.error().message);
        return weather ? *weather : Weather();
    }
    std::string fault(const std::string& text) {
        const Result<Weather> weather = read(text);
        return weather
                   ? "none"
                   : weather.error().where.substr(weather.error().where.rfind('/') + 1) + " " + weather.error().message;
    }
    /// Expects the 24 hours that `day_of_hours` writes.
    void expect_day(const Weather& weather, const char* name) {
        ASSERT_EQ(weather.hours.size(), 24u) << name;
        for (int i = 0; i < 24; ++i) {
            const WeatherHour& hour = weather.hours[static_cast<std::size_t>(i)];
            EXPECT_EQ(hour.hour, i + 1) << name;
            EXPECT_EQ(hour.diffuse_horizontal, i + 1 > 8 && i + 1 < 17 ? 91 + i : 0) << name;
            EXPECT_EQ(hour.direct_normal, i + 1 > 8 && i + 1 < 17 ? 400 : 0) << name;
            EXPECT_FALSE(hour.is_missing) << name;
        }
    }

  private:
    TemporaryFolder folder_;
};

}  // namespace

TEST_F(EpwFile, HoursAreFoundAfterAnyHeader) {
    const std::string day = day_of_hours(6, 21);
    const auto expect_no_warning = [&](const std::string& text, const char* name) {
        const Weather weather = good(text);
        expect_day(weather, name);
        EXPECT_TRUE(weather.warnings.empty()) << name;
        EXPECT_EQ(weather.place.latitude, 47.4) << name;
        EXPECT_EQ(weather.place.elevation, 400) << name;
    };
    expect_no_warning(location + day, "location alone");
    expect_no_warning(std::string(location) + periods + day, "two lines");
    const std::string comments = "DESIGN CONDITIONS,1,2,3\nCOMMENTS 1,\"a, b\"\nCOMMENTS 2,none\n\nCOMMENTS 3,more\n";
    expect_no_warning(location + comments + day, "no data periods");
    expect_no_warning(location + comments + comments + periods + day, "many lines");
    expect_no_warning(location + comments + periods + "Year,Month,Day,Hour\n" + day, "names of columns");
    // The second half of a broken comment may begin with a number.
    expect_no_warning(location + std::string("COMMENTS 1,years 1991 to\n2005,made\n") + periods + day, "broken line");
    std::string lower = location + comments + periods;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    expect_no_warning(lower + day, "lower case");
    expect_no_warning("\n \n" + (location + day), "blank first lines");
    expect_no_warning("\xef\xbb\xbf" + std::string(location) + periods + day, "byte order mark");
    std::string dos;
    for (const char c : location + comments + periods + day) dos += c == '\n' ? "\r\n" : std::string(1, c);
    expect_no_warning(dos, "CRLF");
    std::string mac = location + comments + periods + day;
    std::replace(mac.begin(), mac.end(), '\n', '\r');
    expect_no_warning(mac, "CR");
    expect_no_warning(dos + "\x1a", "control-Z on a line of its own");
    expect_no_warning(location + day.substr(0, day.size() - 1) + "\x1a", "control-Z behind the last hour");
    expect_no_warning(location + day + "\x1a\nrest of a sector, 1, 2", "text behind control-Z");
    for (const char separator : {';', '\t'}) {
        std::string other = std::string(location) + periods + day;
        for (char& c : other)
            if (c == ',') c = separator;
        expect_no_warning(other, "other separators");
    }
    expect_no_warning("LOCATION,\"Town, Airport\",-,CHE,test,0, 47.4 ,8.5,1.0,400\n" + day, "quoted comma");
}

TEST_F(EpwFile, MalformedHoursAreErrors) {
    const std::string hour = line(6, 21, 1, "0", "0,0,1");
    EXPECT_EQ(fault("2019,1,1\n").substr(0, 7), "w.epw:1");
    EXPECT_EQ(fault("").substr(0, 5), "w.epw");
    EXPECT_EQ(fault(location).substr(0, 7), "w.epw:1");
    EXPECT_EQ(fault(std::string(location) + "2019,6,21,1,0\n" + hour),
              "w.epw:2 the line is neither a header nor an hour");
    EXPECT_EQ(fault(std::string(location) + periods + "2019,6,21,1,0\n").substr(0, 7), "w.epw:3");
    EXPECT_EQ(fault(location + hour + "COMMENTS,2\n").substr(0, 7), "w.epw:3");
    EXPECT_EQ(fault(location + hour + line(6, 21, 25, "0", "0,0,1")).substr(0, 7), "w.epw:3");
    EXPECT_EQ(fault(location + hour + line(6, 21, 2, "0", "0,x,1")), "w.epw:3 'x' in field 15 is not a number");
    std::string half_day = hour;
    half_day.replace(half_day.find(",21,"), 4, ",21.5,");
    EXPECT_EQ(fault(location + half_day).substr(0, 7), "w.epw:2");
}

TEST_F(EpwFile, HoursMayBeInAnyOrderButNotTwice) {
    const std::string one = line(1, 1, 1, "0", "0,0,1"), two = line(1, 1, 2, "0", "0,0,2");
    EXPECT_EQ(good(location + two + one).hours[1].diffuse_horizontal, 1);
    EXPECT_EQ(fault(location + one + two + one).substr(0, 7), "w.epw:4");
    EXPECT_NE(fault(location + one + two + one).find("occurs twice"), std::string::npos);
}

TEST_F(EpwFile, LinesOfTheSameHourAreAveraged) {
    const std::string header = std::string(location) + "DATA PERIODS,1,4,Data,Sunday, 1/ 1,12/31\n";
    const Weather quarters =
        good(header + line(6, 21, 10, "15", "0,100,10") + line(6, 21, 10, "30", "0,200,20") +
             line(6, 21, 10, "45", "0,300,30") + line(6, 21, 10, "60", "0,400,40") + line(6, 21, 11, "15", "0,8,1"));
    ASSERT_EQ(quarters.hours.size(), 2u);
    EXPECT_EQ(quarters.hours[0].direct_normal, 250);
    EXPECT_EQ(quarters.hours[0].diffuse_horizontal, 25);
    EXPECT_EQ(quarters.hours[1].direct_normal, 8);
    // A line without known light does not count in the mean.
    const Weather gap = good(header + line(6, 21, 10, "30", "9999,9999,9999") + line(6, 21, 10, "60", "0,400,40"));
    EXPECT_EQ(gap.hours[0].direct_normal, 400);
    // Each half is computed from global light with the sun's altitude in its own middle.
    const Weather halves = good(header + line(6, 21, 8, "30", "300,9999,100") + line(6, 21, 8, "60", "400,9999,100"));
    const auto direct = [&](double global, double hour) {
        const SunPosition sun = sun_position({2019, 6, 21, hour, 1}, {47.4, 8.5, 400});
        return (global - 100) / std::sin(sun.altitude * pi / 180);
    };
    EXPECT_NEAR(halves.hours[0].direct_normal, 0.5 * (direct(300, 7.25) + direct(400, 7.75)), 1e-9);
}

TEST_F(EpwFile, HoursFromZeroAreShifted) {
    const Weather weather = good(location + day_of_hours(6, 21, 0));
    expect_day(weather, "0 to 23");
    ASSERT_EQ(weather.warnings.size(), 1u);
    EXPECT_NE(weather.warnings[0].find("0 to 23"), std::string::npos);
    EXPECT_NE(fault(location + line(6, 21, 0, "0", "0,0,1") + line(6, 21, 24, "0", "0,0,1")).find("0 and 24"),
              std::string::npos);
}

TEST_F(EpwFile, ClockTimesUpTo24AreTheEndsOfTheirSteps) {
    const auto day = [](int from, int to, int step) {  // minutes from midnight
        std::string out;
        for (int t = from; t <= to; t += step)
            out += line(6, 1, t / 60, std::to_string(t % 60), "0,100," + std::to_string(t / 10));
        return out;
    };
    const std::string head = std::string(location) + periods;
    const Weather ends = good(head + day(10, 1440, 10));
    EXPECT_EQ(ends.warnings.size(), 1u);
    ASSERT_EQ(ends.hours.size(), 24u);
    for (std::size_t h = 0; h < 24; ++h) {
        EXPECT_EQ(ends.hours[h].hour, static_cast<int>(h) + 1);
        EXPECT_EQ(ends.hours[h].diffuse_horizontal, 6.0 * static_cast<double>(h) + 3.5);  // lines 1 to 6 of the hour
    }
    // Lines named by their beginning or their middle have no hour 24.
    for (const int first : {0, 5}) EXPECT_EQ(good(head + day(first, 1439, 10)).hours[0].diffuse_horizontal, 2.5);
    // With a line of 0:00, that of 24:00 has two meanings.
    EXPECT_NE(fault(head + day(0, 1440, 10)).find("there are hours 0 and 24"), std::string::npos);
}

TEST_F(EpwFile, MissingIrradiancesFollowFromIlluminances) {
    for (const char* missing : {"9999,9999,9999", "99999,99999,99999", ",,", "-1,-1,-1", "9999999999,9999,9999"}) {
        const Weather weather = good(location + line(6, 21, 12, "0", missing, "70000,50000,12000"));
        EXPECT_NEAR(weather.hours[0].direct_normal, 500, 1e-9) << missing;
        EXPECT_NEAR(weather.hours[0].diffuse_horizontal, 100, 1e-9) << missing;
        ASSERT_EQ(weather.warnings.size(), 1u);
        EXPECT_NE(weather.warnings[0].find("follow from their illuminances"), std::string::npos);
    }
    // Irradiances have priority; one of the two may be computed from its illuminance.
    const Weather both = good(location + line(6, 21, 12, "0", "9999,9999,90", "70000,50000,12000") +
                              line(6, 21, 13, "0", "500,600,80", "1,1,1"));
    EXPECT_NEAR(both.hours[0].direct_normal, 500, 1e-9);
    EXPECT_EQ(both.hours[0].diffuse_horizontal, 90);
    EXPECT_EQ(both.hours[1].direct_normal, 600);
    // Columns of zeros count as unknown: irradiances if zero in the whole file, illuminances if zero by day.
    const Weather zeros = good(location + line(6, 21, 12, "0", "0,0,0", "70000,50000,12000"));
    EXPECT_NEAR(zeros.hours[0].direct_normal, 500, 1e-9);
    const Weather day =
        good(location + line(6, 21, 12, "0", "9999,9999,9999", "0,0,0") + line(6, 21, 13, "0", "500,600,80"));
    EXPECT_TRUE(day.hours[0].is_missing);
    ASSERT_EQ(day.warnings.size(), 1u);
    EXPECT_NE(day.warnings[0].find("1 of 2 hours"), std::string::npos) << day.warnings[0];
    const Weather dusk = good(location + line(6, 21, 12, "0", "9999,9999,9999", "70000,50000,12000") +
                              line(6, 21, 20, "0", "9999,9999,9999", "0,0,0"));
    EXPECT_FALSE(dusk.hours[1].is_missing);
    EXPECT_EQ(dusk.hours[1].diffuse_horizontal, 0);
    EXPECT_NE(fault(location + line(6, 21, 12, "0", "9999,9999,9999")).find("no hour has irradiances or"),
              std::string::npos);
}

TEST_F(EpwFile, NotAYearReportsMissingAndRepeatedHours) {
    constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    std::string year, june, leap_day = day_of_hours(2, 29);
    for (int month = 1; month <= 12; ++month)
        for (int day = 1; day <= days[month - 1]; ++day) {
            year += day_of_hours(month, day);
            if (month == 6) june += day_of_hours(month, day);
        }
    EXPECT_EQ(good(location + year).not_a_year(), "");
    EXPECT_EQ(good(location + year + leap_day).not_a_year(), "");
    EXPECT_NE(good(location + june).not_a_year().find("720 hours"), std::string::npos);
    EXPECT_NE(good(location + june).not_a_year().find("8040 of 8760"), std::string::npos);
    std::string second = year;
    for (std::size_t at = 0; (at = second.find("2019,", at)) != second.npos; at += 5) second.replace(at, 4, "2018");
    EXPECT_NE(good(location + year + second).not_a_year().find("8760 occur more than once"), std::string::npos);
}

}  // namespace exitance
