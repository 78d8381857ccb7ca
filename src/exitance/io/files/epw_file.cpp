#include "exitance/io/files/epw_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"

namespace exitance {
namespace {

constexpr std::size_t most_hours = 8784 * 100;  ///< A century: more is no weather file.

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> out;
    while (true) {
        const std::size_t comma = line.find(',');
        out.push_back(line.substr(0, comma));
        if (comma == line.npos) return out;
        line.remove_prefix(comma + 1);
    }
}

std::optional<double> number_within(std::string_view word, double least, double most) {
    const std::optional<double> value = parse_number(word);
    return value && *value >= least && *value <= most ? value : std::nullopt;
}

/// LOCATION,city,state,country,source,WMO,latitude,longitude,time zone,elevation
Result<Weather> read_location(LineReader& lines, std::string_view line) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() < 10 || fields[0] != "LOCATION")
        return lines.error("a weather file begins with LOCATION and nine fields", "EnergyPlus' format, .epw");
    const auto latitude = number_within(fields[6], -90, 90), longitude = number_within(fields[7], -180, 180),
               zone = number_within(fields[8], -13, 15), elevation = number_within(fields[9], -1000, 9999.9);
    if (!latitude || !longitude || !zone || !elevation)
        return lines.error("LOCATION has no latitude, longitude, time zone and elevation");
    Weather out;
    out.city = shown(fields[1]);
    out.place = {*latitude, *longitude, *elevation};
    out.zone = *zone;
    return out;
}

/// A leap day stands for that of a leap year: typical years put months of several years together.
bool mend_leap_day(WeatherHour& hour) {
    if (is_date(hour.year, hour.month, hour.day)) return true;
    constexpr int leap_year = 2020;
    if (hour.month != 2 || hour.day != 29) return false;
    hour.year = leap_year;
    return true;
}

constexpr double missing = 9999;  ///< Numbers from here on say that there is none.

/// The irradiance that is not there, by global = diffuse + direct sin h in the middle of the hour.
void fill_in(const Weather& weather, const std::optional<double>& global, std::optional<double> direct,
             std::optional<double> diffuse, WeatherHour& hour) {
    constexpr double least_sine = 0.05;  // lower suns make any direct light of a small difference
    const double sine = std::sin(sun_position(hour.middle(weather.zone), weather.place).altitude * pi / 180);
    if (global && direct && !diffuse)
        diffuse = std::max(0.0, *global - *direct * std::max(0.0, sine));
    else if (global && diffuse && !direct && (sine > least_sine || *global <= *diffuse))
        direct = std::max(0.0, *global - *diffuse) / std::max(sine, least_sine);
    hour.is_missing = !direct || !diffuse;
    if (!hour.is_missing) hour.direct_normal = *direct, hour.diffuse_horizontal = *diffuse;
}

Result<WeatherHour> read_hour(const LineReader& lines, std::string_view line, const Weather& weather) {
    constexpr std::size_t global_field = 13, direct_field = 14, diffuse_field = 15;  // counted from 0
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() <= diffuse_field)
        return lines.error(
            fmt::format("an hour has {} fields, at least {} are needed", fields.size(), diffuse_field + 1));
    std::array<int, 4> date{};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto value = number_within(fields[i], 0, 9999);
        if (!value) return lines.error(fmt::format("'{}' is no part of a date", shown(fields[i])));
        date[i] = static_cast<int>(*value);
    }
    WeatherHour out{date[0], date[1], date[2], date[3]};
    if (!mend_leap_day(out) || out.hour < 1 || out.hour > 24)
        return lines.error(fmt::format("{}-{}-{}, hour {}, is no date", out.year, out.month, out.day, out.hour));
    const auto direct = parse_number(fields[direct_field]), diffuse = parse_number(fields[diffuse_field]);
    if (!direct || !diffuse) return lines.error("direct or diffuse irradiance is not a number");
    const auto known = [](const std::optional<double>& v) { return v && *v >= 0 && *v < missing ? v : std::nullopt; };
    fill_in(weather, known(parse_number(fields[global_field])), known(direct), known(diffuse), out);
    return out;
}

}  // namespace

const WeatherHour* Weather::at(int month, int day, double hour) const {
    for (const WeatherHour& h : hours)
        if (h.month == month && h.day == day && hour >= h.hour - 1 && hour < h.hour) return &h;
    return nullptr;
}

Result<Weather> load_epw(const std::string& path) {
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    constexpr int header_lines = 8;
    Result<Weather> out = Weather();
    while (const std::optional<std::string_view> line = lines->next()) {
        if (lines->line() == 1) out = read_location(*lines, *line);
        if (!out) return out;
        if (lines->line() <= header_lines || line->find_first_not_of(" \t,") == line->npos) continue;
        const Result<WeatherHour> hour = read_hour(*lines, *line, *out);
        if (!hour) return hour.error();
        const auto is_same = [&](const WeatherHour& h) {
            return h.year == hour->year && h.month == hour->month && h.day == hour->day && h.hour == hour->hour;
        };
        if (!out->hours.empty() && is_same(out->hours.back()))
            return lines->error(
                fmt::format("{}-{}-{}, hour {}, comes twice", hour->year, hour->month, hour->day, hour->hour),
                "files of one line an hour are read");
        out->hours.push_back(*hour);
        if (out->hours.size() > most_hours) return lines->error("there are more hours than a century has");
    }
    if (lines->failed()) return lines->read_error();
    if (out && out->hours.empty()) return lines->error("there are no hours in it");
    return out;
}

}  // namespace exitance
