#include "exitance/io/files/epw_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "exitance/base/words.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_rows = 8784 * 100;  ///< Hours of 100 years, or minutes of about 1.7 years.

/// Splits a line into fields and trims blanks and quotation marks. A separator within quotation marks is part of a
/// field.
std::vector<std::string_view> fields_of(std::string_view line, char separator) {
    std::vector<std::string_view> out;
    bool in_quotes = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size() && line[i] == '"') in_quotes = !in_quotes;
        if (i < line.size() && (line[i] != separator || in_quotes)) continue;
        out.push_back(without_quotes(line.substr(begin, i - begin)));
        begin = i + 1;
    }
    return out;
}

/// Returns the most frequent separator in `line`.
char separator_of(std::string_view line) {
    char out = ',';
    for (const char c : {';', '\t'})
        if (std::count(line.begin(), line.end(), c) > std::count(line.begin(), line.end(), out)) out = c;
    return out;
}

bool is_key(std::string_view word, std::string_view key) {
    return std::equal(word.begin(), word.end(), key.begin(), key.end(), [](char a, char b) {
        return std::toupper(static_cast<unsigned char>(a)) == std::toupper(static_cast<unsigned char>(b));
    });
}

std::optional<double> number_within(std::string_view word, double least, double most) {
    const std::optional<double> value = parse_number(word);
    return value && *value >= least && *value <= most ? value : std::nullopt;
}

/// Global, direct normal and diffuse horizontal light in one unit; a missing value is empty.
struct SkyValues {
    std::optional<double> global, direct, diffuse;

    bool any_above_zero() const { return global.value_or(0) > 0 || direct.value_or(0) > 0 || diffuse.value_or(0) > 0; }
};

/// One line of data.
struct DataLine {
    int year = 2021, month = 1, day = 1, hour = 1;
    double minute = 0;
    SkyValues watts = {}, lux = {};
    int line = 0;
};

// Columns of a row, counted from 0.
constexpr std::size_t minute_field = 4, first_watts_field = 13, first_lux_field = 16;

bool is_blank_line(std::string_view line) {
    return line.find_first_not_of(" \t,;\"") == line.npos;
}

bool starts_with_number(const std::vector<std::string_view>& fields) {
    return parse_number(fields[0]).has_value();
}

/// Corrects the date of a row and returns false if there is no such date. 29 February is given `leap_year`, since
/// typical years combine months of different years.
bool mend_date(DataLine& row) {
    constexpr int unknown_year = 2021;
    if (row.year < 1) row.year = unknown_year;
    if (is_date(row.year, row.month, row.day)) return true;
    if (row.month != 2 || row.day != 29) return false;
    row.year = leap_year;
    return true;
}

class EpwReader {
  public:
    EpwReader(LineReader lines, const WeatherEfficacies& efficacies)
        : lines_(std::move(lines)), efficacies_(efficacies) {}
    Result<Weather> read();

  private:
    Result<void> read_line(std::string_view line);
    Result<void> read_location(std::string_view line);
    Result<void> read_header(const std::vector<std::string_view>& fields);
    Result<void> read_row(const std::vector<std::string_view>& fields);
    Result<SkyValues> read_light(const std::vector<std::string_view>& fields, std::size_t first, double missing) const;
    bool are_clock_times() const;
    Result<void> count_hours_from_one();
    Result<void> make_hours();
    WeatherHour mean_of(std::span<const DataLine* const> rows);
    bool find_light(const DataLine& row, double hour, double& direct, double& diffuse);
    Error error_at(int line, std::string message, std::string hint = "") const;

    LineReader lines_;
    WeatherEfficacies efficacies_;
    Weather out_;
    std::vector<DataLine> rows_;
    bool has_location_ = false, has_data_periods_ = false;
    char separator_ = ',';
    int stray_line_ = 0;  ///< First line of numbers in the header that has too few fields for an hour; 0: none.
    std::size_t by_illuminance_ = 0;  ///< Number of lines whose light is computed from illuminances.
};

Error EpwReader::error_at(int line, std::string message, std::string hint) const {
    Error out = lines_.error(std::move(message), std::move(hint));
    out.where = out.where.substr(0, out.where.rfind(':') + 1) + std::to_string(line);
    return out;
}

