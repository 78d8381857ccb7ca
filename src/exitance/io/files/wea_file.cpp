#include "exitance/io/files/wea_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

constexpr double degrees_per_hour = 15;  ///< Turn of the Earth, degrees.

/// A line with a number: its key and the range of the number.
struct WeaNumber {
    std::string_view key;
    double least, most;
};
/// Angles are degrees west, as in `gendaylit`; the elevation is in metres.
constexpr std::array<WeaNumber, 5> wea_numbers{{{"latitude", -90, 90},
                                                {"longitude", -180, 180},
                                                {"time_zone", -15 * degrees_per_hour, 13 * degrees_per_hour},
                                                {"site_elevation", -1000, 9999.9},
                                                {"weather_data_file_units", 1, 2}}};

class WeaReader {
  public:
    WeaReader(LineReader lines, const WeatherEfficacies& efficacies)
        : lines_(std::move(lines)), efficacies_(efficacies) {}

    Result<Weather> read() {
        while (const std::optional<std::string_view> line = lines_.next_content()) {
            const Result<void> done = take(std::string(*line));
            if (!done) return done.error();
        }
        if (lines_.failed()) return lines_.read_error();
        for (const char* const key : {"latitude", "longitude", "time_zone", "weather_data_file_units"})
            if (!keys_.contains(key)) return lines_.error(fmt::format("the file has no line '{}'", key));
        return finish();
    }

