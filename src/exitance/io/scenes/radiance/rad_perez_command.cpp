#include "exitance/io/scenes/radiance/rad_perez_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/scene/sky/perez_sky.hpp"

namespace exitance {
namespace {

constexpr double solar_irradiance = 1367, solar_illuminance = 127'500;  ///< Outside the atmosphere, W/m^2 and lx.
constexpr double lumens_per_watt = 179;  ///< Radiance's luminous efficacy of white light.

/// Sky and sun in the parameters of Perez' model.
struct Perez {
    double zenith_angle = 0;         ///< Angle of the sun from the zenith, radians, at most pi / 2.
    int day = 0;                     ///< Day of the year, from 1.
    double water = 2;                ///< Precipitable water, cm.
    double diffuse = 0, direct = 0;  ///< Horizontal and normal irradiance, W/m^2.
    double diffuse_lux = 0, direct_lux = 0;
    double clearness = 1, brightness = 0.01;

    double cubed() const { return 1.041 * std::pow(zenith_angle, 3); }
    /// Solar irradiance outside the atmosphere, W/m^2, at the Earth's distance on that day.
    double extraterrestrial() const {
        const double angle = 2 * pi * (day - 1) / 365;
        return solar_irradiance * (1.00011 + 0.034221 * std::cos(angle) + 0.00128 * std::sin(angle) +
                                   0.000719 * std::cos(2 * angle) + 0.000077 * std::sin(2 * angle));
    }
    /// Extraterrestrial irradiance divided by the optical air mass [Kasten66].
    double reference() const {
        const double mass = 1 / (std::cos(zenith_angle) + 0.15 * std::pow(93.885 - zenith_angle * 180 / pi, -1.253));
        return extraterrestrial() / mass;
    }
    void find_parameters() {
        brightness = diffuse / reference();
        clearness = ((diffuse + direct) / diffuse + cubed()) / (1 + cubed());
        limit();
    }
    /// Clamps to the ranges of gendaylit. Without any light the clearness is NaN and stays NaN.
    void limit() {
        constexpr double clearest = 12.01, of_clearer = clearest - 0.001;
        clearness = clearness > clearest ? of_clearer : clearness < 1 ? 1 : clearness;
        brightness = std::clamp(brightness, 0.01, 0.6);
    }
};

std::size_t bin_of(double clearness) {
    constexpr std::array<double, 7> bounds{1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};
    return static_cast<std::size_t>(std::upper_bound(bounds.begin(), bounds.end(), clearness) - bounds.begin());
}

using Row = std::array<double, 4>;

/// Luminous efficacy of sky light on a horizontal plane, lm/W [Perez90].
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
    return r[0] + r[1] * p.water + r[2] * std::cos(p.zenith_angle) + r[3] * std::log(p.brightness);
}

/// Luminous efficacy of sun light, lm/W [Perez90].
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
    return std::max(0.0, r[0] + r[1] * p.water + r[2] * std::exp(5.73 * p.zenith_angle - 5) + r[3] * p.brightness);
}

/// Computes irradiances from illuminances by iteration, since the efficacies depend on the irradiances.
void find_irradiances(Perez& p) {
    p.diffuse = p.diffuse_lux * solar_irradiance / solar_illuminance;
    p.direct = p.direct_lux * solar_irradiance / solar_illuminance;
    p.find_parameters();
    constexpr int rounds = 9;             // number of iterations, as in gendaylit
    constexpr double min_efficacy = 0.1;  // lm/W; below it, gendaylit ignores the sun
    for (int i = 0; i < rounds; ++i) {
        const double of_sky = diffuse_efficacy(p), of_sun = direct_efficacy(p);
        p.diffuse = p.diffuse_lux / of_sky, p.direct = of_sun < min_efficacy ? 0 : p.direct_lux / of_sun;
        p.find_parameters();
    }
}

/// Splits global horizontal irradiance into diffuse and direct light [Erbs82].
void split_global(double global, double sine, Perez& p) {
    const double outside = p.extraterrestrial() * sine, k = std::min(global, 0.999 * outside) / outside;
    const double share = k <= 0.22  ? 1 - 0.09 * k
                         : k <= 0.8 ? 0.9511 + k * (-0.1604 + k * (4.388 + k * (-16.638 + k * 12.336)))
                                    : 0.165;
    p.diffuse = share * k * outside, p.direct = (1 - share) * k * outside / sine;
}

/// Sum over Tregenza's 145 directions by which gendaylit scales its sky: an approximation of its horizontal irradiance.
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

