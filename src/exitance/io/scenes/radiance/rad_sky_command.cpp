#include "exitance/io/scenes/radiance/rad_sky_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/scenes/radiance/rad_perez_command.hpp"
#include "exitance/io/scenes/radiance/rad_sky_sun.hpp"

namespace exitance {
namespace {

Error wrong(const RadSkyWords& in, std::string message, std::string hint = "") {
    return {ErrorCode::bad_input, fmt::format("{}: {}", in.program, message), "", std::move(hint)};
}

/// Time zone names with their meridians, degrees west.
struct Zone {
    const char* name;
    double meridian;
};
constexpr std::array<Zone, 27> zones{
    {{"YST", 135}, {"YDT", 120},   {"PST", 120},   {"PDT", 105},  {"MST", 105},   {"MDT", 90},   {"CST", 90},
     {"CDT", 75},  {"EST", 75},    {"EDT", 60},    {"AST", 60},   {"ADT", 45},    {"NST", 52.5}, {"NDT", 37.5},
     {"GMT", 0},   {"BST", -15},   {"CET", -15},   {"CEST", -30}, {"EET", -30},   {"EEST", -45}, {"GST", -60},
     {"GDT", -75}, {"IST", -82.5}, {"IDT", -97.5}, {"JST", -135}, {"NZST", -180}, {"NZDT", -195}}};

/// Checks an hour for gendaylit, which only reads numbers from 0 to below 24: it takes "14:30EST" as 14 without a
/// warning.
Result<void> read_plain_hour(double hour, bool goes_on, RadSkyWords& out) {
    if (goes_on)
        return wrong(out, "minutes after ':' and names of time zones are not read, and the program ignores them",
                     "write 14.5 for 14:30, and -m for the zone's meridian");
    if (!(hour < 24)) return wrong(out, "the hour is not below 24");
    return {};
}

/// Parses "14", "14.5", "14:30", "14:30EDT", "+14.5" (solar time).
Result<void> read_hour(std::string_view word, RadSkyWords& out) {
    const Error bad = wrong(out, fmt::format("'{}' is not a time", shown(std::string(word))),
                            "such as 14.5, 14:30, 14:30EST, or +14.5 for solar time");
    if (word.starts_with('+')) out.is_solar_time = true, word.remove_prefix(1);
    const std::size_t digits = std::min(word.find_first_not_of("0123456789.:"), word.size());
    std::string_view number = word.substr(0, digits);
    std::string zone(word.substr(digits));
    for (char& c : zone) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const std::size_t colon = number.find(':');
    const std::optional<double> hour = parse_number(number.substr(0, colon));
    const std::optional<double> minute =
        colon == std::string_view::npos ? std::optional(0.0) : parse_number(number.substr(colon + 1));
    if (!hour || !minute || !(*minute < 60) || !(*hour + *minute / 60 <= 24)) return bad;
    out.hour = *hour + *minute / 60;
    if (out.program == "gendaylit") return read_plain_hour(*hour, !zone.empty() || colon != number.npos, out);
    if (zone.empty()) return {};
    const auto* known = std::find_if(zones.begin(), zones.end(), [&](const Zone& z) { return zone == z.name; });
    if (known == zones.end() || out.is_solar_time) return bad;
    out.meridian = known->meridian, out.has_meridian = true;
    return {};
}

/// Reads month, day and time, or the sun's angles; options follow.
Result<RadSkyWords> read_head(const CommandWords& words) {
    RadSkyWords out;
    out.program = words[0];
    if (words.size() >= 2 && words[1] == "-defaults") return wrong(out, "-defaults makes no sky");
    if (words.size() < 4) return wrong(out, "month, day and time are missing", "or -ang ALTITUDE AZIMUTH");
    if (words[1] == "-ang") {
        const std::optional<double> altitude = parse_number(words[2]), azimuth = parse_number(words[3]);
        if (!altitude || !azimuth || !(std::abs(*altitude) <= 90) || !(std::abs(*azimuth) <= 720))
            return wrong(out, fmt::format("'-ang {} {}' is not an altitude and an azimuth in degrees", shown(words[2]),
                                          shown(words[3])));
        out.altitude = *altitude * pi / 180, out.azimuth = *azimuth * pi / 180;
        out.has_angles = true;
    } else {
        const auto month = parse_integer(words[1]), day = parse_integer(words[2]);
        if (!month || !day || *month < 1 || *month > 12 || *day < 1 || *day > 31)
            return wrong(out, fmt::format("'{} {}' is not a month and a day", shown(words[1]), shown(words[2])));
        out.month = static_cast<int>(*month), out.day = static_cast<int>(*day);
        if (const Result<void> read = read_hour(words[3], out); !read) return read.error();
    }
    return out;
}

/// Reads the word after an option as a number.
Result<double> number_after(const CommandWords& words, std::size_t& i, const RadSkyWords& in) {
    const std::string option = words[i];
    const std::optional<double> value = ++i < words.size() ? parse_number(words[i]) : std::nullopt;
    if (!value || !std::isfinite(*value)) return wrong(in, fmt::format("{} needs a number", shown(option)));
    return *value;
}

/// Stores the number of an option.
void take_number(char option, double value, RadSkyWords& out) {
    switch (option) {
        case 'g':
            out.ground = value;
            return;
        case 'a':
            out.latitude = value * pi / 180;
            return;
        case 'o':
            out.longitude = value;
            return;
        case 'm':
            if (!out.has_meridian) out.meridian = value;
            return;  // a time zone's name has priority
        case 'y':
            out.year = static_cast<int>(std::clamp(value, -9999.0, 9999.0));
            return;
        case 't':
            out.turbidity = value;
            return;
        case 'O':
            out.output = value;
            return;
        case 'd':
            if (std::abs(value) <= 40) out.dew_point = value;  // like gendaylit, ignore values beyond 40
            return;
        case 'E':
            out.input = 'E', out.first = value;
            return;
        case 'i':
            out.interval = value;
            return;
        case 'b':
        case 'B':
            out.zenith = value, out.zenith_by = option;
            return;
        default:
            out.solar = value, out.solar_by = option;
    }
}

Result<void> check_options(const RadSkyWords& in) {
    if (!(in.ground >= 0 && in.ground <= 1)) return wrong(in, fmt::format("-g {:g} is not a reflectance", in.ground));
    if (!(std::abs(in.latitude) <= 0.5 * pi)) return wrong(in, "-a is not in [-90, 90]");
    if (!(std::abs(in.longitude) <= 360) || !(std::abs(in.meridian) <= 360))
        return wrong(in, "-o and -m are not in [-360, 360]");
    if (in.year && !is_date(*in.year, in.month ? in.month : 1, in.month ? in.day : 1))
        return wrong(in, fmt::format("{}-{}-{} is not a date", *in.year, in.month, in.day));
    if (in.zenith < 0 || in.solar < 0) return wrong(in, "a brightness is negative");
    if (in.interval < 0) return wrong(in, "-i lies below 0");
    if (in.older && in.year) return wrong(in, "-y is not an option of the programs before November 2019");
    return {};
}

Result<void> read_options(const CommandWords& words, RadSkyWords& out) {
    const bool perez = out.program == "gendaylit";
    const std::string plain = perez ? "swc" : "sicu", numbers = perez ? "gaomyOdEi" : "gaomytbBrR";
    const std::string pairs = perez ? "PWLG" : "";
    for (std::size_t i = 4; i < words.size(); ++i) {
        const std::string& w = words[i];
        const char c = w.size() == 2 && (w[0] == '-' || w[0] == '+') ? w[1] : ' ';
        if (plain.find(c) != std::string::npos) {
            if (c == 'w') continue;
            out.kind = c;
            if (c == 's' || c == 'i') out.has_sun = w[0] == '+';
            if (c == 'c' && perez) out.has_sun = false;
        } else if (w[0] == '-' && pairs.find(c) != std::string::npos) {
            const Result<double> first = number_after(words, i, out);
            if (!first) return first.error();
            const std::optional<double> second = ++i < words.size() ? parse_number(words[i]) : std::nullopt;
            if (!second || !std::isfinite(*second)) return wrong(out, fmt::format("-{} needs two numbers", c));
            out.input = c, out.first = *first, out.second = *second;
        } else if (w[0] == '-' && numbers.find(c) != std::string::npos) {
            const Result<double> value = number_after(words, i, out);
            if (!value) return value.error();
            take_number(c, *value, out);
        } else {
            return wrong(out, fmt::format("option '{}' is not read", shown(w)),
                         "--run-commands runs the installed program instead");
        }
    }
    return check_options(out);
}

std::string gensky(const RadSkyWords& in) {
    constexpr double sky_efficacy = 203, sun_efficacy = 208;  // lm/W
    constexpr double sun_solid_angle = 6e-5, sun_of_0p5_degrees = 5.98e-5;
    const bool overcast = in.kind == 'c' || in.kind == 'u';
    const auto [f2, factor] = rad_sky_factors(in.kind, in.altitude);
    const double z = in.sun().z;
    double zenith = in.zenith;
    if (in.zenith_by == 'B') zenith /= factor * pi;
    if (in.zenith_by == 0) {
        const double by_sun = 8.6 * z + 0.123;
        zenith = overcast ? by_sun : (1.376 * in.turbidity - 1.81) * std::tan(in.altitude) + 0.38;
        if (in.kind == 'i') zenith = 0.5 * (zenith + by_sun);
        zenith = std::max(0.0, zenith) * 1000 / sky_efficacy;
    }
    double ground = zenith * factor, solar = in.solar;
    const bool shines = !overcast && z > 0 && (in.solar_by == 0 || solar > 0);
    if (shines) {
        if (in.solar_by == 'R') solar /= sun_of_0p5_degrees * z;
        if (in.solar_by == 0)
            solar = 1.5e9 / sun_efficacy * (1.147 - 0.147 / std::max(z, 0.16)) * (in.kind == 'i' ? 0.15 : 1);
        ground += sun_solid_angle / pi * solar * z;
    }
    std::string out = shines && in.has_sun ? rad_sun(solar, in.sun(), 0.5) : "";
    const int kind = in.kind == 's' ? 1 : in.kind == 'c' ? 2 : in.kind == 'u' ? 3 : 4;
    out += "void brightfunc skyfunc\n2 skybr skybright.cal\n0\n";
    ground *= in.ground;
    if (overcast) return out + fmt::format("3 {} {:.9g} {:.9g}\n", kind, zenith, ground);
    return out + fmt::format("7 {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", kind, zenith, ground, f2, in.sun().x,
                             in.sun().y, z);
}

}  // namespace

bool is_sky_command(const CommandWords& words) {
    return !words.empty() && (words[0] == "gensky" || words[0] == "gendaylit");
}

Result<PrintedSky> sky_command_output(const CommandWords& words, bool older) {
    Result<RadSkyWords> in = read_head(words);
    if (!in) return in.error();
    in->older = older;
    if (const Result<void> read = read_options(words, *in); !read) return read.error();
    place_rad_sun(*in);
    const bool overcast = in->kind == 'c' || in->kind == 'u';
    constexpr double max_altitude = 87 * pi / 180;  // given by a limit in both programs
    if (!overcast) in->altitude = std::min(in->altitude, max_altitude);
    return in->program == "gendaylit" ? gendaylit_output(*in) : PrintedSky{gensky(*in)};
}

}  // namespace exitance
