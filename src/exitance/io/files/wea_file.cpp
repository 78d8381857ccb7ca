#include "exitance/io/files/wea_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

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
        constexpr int hours_a_day = 24;
        if (!is_date(leap_year, now.month, now.day) || !(time >= 0 && time <= hours_a_day) || !std::isfinite(direct) ||
            !std::isfinite(diffuse))
            return lines_.error("is not an hour of a year with its light");
        if (now.month == 2 && now.day > 28) now.year = leap_year;
        now.hour = std::min(hours_a_day, static_cast<int>(time) + 1);
        negative_ += direct < 0 || diffuse < 0;
        const bool is_same = !out_.hours.empty() && out_.hours.back().month == now.month &&
                             out_.hours.back().day == now.day && out_.hours.back().hour == now.hour;
        if (!is_same) out_.hours.push_back(now), steps_.push_back(0);
        out_.hours.back().direct_normal += std::max(0.0, direct);
        out_.hours.back().diffuse_horizontal += std::max(0.0, diffuse);
        ++steps_.back();
        return {};
    }

    Result<Weather> finish() {
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

    LineReader lines_;
    WeatherEfficacies efficacies_;
    Weather out_;
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