/// Reason why gendaylit prints a sky without light; empty if it has light.
std::string darkness(const RadSkyWords& in, const Perez& p) {
    const bool in_lux = in.input == 'L';
    const double direct = in_lux ? p.direct_lux : p.direct, diffuse = in_lux ? p.diffuse_lux : p.diffuse;
    if (!(direct + diffuse > 0)) return in.altitude > 0 ? "there is neither direct nor diffuse light" : "it is night";
    if (direct > (in_lux ? solar_illuminance : solar_irradiance))
        return fmt::format("direct light of {:g} {} is more than arrives outside the atmosphere", direct,
                           in_lux ? "lx" : "W/m^2");
    if (in.output != 1 && p.direct_lux > solar_illuminance)
        return fmt::format("direct light of {:g} lx is more than arrives outside the atmosphere", p.direct_lux);
    return "";
}

/// Converts the numbers of the line to irradiances, illuminances and parameters.
Result<Perez> read_input(const RadSkyWords& in) {
    Perez p;
    p.zenith_angle = std::min(0.5 * pi - in.altitude, 0.5 * pi);
    constexpr int day_of_angles = 0, day_of_angles_before = 150;  // the programs' days for lines without a date
    p.day = in.month > 0 ? day_of_year(2021, in.month, in.day) : in.older ? day_of_angles_before : day_of_angles;
    p.water = std::exp(0.07 * in.dew_point - 0.075);
    const double first = std::max(0.0, in.first), second = std::max(0.0, in.second), sine = std::sin(in.altitude);
    switch (in.input) {
        case 'P':
            p.clearness = in.first, p.brightness = in.second;
            p.limit();
            p.diffuse = p.brightness * p.reference();
            p.direct = p.diffuse * (p.clearness - 1) * (1 + p.cubed());
            break;
        case 'W':
            p.direct = first, p.diffuse = second;
            break;
        case 'G':
            if (sine > 0) p.direct = first / sine, p.diffuse = second;
            break;
        case 'E':
            if (sine > 0) split_global(first, sine, p);
            break;
        case 'L':
            p.direct_lux = first, p.diffuse_lux = second;
            if (first + second > 0) find_irradiances(p);
            return p;
        default:
            return wrong("the light is missing",
                         "-P clearness brightness, -W or -G direct diffuse (W/m^2), -L (lx), -E global (W/m^2)");
    }
    if (!(p.direct + p.diffuse > 0)) return p;
    if (in.input != 'P') p.find_parameters();
    p.diffuse_lux = p.diffuse * diffuse_efficacy(p), p.direct_lux = p.direct * direct_efficacy(p);
    return p;
}

/// Formats the brightness function. `k`: scale, ground, and Perez' a to e.
std::string perez_function(const std::array<double, 7>& k, const Vec3& sun) {
    std::string out = "void brightfunc skyfunc\n2 skybright perezlum.cal\n0\n10";
    for (const double v : k) out += fmt::format(" {:.9g}", v);
    return out + fmt::format(" {:.9g} {:.9g} {:.9g}\n", sun.x, sun.y, sun.z);
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

Result<PrintedSky> gendaylit_output(const RadSkyWords& in) {
    if (in.output != 0 && in.output != 1 && in.output != 2) return wrong("-O is 0, 1 or 2");
    const Result<Perez> read = read_input(in);
    if (!read) return read.error();
    const Perez& p = *read;
    const Vec3 sun = in.sun();
    std::string dark = in.is_night ? "the sun is below the horizon at that hour" : darkness(in, p);
    Normal above = sun;  // direction of the sun, or its projection to the horizon if the sun is below it
    if (above.z < 0) above = {-std::sin(in.azimuth), -std::cos(in.azimuth), 0};
    const SkyModel sky = perez_sky_of({p.clearness, p.brightness}, above);
    if (dark.empty() && sky.b > 0) dark = "Perez' sky has no such state";
    if (!dark.empty())
        return PrintedSky{perez_function({}, sun),
                          {fmt::format("gendaylit: {}: the sky has no light, as the program prints it", dark)}};
    double diffuse = p.diffuse, direct = p.direct;
    if (in.output != 1) {
        const double unit = in.output == 0 ? lumens_per_watt : 1;
        diffuse = p.diffuse_lux / unit, direct = p.direct_lux / unit;
    }
    const double scale = diffuse / tregenza_sum(sky);
    const double solar = direct / (2 * pi * (1 - std::cos(sun_half_angle)));
    const bool has_sun = in.has_sun && p.clearness > 1;
    const char kind = p.clearness <= 1 ? 'c' : p.clearness < 6 ? 'i' : 's';
    double ground = scale * sky.value({0, 0, 1}) * rad_sky_factors(kind, in.altitude).second;
    if (has_sun) ground += 6.8e-5 / pi * solar * sun.z;
    const bool shines = has_sun && solar > 0;
    PrintedSky out{shines ? rad_sun(solar, sun, 2 * 0.2665) : in.has_sun ? "void light solar\n0\n0\n3 0 0 0\n" : ""};
    out.text += perez_function({scale, in.ground * ground, sky.a, sky.b, sky.c, sky.d, sky.e}, sun);
    return out;
}

}  // namespace exitance