/// LOCATION,city,state,country,source,WMO,latitude,longitude,time zone,elevation
Result<void> EpwReader::read_location(std::string_view line) {
    separator_ = separator_of(line);
    const std::vector<std::string_view> fields = fields_of(line, separator_);
    if (fields.size() < 10 || !is_key(fields[0], "LOCATION"))
        return lines_.error("the first line is not LOCATION with nine fields",
                            "use a weather file in EnergyPlus' format, .epw");
    const auto latitude = number_within(fields[6], -90, 90), longitude = number_within(fields[7], -180, 180),
               zone = number_within(fields[8], -13, 15), elevation = number_within(fields[9], -1000, 9999.9);
    if (!latitude || !longitude || !zone || !elevation)
        return lines_.error("LOCATION has no latitude, longitude, time zone and elevation");
    out_.city = shown(fields[1]);
    out_.place = {*latitude, *longitude, *elevation};
    out_.zone = *zone;
    has_location_ = true;
    return {};
}

/// Reads a line above the first hour.
Result<void> EpwReader::read_header(const std::vector<std::string_view>& fields) {
    if (!starts_with_number(fields)) {
        has_data_periods_ |= is_key(fields[0], "DATA PERIODS");
        return {};
    }
    // Before DATA PERIODS, a line with fewer numbers than an hour may be the rest of a broken header line.
    if (!has_data_periods_ && fields.size() < first_lux_field) {
        if (stray_line_ == 0) stray_line_ = lines_.line();
        return {};
    }
    if (!has_data_periods_ && stray_line_ > 0)
        return error_at(stray_line_, "the line is neither a header nor an hour",
                        "hours begin after DATA PERIODS, or with the first line of numbers");
    return read_row(fields);
}

/// Reads three fields from `first` on. Negative numbers, and numbers of at least `missing`, count as missing.
Result<SkyValues> EpwReader::read_light(const std::vector<std::string_view>& fields, std::size_t first,
                                        double missing) const {
    std::array<std::optional<double>, 3> value;
    for (std::size_t i = 0; i < 3; ++i) {
        if (first + i >= fields.size() || fields[first + i].empty()) continue;
        value[i] = parse_number(fields[first + i]);
        if (!value[i])
            return lines_.error(
                fmt::format("'{}' in field {} is not a number", shown(fields[first + i]), first + i + 1));
        if (!(*value[i] >= 0 && *value[i] < missing)) value[i].reset();
    }
    return SkyValues{value[0], value[1], value[2]};
}

Result<void> EpwReader::read_row(const std::vector<std::string_view>& fields) {
    if (fields.size() < first_lux_field)
        return lines_.error(
            fmt::format("an hour has {} fields, at least {} are needed", fields.size(), first_lux_field));
    std::array<int, 4> date{};
    for (std::size_t i = 0; i < date.size(); ++i) {
        const auto value = number_within(fields[i], 0, 9999);
        if (!value || *value != std::floor(*value))
            return lines_.error(fmt::format("'{}' is not a valid part of a date", shown(fields[i])));
        date[i] = static_cast<int>(*value);
    }
    DataLine row{date[0], date[1], date[2], date[3]};
    if (!mend_date(row) || row.hour > 24)
        return lines_.error(fmt::format("{}-{}-{}, hour {}, is not a date", row.year, row.month, row.day, row.hour));
    row.minute = parse_number(fields[minute_field]).value_or(0);
    constexpr double missing_watts = 9999, missing_lux = 999'900;  // limits in EnergyPlus' definition of the format
    const Result<SkyValues> watts = read_light(fields, first_watts_field, missing_watts);
    if (!watts) return watts.error();
    const Result<SkyValues> lux = read_light(fields, first_lux_field, missing_lux);
    if (!lux) return lux.error();
    row.watts = *watts, row.lux = *lux, row.line = lines_.line();
    rows_.push_back(row);
    if (rows_.size() > max_rows) return lines_.error("there are more hours than in a century");
    return {};
}

Result<void> EpwReader::read_line(std::string_view line) {
    if (is_blank_line(line)) return {};
    if (!has_location_) return read_location(line);
    const std::vector<std::string_view> fields = fields_of(line, separator_);
    return rows_.empty() ? read_header(fields) : read_row(fields);
}

