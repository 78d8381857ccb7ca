#include "exitance/io/scenes/sky_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "exitance/base/words.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/scenes/sky_picture_words.hpp"

namespace exitance {
namespace {

constexpr double default_ground = 0.2;  ///< Reflectance.

Error wrong(std::string message, std::string hint = "") {
    return {ErrorCode::usage, std::move(message), "--sky", std::move(hint)};
}

/// A numeric parameter of a sky, with its valid range.
struct Named {
    const char* name;
    double least, most;
    const char* meaning;
};
constexpr std::array<Named, 14> numbers{{{"lat", -90, 90, "latitude, degrees north"},
                                         {"lon", -180, 180, "longitude, degrees east"},
                                         {"elevation", -1000, 9000, "metres above the sea"},
                                         {"tz", -13, 15, "hours that clocks are ahead of universal time"},
                                         {"north", -360, 360, "degrees clockwise from y to north"},
                                         {"altitude", -90, 90, "of the sun, degrees"},
                                         {"azimuth", -360, 360, "of the sun, degrees from north towards east"},
                                         {"dni", 0, 2000, "direct normal irradiance, W/m^2"},
                                         {"dhi", 0, 1e6, "diffuse horizontal irradiance, W/m^2"},
                                         {"ground", 0, 1, "reflectance of the ground beneath the scene"},
                                         {"efficacy_direct", 1, 1000, "lm/W"},
                                         {"efficacy_diffuse", 1, 1000, "lm/W"},
                                         {"pressure", 100, 1200, "mbar, for refraction"},
                                         {"temperature", -100, 70, "degrees C, for refraction"}}};

struct Words {
    std::string kind;
    std::map<std::string, double> number;
    std::optional<LocalTime> time;
    bool has_year = false;

