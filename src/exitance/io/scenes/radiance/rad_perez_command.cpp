#include "exitance/io/scenes/radiance/rad_perez_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/scene/sky/perez_sky.hpp"

namespace exitance {
namespace {

constexpr double solar_irradiance = 1367, solar_illuminance = 127'500;  ///< W/m^2 and lx, outside the atmosphere.
constexpr double lumens_per_watt = 179;                                 ///< Radiance's white.
constexpr double water = 2;                                             ///< cm of it in the air.

/// Sky and sun as Perez' model takes them.
struct Perez {
    double zenith_angle = 0;  ///< Of the sun, radians.
    int day = 150;
    double diffuse = 0, direct = 0;  ///< W/m^2, horizontal and normal.
    double clearness = 1, brightness = 0.01;

    double cubed() const { return 1.041 * std::pow(zenith_angle, 3); }
    /// Irradiance outside the atmosphere over the air's optical mass [Kasten66].
    double reference() const {
        const double degrees = zenith_angle * 180 / pi, angle = 2 * pi * (day - 1) / 365;
        const double mass = 1 / (std::cos(zenith_angle) + 0.15 * std::pow(93.885 - degrees, -1.253));
        const double orbit = 1.00011 + 0.034221 * std::cos(angle) + 0.00128 * std::sin(angle) +
                             0.000719 * std::cos(2 * angle) + 0.000077 * std::sin(2 * angle);
        return solar_irradiance * orbit / mass;
    }
    void find_parameters() {
        brightness = diffuse / reference();
        clearness = ((diffuse + direct) / diffuse + cubed()) / (1 + cubed());
        limit();
    }
    void limit() { clearness = std::clamp(clearness, 1.0, 12.01), brightness = std::clamp(brightness, 0.01, 0.6); }
};

std::size_t bin_of(double clearness) {
    constexpr std::array<double, 7> bounds{1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};
    return static_cast<std::size_t>(std::upper_bound(bounds.begin(), bounds.end(), clearness) - bounds.begin());
}

using Row = std::array<double, 4>;

/// lm/W of the sky's light on a horizontal plane [Perez90].
double diffuse_efficacy(const Perez& p) {
    constexpr std::array<Row, 8> rows{{{97.24, -0.46, 12.00, -8.91},
                                       {107.22, 1.15, 0.59, -3.95},
                                       {104.97, 2.96, -5.53, -8.77},
                                       {102.39, 5.59, -13.95, -13.90},
                                       {100.71, 5.94, -22.75, -23.74},
                                       {106.42, 3.83, -36.15, -28.83},
                                       {141.88, 1.90, -53.24, -14.03},
                                       {152.23, 0.35, -45.27, -7.98}}};
    const Row& r = rows[bin_of(p.clearness)];
    return r[0] + r[1] * water + r[2] * std::cos(p.zenith_angle) + r[3] * std::log(p.brightness);
}

/// lm/W of the sun's [Perez90].
double direct_efficacy(const Perez& p) {
    constexpr std::array<Row, 8> rows{{{57.20, -4.55, -2.98, 117.12},
                                       {98.99, -3.46, -1.21, 12.38},
                                       {109.83, -4.90, -1.71, -8.81},
                                       {110.34, -5.84, -1.99, -4.56},
                                       {106.36, -3.97, -1.75, -6.16},
                                       {107.19, -1.25, -1.51, -26.73},
                                       {105.75, 0.77, -1.26, -34.44},
                                       {101.18, 1.58, -1.10, -8.29}}};
    const Row& r = rows[bin_of(p.clearness)];
    return std::max(0.0, r[0] + r[1] * water + r[2] * std::exp(5.73 * p.zenith_angle - 5) + r[3] * p.brightness);
}

/// Irradiances of which the illuminances are known; the efficacies depend on them.
void find_irradiances(double direct, double diffuse, Perez& p) {
    const auto look = [&] {
        p.find_parameters();
        p.clearness = std::min(p.clearness, 12.0);
        if (p.brightness < 0.05) p.brightness = 0.01;
    };
    p.diffuse = diffuse * solar_irradiance / solar_illuminance,
    p.direct = direct * solar_irradiance / solar_illuminance;
    look();
    constexpr int rounds = 5;  // as the program has it
    for (int i = 0; i < rounds; ++i) {
        const double of_sky = diffuse_efficacy(p), of_sun = direct_efficacy(p);
        p.diffuse = diffuse / of_sky, p.direct = of_sun > 0 ? direct / of_sun : 0;
        look();
    }
    p.limit();
}

/// The sum over Tregenza's 145 directions by which gendaylit scales its sky: about its horizontal irradiance.
double tregenza_sum(const SkyModel& sky) {
    constexpr std::array<int, 8> patches{30, 30, 24, 24, 18, 12, 6, 1};
    const double towards_sun = std::atan2(sky.sun.y, sky.sun.x);
    double sum = 0;
    for (std::size_t row = 0; row < patches.size(); ++row) {
        const double zenith = (84 - 12 * static_cast<double>(row)) * pi / 180;
        for (int i = 0; i < patches[row]; ++i) {
            const double phi = towards_sun + 2 * pi * i / patches[row], s = std::sin(zenith), c = std::cos(zenith);
            sum += c * sky.value({s * std::cos(phi), s * std::sin(phi), c});
        }
    }
    return sum * 2 * pi / 145;
}

Error wrong(std::string message, std::string hint = "") {
    return {ErrorCode::bad_input, "gendaylit: " + message, "", std::move(hint)};
}

/// Its two numbers as irradiances and parameters.
Result<Perez> read_input(const RadSkyWords& in) {
    Perez p;
    p.zenith_angle = 0.5 * pi - in.altitude;
    if (in.month > 0) p.day = day_of_year(2021, in.month, in.day);
    if (!(in.altitude > 0))
        return wrong(fmt::format("the sun stands {:.2f} degrees below the horizon", -in.altitude * 180 / pi),
                     "Perez' sky has no formula for that");
    switch (in.input) {
        case 'P':
            if (!(in.first >= 1) || !(in.second > 0)) return wrong("-P needs clearness from 1 and brightness above 0");
            p.clearness = in.first, p.brightness = in.second;
            p.limit();
            p.diffuse = p.brightness * p.reference();
            p.direct = p.diffuse * (p.clearness - 1) * (1 + p.cubed());
            return p;
        case 'W':
        case 'G':
        case 'L': {
            const double direct = in.input == 'G' ? in.first / std::sin(in.altitude) : in.first;
            const double most = in.input == 'L' ? solar_illuminance : solar_irradiance;
            if (!(direct >= 0 && direct <= most) || !(in.second > 0 && in.second <= most))
                return wrong(
                    fmt::format("-{} {:g} {:g}: direct light from 0 and diffuse light above 0, both to {:g}, "
                                "are needed",
                                in.input, in.first, in.second, most));
            if (in.input == 'L') {
                find_irradiances(direct, in.second, p);
            } else {
                p.direct = direct, p.diffuse = in.second;
                p.find_parameters();
            }
            return p;
        }
        default:
            return wrong("the light is missing", "-P clearness brightness, -W or -G direct diffuse (W/m^2), -L (lx)");
    }
}

}  // namespace

std::pair<double, double> rad_sky_factors(char kind, double altitude) {
    if (kind == 'u') return {0, 1};
    if (kind == 'c') return {0, 7.0 / 9};
    constexpr std::array<double, 5> clear{2.766521, 0.547665, -0.369832, 0.009237, 0.059229},
        intermediate{3.5556, -2.7152, -1.3081, 1.0660, 0.60227};
    const double z = std::sin(altitude), from_zenith = 0.5 * pi - altitude, x = altitude / (pi / 4) - 1;
    const std::array<double, 5>& k = kind == 'i' ? intermediate : clear;
    const double f2 = kind == 'i' ? (2.739 + 0.9891 * std::sin(0.3119 + 2.6 * altitude)) *
                                        std::exp(-from_zenith * (0.4441 + 1.48 * altitude))
                                  : 0.274 * (0.91 + 10 * std::exp(-3 * from_zenith) + 0.45 * z * z);
    double sum = 0;
    for (std::size_t i = k.size(); i-- > 0;) sum = sum * x + k[i];
    return {f2, sum / f2 / pi};
}

std::string rad_sun(double radiance, const Vec3& towards, double angle) {
    return fmt::format("void light solar\n0\n0\n3 {0:.9g} {0:.9g} {0:.9g}\n", radiance) +
           fmt::format("solar source sun\n0\n0\n4 {:.9g} {:.9g} {:.9g} {:g}\n", towards.x, towards.y, towards.z, angle);
}

Result<std::string> gendaylit_output(const RadSkyWords& in) {
    if (in.output != 0 && in.output != 1 && in.output != 2) return wrong("-O is 0, 1 or 2");
    const Result<Perez> read = read_input(in);
    if (!read) return read.error();
    const Perez& p = *read;
    const Vec3 sun = in.sun();
    const SkyModel sky = perez_sky_of({p.clearness, p.brightness}, sun);
    double diffuse = p.diffuse, direct = p.direct;
    if (in.output != 1) {
        const double unit = in.output == 0 ? lumens_per_watt : 1;
        diffuse = (in.input == 'L' ? in.second : diffuse * diffuse_efficacy(p)) / unit;
        direct = (in.input == 'L' ? in.first : direct * direct_efficacy(p)) / unit;
    }
    const double scale = diffuse / tregenza_sum(sky);
    const double solar = direct / (2 * pi * (1 - std::cos(sun_half_angle)));
    const bool has_sun = in.has_sun && p.clearness > 1;
    const char kind = p.clearness <= 1 ? 'c' : p.clearness < 6 ? 'i' : 's';
    double ground = scale * sky.value({0, 0, 1}) * rad_sky_factors(kind, in.altitude).second;
    if (has_sun) ground += 6.8e-5 / pi * solar * sun.z;
    std::string out = has_sun && solar > 0 ? rad_sun(solar, sun, 2 * 0.2665) : "";
    out += "void brightfunc skyfunc\n2 skybright perezlum.cal\n0\n";
    out += fmt::format("10 {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", scale,
                       in.ground * ground, sky.a, sky.b, sky.c, sky.d, sky.e, sun.x, sun.y, sun.z);
    return out;
}

}  // namespace exitance