/// True if hours and minutes are the clock times at which the lines end, from 0:10 to 24:00 for steps of ten minutes.
bool EpwReader::are_clock_times() const {
    return std::all_of(rows_.begin(), rows_.end(), [](const DataLine& row) {
        return row.minute >= 0 && row.minute < 60 && (row.hour > 0 || row.minute > 0) &&
               (row.hour < 24 || row.minute == 0);
    });
}

/// Changes hours counted from 0 to 23 by their beginning, and clock times, to 1 to 24 by their end.
Result<void> EpwReader::count_hours_from_one() {
    const auto is_hour = [](int hour) { return [hour](const DataLine& row) { return row.hour == hour; }; };
    const auto zero = std::find_if(rows_.begin(), rows_.end(), is_hour(0));
    if (zero == rows_.end()) return {};
    const bool has_24 = std::any_of(rows_.begin(), rows_.end(), is_hour(24));
    if (has_24 && are_clock_times()) {
        // The line of 1:00 ends the first hour.
        for (DataLine& row : rows_) row.minute == 0 ? row.minute = 60 : ++row.hour;
        out_.warnings.push_back("times go from hour 0 to 24:00: they are read as the clock times at which lines end");
        return {};
    }
    if (has_24)
        return error_at(zero->line, "there are hours 0 and 24 in the file",
                        "hours are counted from 1 to 24; or hours and minutes are the times at which lines end, "
                        "of which the last is 24:00");
    for (DataLine& row : rows_) ++row.hour;
    out_.warnings.push_back("hours are counted from 0 to 23: hour 0 is read as the first of its day");
    return {};
}

/// Computes a missing diffuse or direct part from global = diffuse + direct sin h, if the other two are known. `sine`
/// computes sin h, where h is the sun's altitude.
template <class Sine>
void fill_in(SkyValues& light, const Sine& sine) {
    // if the sun is lower, a small error of the difference would become large direct light
    constexpr double min_sine = 0.05;
    if (!light.global || light.direct.has_value() == light.diffuse.has_value()) return;
    const double h = sine();
    if (light.direct)
        light.diffuse = std::max(0.0, *light.global - *light.direct * std::max(0.0, h));
    else if (h > min_sine || *light.global <= *light.diffuse)
        light.direct = std::max(0.0, *light.global - *light.diffuse) / std::max(h, min_sine);
}

/// Computes direct and diffuse irradiance of a line, W/m^2. `hour` is the middle of the line's time. Returns false if
/// they are unknown.
bool EpwReader::find_light(const DataLine& row, double hour, double& direct, double& diffuse) {
    const auto sine = [&] {
        const LocalTime time{row.year, row.month, row.day, hour, out_.zone};
        return std::sin(sun_position(time, out_.place).altitude * pi / 180);
    };
    SkyValues light = row.watts;
    fill_in(light, sine);
    if (!light.direct || !light.diffuse) {
        SkyValues lux = row.lux;
        if (light.direct) lux.direct = *light.direct * efficacies_.direct;
        if (light.diffuse) lux.diffuse = *light.diffuse * efficacies_.diffuse;
        fill_in(lux, sine);
        if (lux.direct && lux.diffuse) {
            by_illuminance_ += lux.any_above_zero();
            light.direct = *lux.direct / efficacies_.direct, light.diffuse = *lux.diffuse / efficacies_.diffuse;
        }
    }
    if (!light.direct || !light.diffuse) return false;
    direct = *light.direct, diffuse = *light.diffuse;
    return true;
}

/// Averages the lines of one hour, which divide it evenly in their order. Lines without known light are ignored.
WeatherHour EpwReader::mean_of(std::span<const DataLine* const> rows) {
    const DataLine& first = *rows.front();
    WeatherHour out{first.year, first.month, first.day, first.hour};
    const double count = static_cast<double>(rows.size());
    double known = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        double direct = 0, diffuse = 0;
        if (!find_light(*rows[i], first.hour - 1 + (static_cast<double>(i) + 0.5) / count, direct, diffuse)) continue;
        out.direct_normal += direct, out.diffuse_horizontal += diffuse, ++known;
    }
    out.is_missing = known == 0;
    if (known > 0) out.direct_normal /= known, out.diffuse_horizontal /= known;
    return out;
}