  private:
    Result<void> take(const std::string& line) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "place") {
            std::getline(words >> std::ws, out_.city);
            return {};
        }
        const auto known =
            std::find_if(wea_numbers.begin(), wea_numbers.end(), [&](const WeaNumber& n) { return n.key == key; });
        if (known == wea_numbers.end()) return take_hour(line);
        std::string value;
        words >> value;
        const std::optional<double> number = parse_number(value);
        if (!number || !(*number >= known->least && *number <= known->most))
            return lines_.error(fmt::format("'{}' is not a valid {}", value, key),
                                fmt::format("give a number from {:g} to {:g}", known->least, known->most));
        keys_[key] = *number;
        return {};
    }

    Result<void> take_hour(const std::string& line) {
        std::istringstream words(line);
        WeatherHour now;
        double time = 0, direct = 0, diffuse = 0;
        if (!(words >> now.month >> now.day >> time >> direct >> diffuse))
            return lines_.error("is neither a key nor 'month day hour direct diffuse'");
        if (!is_date(leap_year, now.month, now.day) || !(time >= 0) || !std::isfinite(time) || !std::isfinite(direct) ||
            !std::isfinite(diffuse))
            return lines_.error("is not an hour of a year with its light");
        if (time >= hours_a_day + max_late)
            return lines_.error(fmt::format("{:g} is not a time of {}-{}", time, now.month, now.day),
                                "times are the middle of each step, in hours from midnight: the first hour of a day is "
                                "0 to 1, not 1 to 2");
        negative_ += direct < 0 || diffuse < 0;
        if (now.month == 2 && now.day > february) now.year = leap_year, has_leap_day_ = true;
        if (time > hours_a_day) {
            late_.push_back({now.month, now.day, time, std::max(0.0, direct), std::max(0.0, diffuse), lines_.line()});
            return {};
        }
        if (time < max_late) early_.insert({now.month, now.day, milli(time)});
        now.hour = std::min(hours_a_day, static_cast<int>(time) + 1);
        const bool is_same = !out_.hours.empty() && out_.hours.back().month == now.month &&
                             out_.hours.back().day == now.day && out_.hours.back().hour == now.hour;
        if (!is_same) out_.hours.push_back(now), steps_.push_back(0);
        out_.hours.back().direct_normal += std::max(0.0, direct);
        out_.hours.back().diffuse_horizontal += std::max(0.0, diffuse);
        ++steps_.back();
        return {};
    }

    /// Adds the steps whose middle is after 24:00 to the first hour of the next day.
    Result<void> add_late_steps() {
        if (late_.empty()) return {};
        std::map<std::pair<int, int>, std::size_t> first_hour;  // per month and day
        for (std::size_t h = 0; h < out_.hours.size(); ++h)
            if (out_.hours[h].hour == 1) first_hour.emplace(std::pair(out_.hours[h].month, out_.hours[h].day), h);
        for (const LateStep& step : late_) {
            WeatherHour now;
            now.month = step.month, now.day = step.day + 1;
            const int year = has_leap_day_ ? leap_year : now.year;
            if (!is_date(year, now.month, now.day)) now.month = step.month % 12 + 1, now.day = 1;
            if (now.month == 2 && now.day > february) now.year = leap_year;
            if (early_.contains({now.month, now.day, milli(step.time - hours_a_day)})) {
                Error error = lines_.error(fmt::format("{}-{} {:g} occurs again, as {}-{} {:g}", step.month, step.day,
                                                       step.time, now.month, now.day, step.time - hours_a_day),
                                           "a time after 24 is that of the next day: remove one of both lines");
                error.where = error.where.substr(0, error.where.rfind(':') + 1) + std::to_string(step.line);
                return error;
            }
            const auto [at, is_new] = first_hour.emplace(std::pair(now.month, now.day), out_.hours.size());
            if (is_new) out_.hours.push_back(now), steps_.push_back(0);
            WeatherHour& hour = out_.hours[at->second];
            hour.direct_normal += step.direct, hour.diffuse_horizontal += step.diffuse;
            ++steps_[at->second];
        }
        out_.warnings.push_back(
            fmt::format("{} lines have times up to {:g}: times after 24 are read as those of the next day",
                        late_.size(), std::max_element(late_.begin(), late_.end(), [](const auto& a, const auto& b) {
                                          return a.time < b.time;
                                      })->time));
        return {};
    }

    Result<Weather> finish() {
        if (const Result<void> added = add_late_steps(); !added) return added.error();
        const double units = keys_["weather_data_file_units"];
        if (units != 1 && units != 2)
            return lines_.error(fmt::format("weather_data_file_units {:g} is not supported", units),
                                "use 1 for W/m^2 or 2 for lux");
        out_.place.latitude = keys_["latitude"], out_.place.longitude = -keys_["longitude"];
        out_.place.elevation = keys_["site_elevation"], out_.zone = -keys_["time_zone"] / degrees_per_hour;
        bool is_dark = true;
        for (std::size_t h = 0; h < out_.hours.size(); ++h) {
            WeatherHour& hour = out_.hours[h];
            hour.direct_normal /= steps_[h] * (units == 2 ? efficacies_.direct : 1);
            hour.diffuse_horizontal /= steps_[h] * (units == 2 ? efficacies_.diffuse : 1);
            is_dark &= !(hour.direct_normal > 0) && !(hour.diffuse_horizontal > 0);
        }
        if (is_dark) return lines_.error("no hour has light");
        if (negative_ > 0)
            out_.warnings.push_back(fmt::format("{} lines have negative light, which counts as 0", negative_));
        return std::move(out_);
    }

    static constexpr int hours_a_day = 24, february = 28;
    /// Hours after 24 before which the middle of a step lies that begins on its day and takes at most an hour.
    static constexpr double max_late = 0.5;

    /// A step whose middle is after 24:00.
    struct LateStep {
        int month, day;
        double time, direct, diffuse;  ///< Hours; the light as in the file, at least 0.
        int line;
    };

    /// A time in thousandths of an hour, the precision of the files.
    static int milli(double time) { return static_cast<int>(std::lround(1000 * time)); }

    LineReader lines_;
    WeatherEfficacies efficacies_;
    Weather out_;
    std::vector<LateStep> late_;
    std::set<std::array<int, 3>> early_;  ///< Month, day and time of the steps of the first half hour of each day.
    bool has_leap_day_ = false;
    std::map<std::string, double> keys_;
    std::vector<double> steps_;  ///< Number of lines of each hour.
    std::size_t negative_ = 0;
};

}  // namespace

Result<Weather> load_wea(const std::string& path, const WeatherEfficacies& efficacies) {
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    return WeaReader(std::move(*lines), efficacies).read();
}

Result<Weather> load_weather(const std::string& path, const WeatherEfficacies& efficacies) {
    return ending(path) == ".wea" ? load_wea(path, efficacies) : load_epw(path, efficacies);
}

}  // namespace exitance