    bool has(const char* name) const { return number.count(name) > 0; }
    double get(const char* name, double otherwise) const {
        const auto at = number.find(name);
        return at == number.end() ? otherwise : at->second;
    }
};

/// Parses "[YYYY-]MM-DDThh:mm[:ss]".
bool read_time(std::string_view word, Words& out) {
    std::vector<int> parts;
    std::string marks;
    while (!word.empty()) {
        int value = 0;
        const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (code != std::errc() || value < 0) return false;
        word.remove_prefix(static_cast<std::size_t>(end - word.data()));
        parts.push_back(value);
        if (word.empty()) break;
        marks += word[0] == ' ' ? 'T' : word[0];
        word.remove_prefix(1);
    }
    const bool has_seconds = marks.ends_with("::"), has_year = marks.starts_with("--");
    if (marks != std::string(has_year ? "--T:" : "-T:") + (has_seconds ? ":" : "")) return false;
    if (parts.size() != marks.size() + 1) return false;
    std::size_t i = 0;
    LocalTime time;
    if (has_year) time.year = parts[i++];
    if (!has_year && parts[i] == 2 && parts[i + 1] == 29) time.year = leap_year;
    time.month = parts[i], time.day = parts[i + 1];
    const int hour = parts[i + 2], minute = parts[i + 3], second = has_seconds ? parts[i + 4] : 0;
    if (!is_date(time.year, time.month, time.day) || hour > 24 || minute > 59 || second > 59) return false;
    time.hour = hour + minute / 60.0 + second / 3600.0;
    if (time.hour > 24) return false;
    out.time = time, out.has_year = has_year;
    return true;
}

Result<void> read_pair(const std::string& word, Words& out) {
    const std::size_t equals = word.find('=');
    if (equals == word.npos)
        return wrong(fmt::format("'{}' is not name=value", shown(word)),
                     "the kind of sky comes first, then lat=47.4, ...");
    const std::string name = word.substr(0, equals), value = word.substr(equals + 1);
    if (out.number.count(name) || (name == "time" && out.time)) return wrong(fmt::format("'{}' is given twice", name));
    if (name == "time") {
        if (read_time(value, out)) return {};
        return wrong(fmt::format("time '{}' is not a valid date and time", shown(value)),
                     "such as time=06-21T12:00 or 2024-06-21T12:00:30");
    }
    const auto known = std::find_if(numbers.begin(), numbers.end(), [&](const Named& n) { return name == n.name; });
    if (known == numbers.end()) return wrong(fmt::format("'{}' is not known", shown(name)), sky_help());
    const std::optional<double> number = parse_number(value);
    if (!number) return wrong(fmt::format("{} '{}' is not a number", name, shown(value)));
    if (!(*number >= known->least && *number <= known->most))
        return wrong(fmt::format("{} is {:g}, not from {:g} to {:g} ({})", name, *number, known->least, known->most,
                                 known->meaning));
    out.number[name] = *number;
    return {};
}

Result<Words> read_words(const std::string& text) {
    Words out;
    const std::vector<std::string> words = split_at_commas(text);
    out.kind = words.front();
    for (std::size_t i = 1; i < words.size(); ++i)
        if (const Result<void> read = read_pair(words[i], out); !read) return read.error();
    return out;
}

/// True for skies that have a sun only if its irradiance is given.
bool is_without_sun(const std::string& kind) {
    return kind == "uniform" || kind == "overcast";
}

int cie_type(const std::string& kind) {
    if (kind == "clear") return 12;
    if (!kind.starts_with("cie")) return 0;
    const auto type = parse_integer(std::string_view(kind).substr(3));
    return type && *type >= 1 && *type <= 15 ? static_cast<int>(*type) : 0;
}

/// Direction towards the sun; empty if the words do not define it.
Result<std::optional<Normal>> find_sun(const Words& words, const Weather* weather) {
    const double north = words.get("north", 0);
    if (words.has("altitude") != words.has("azimuth"))
        return wrong("the sun is given by altitude and azimuth together, or by time and place");
    if (words.has("altitude")) {
        if (words.time) return wrong("the sun is given by altitude and azimuth, and by a time as well");
        return std::optional(sky_direction(words.get("altitude", 0), words.get("azimuth", 0), north));
    }
    if (!words.time) return std::optional<Normal>();
    if (!weather && (!words.has("lat") || !words.has("lon")))
        return wrong("a time needs a place: lat and lon are missing", "lat=47.4,lon=8.5, or a weather file by --epw");
    Place place = weather ? weather->place : Place();
    place.latitude = words.get("lat", place.latitude), place.longitude = words.get("lon", place.longitude);
    place.elevation = words.get("elevation", place.elevation);
    constexpr double sea_level = 1013.25, scale_height = 8434;  // mbar, m
    place.pressure = words.get("pressure", sea_level * std::exp(-place.elevation / scale_height));
    place.temperature = words.get("temperature", place.temperature);
    LocalTime time = *words.time;
    time.zone = words.get("tz", weather ? weather->zone : std::round(place.longitude / 15));
    const SunPosition at = sun_position(time, place);
    return std::optional(sky_direction(at.altitude, at.azimuth, north));
}

/// Makes sky, sun and reflected light of the ground from irradiances in one unit.
DistantLight make_light(const SkyModel& sky, const Normal& sun, double diffuse, double direct, double ground) {
    DistantLight out;
    if (diffuse > 0) out.domes.push_back({sky, Spectrum(diffuse)});
    const double on_ground = diffuse + direct * std::max(0.0, sun.z);
    if (ground * on_ground > 0) {
        SkyModel below = uniform_sky();
        below.below = true;
        out.domes.push_back({below, Spectrum(ground * on_ground)});
    }
    if (direct > 0) out.discs.push_back({sun, sun_half_angle, Spectrum(direct)});
    return out;
}

/// Returns the hour of the weather file at the time of the words; null without a weather file.
Result<const WeatherHour*> find_hour(const Words& words, const Weather* weather) {
    if (!weather) return static_cast<const WeatherHour*>(nullptr);
    if (!words.time) return wrong("a weather file needs a time", "time=06-21T12:00");
    const WeatherHour* hour = weather->at(words.time->month, words.time->day, std::min(words.time->hour, 23.999999));
    if (!hour || hour->is_missing)
        return wrong(fmt::format("the weather file has no irradiances for {:02}-{:02}, {:.2f} h", words.time->month,
                                 words.time->day, words.time->hour));
    return hour;
}

/// Irradiances of the ground by the sky, and by the sun of a plane that faces it, W/m^2.
struct SkyIrradiances {
    double diffuse = 0, direct = 0;
};

/// Returns the irradiances of the words or else of the weather file. `hour` may be null.
Result<SkyIrradiances> find_irradiances(const Words& words, const WeatherHour* hour) {
    if (!words.has("dhi") && !hour)
        return wrong("dhi, the irradiance of the ground by the sky, is missing",
                     "dhi=120 (W/m^2), or a weather file by --epw");
    if (words.kind == "perez" && !words.has("dni") && !hour)
        return wrong("dni, the irradiance by the sun of a plane that faces it, is missing", "dni=700 (W/m^2)");
    SkyIrradiances out{words.get("dhi", hour ? hour->diffuse_horizontal : 0),
                       words.get("dni", hour ? hour->direct_normal : 0)};
    // Uniform and overcast skies have no sun by default.
    if (is_without_sun(words.kind) && !words.has("dni")) out.direct = 0;
    return out;
}

/// Returns the distribution of a sky's luminance. `cie`: its number in CIE's list, or 0.
SkyModel model_of(const Words& words, int cie, const Normal& towards, const SkyIrradiances& light) {
    if (cie > 0) return cie_sky(cie, towards);
    if (words.kind == "perez") {
        const int day = words.time ? day_of_year(words.time->year, words.time->month, words.time->day) : 80;
        return perez_sky({light.diffuse, light.direct, day}, towards);
    }
    return words.kind == "overcast" ? overcast_sky() : uniform_sky();
}

}  // namespace

std::string sky_help() {
    std::string names;
    for (const Named& n : numbers) names += fmt::format("{}{}", names.empty() ? "" : ", ", n.name);
    return fmt::format("kinds: uniform, overcast, clear, cie1 to cie15, perez, image=FILE; names: time, {}", names);
}

Result<ChosenSky> parse_sky(const std::string& text, const Weather* weather) {
    if (is_picture_sky(text)) {
        if (weather) return wrong("a weather file does not apply to a picture", "leave out the weather file (--epw)");
        return parse_picture_sky(text);
    }
    const Result<Words> read = read_words(text);
    if (!read) return read.error();
    const Words& words = *read;
    const bool perez = words.kind == "perez";
    const int type = cie_type(words.kind);
    if (!perez && !is_without_sun(words.kind) && type == 0)
        return wrong(fmt::format("'{}' is not a kind of sky", shown(words.kind)), sky_help());
    const Result<std::optional<Normal>> sun = find_sun(words, weather);
    if (!sun) return sun.error();

    const Result<const WeatherHour*> hour = find_hour(words, weather);
    if (!hour) return hour.error();
    const Result<SkyIrradiances> found = find_irradiances(words, *hour);
    if (!found) return found.error();
    SkyIrradiances light = *found;
    const bool goes_by_sun = perez || light.direct > 0 || (type > 0 && !(type == 1 || type == 3 || type == 5));
    if (goes_by_sun && !*sun)
        return wrong(fmt::format("where the sun stands is missing for {}", words.kind),
                     "altitude=50,azimuth=180, or lat=47.4,lon=8.5,time=06-21T12:00");
    const Normal towards = sun->value_or(Normal{0, 0, 1});
    const double half_disc = sun_half_angle * 180 / pi;
    if (light.direct > 0 && towards.z <= -std::sin(half_disc * pi / 180)) {
        if (words.has("dni")) return wrong("the sun is below the horizon, and dni is not 0");
        light.direct = 0;
    }
    SkyModel sky = model_of(words, type, towards, light);
    if (!sky.normalize()) return wrong("this sky has no light");
    const double ground = words.get("ground", default_ground);
    const bool in_lumens = words.has("efficacy_direct") || words.has("efficacy_diffuse");
    ChosenSky out;
    out.in_watts = make_light(sky, towards, light.diffuse, light.direct, ground);
    out.in_lumens = make_light(sky, towards, words.get("efficacy_diffuse", efficacy_of_sky) * light.diffuse,
                               words.get("efficacy_direct", efficacy_of_sun) * light.direct, ground);
    if (in_lumens) out.photometric = true;
    if (out.in_watts.empty()) return wrong("this sky has no light", "it is night, or dhi and dni are 0");
    return out;
}

}  // namespace exitance