/// Groups the rows into hours, in the order of their first lines.
Result<void> EpwReader::make_hours() {
    using Key = std::tuple<int, int, int, int>;
    std::map<Key, std::size_t> numbers;
    std::vector<std::vector<const DataLine*>> hours;
    // A quantity that is 0 in the whole file was not measured.
    const auto has_light = [&](SkyValues DataLine::*columns) {
        return std::any_of(rows_.begin(), rows_.end(),
                           [&](const DataLine& row) { return (row.*columns).any_above_zero(); });
    };
    const bool has_watts = has_light(&DataLine::watts), has_lux = has_light(&DataLine::lux);
    for (DataLine& row : rows_) {
        if (!has_watts) row.watts = {};
        if (!has_lux) row.lux = {};
        const auto [at, is_new] = numbers.try_emplace(Key{row.year, row.month, row.day, row.hour}, hours.size());
        if (is_new) hours.emplace_back();
        for (const DataLine* other : hours[at->second])
            if (other->minute == row.minute)
                return error_at(row.line,
                                fmt::format("{}-{}-{}, hour {}, occurs twice", row.year, row.month, row.day, row.hour),
                                "lines of one hour differ in their minutes, the fifth field");
        hours[at->second].push_back(&row);
    }
    for (std::vector<const DataLine*>& rows : hours) {
        std::sort(rows.begin(), rows.end(), [](const DataLine* a, const DataLine* b) { return a->minute < b->minute; });
        out_.hours.push_back(mean_of(rows));
    }
    return {};
}

Result<Weather> EpwReader::read() {
    constexpr char control_z = '\x1a';  // marks the end of a text file in DOS
    bool ended = false;
    while (!ended) {
        const std::optional<std::string_view> line = lines_.next();
        if (!line) break;
        const std::size_t end = line->find(control_z);
        ended = end != line->npos;
        if (const Result<void> read = read_line(line->substr(0, end)); !read) return read.error();
    }
    if (lines_.failed()) return lines_.read_error();
    if (!has_location_)
        return lines_.error("the first line is not LOCATION", "use a weather file in EnergyPlus' format, .epw");
    if (rows_.empty()) return lines_.error("the file contains no hours");
    if (const Result<void> counted = count_hours_from_one(); !counted) return counted.error();
    if (const Result<void> made = make_hours(); !made) return made.error();
    const auto missing =
        std::count_if(out_.hours.begin(), out_.hours.end(), [](const auto& h) { return h.is_missing; });
    if (missing == static_cast<std::ptrdiff_t>(out_.hours.size()))
        return error_at(rows_.front().line, "no hour has irradiances or illuminances", "fields 14 to 19 of its line");
    if (by_illuminance_ > 0)
        out_.warnings.push_back(
            fmt::format("{} of {} lines have no irradiances: these follow from their illuminances, by {:g} lm/W of sun "
                        "and {:g} lm/W of sky",
                        by_illuminance_, rows_.size(), efficacies_.direct, efficacies_.diffuse));
    if (missing > 0)
        out_.warnings.push_back(fmt::format(
            "{} of {} hours have neither irradiances nor illuminances, and count as dark", missing, out_.hours.size()));
    return std::move(out_);
}

}  // namespace

const WeatherHour* Weather::at(int month, int day, double hour) const {
    for (const WeatherHour& h : hours)
        if (h.month == month && h.day == day && hour >= h.hour - 1 && hour < h.hour) return &h;
    return nullptr;
}

std::string Weather::not_a_year() const {
    constexpr std::size_t hours_a_day = 24, leap_day = 31 + 29;
    std::array<int, 366 * hours_a_day> count{};
    for (const WeatherHour& h : hours)
        ++count[static_cast<std::size_t>(day_of_year(leap_year, h.month, h.day) - 1) * hours_a_day +
                static_cast<std::size_t>(h.hour - 1)];
    std::size_t absent = 0, repeated = 0;
    for (std::size_t i = 0; i < count.size(); ++i) {
        absent += count[i] == 0 && i / hours_a_day != leap_day - 1;
        repeated += count[i] > 1;
    }
    if (absent == 0 && repeated == 0) return "";
    return fmt::format("its {} hours are not those of one year ({} of 8760 are absent, {} occur more than once)",
                       hours.size(), absent, repeated);
}

Result<Weather> load_epw(const std::string& path, const WeatherEfficacies& efficacies) {
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    return EpwReader(std::move(*lines), efficacies).read();
}

}  // namespace exitance
