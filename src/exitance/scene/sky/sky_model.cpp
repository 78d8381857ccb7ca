#include "exitance/scene/sky/sky_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/scene/sky/perez_sky.hpp"
#include "exitance/scene/sky/sky_picture.hpp"

namespace exitance {
namespace {

constexpr double min_cosine = 0.01;  ///< Lower limit of cos Z, as in common programs.
constexpr double max_smooth_width = 30 * pi / 180;

/// The CIE intermediate sky (Matsuura), as in Radiance's skybright.cal.
double intermediate_value(double cos_z, double gamma, double cos_sun) {
    const double eta = std::acos(std::clamp(cos_z, -1.0, 1.0)), zt = std::acos(std::clamp(cos_sun, -1.0, 1.0));
    return ((1.35 * std::sin(5.631 - 3.59 * eta) + 3.12) * std::sin(4.396 - 2.6 * zt) + 6.37 - eta) / 2.326 *
           std::exp(gamma * -0.563 * ((2.629 - eta) * (1.562 - zt) + 0.812));
}

/// Cosine-weighted mean over a half of the directions, in Z and the normalized azimuth v: adaptive three-point Gauss
/// rule.
class CosineMean {
  public:
    explicit CosineMean(const SkyModel& sky) : sky_(sky), azimuth_(std::atan2(sky.sun.y, sky.sun.x)) {}
    double operator()() {
        constexpr int rows = 6, columns = 8;
        std::array<double, rows * columns> whole{};
        const auto cell = [](int i) { return Cell{i / columns * high, (i % columns) * wide, high, wide}; };
        double sum = 0, all = 0;
        for (int i = 0; i < rows * columns; ++i) all += std::abs(whole[static_cast<std::size_t>(i)] = rule(cell(i)));
        allowed_ = accepted * all;
        for (int i = 0; i < rows * columns; ++i) sum += part(cell(i), whole[static_cast<std::size_t>(i)], 0);
        return sum;
    }

  private:
    static constexpr double high = 0.5 * pi / 6, wide = 1.0 / 8;
    /// Difference between a cell and its quarters; the error of the quarters is far less.
    static constexpr double accepted = 1e-6;
    struct Cell {
        double z, v, dz, dv;
    };
    double at(double zenith, double v) const {
        const double s = std::sin(zenith), z = std::cos(zenith), phi = azimuth_ + 2 * pi * v;
        return 2 * s * z * sky_.value({s * std::cos(phi), s * std::sin(phi), sky_.below ? -z : z});
    }
    double rule(const Cell& c) const {
        static const double g = 0.5 * std::sqrt(0.6);
        const std::array<double, 3> x{0.5 - g, 0.5, 0.5 + g}, w{5.0 / 18, 8.0 / 18, 5.0 / 18};
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) sum += w[i] * w[k] * at(c.z + x[i] * c.dz, c.v + x[k] * c.dv);
        return sum * c.dz * c.dv;
    }
    double part(const Cell& c, double whole, int depth) const {
        constexpr int deepest = 8;
        const double hz = 0.5 * c.dz, hv = 0.5 * c.dv;
        const std::array<Cell, 4> cells{Cell{c.z, c.v, hz, hv}, Cell{c.z + hz, c.v, hz, hv},
                                        Cell{c.z, c.v + hv, hz, hv}, Cell{c.z + hz, c.v + hv, hz, hv}};
        std::array<double, 4> quarter{};
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += quarter[i] = rule(cells[i]);
        if (depth == deepest || std::abs(sum - whole) <= allowed_) return sum;
        double out = 0;
        for (std::size_t i = 0; i < 4; ++i) out += part(cells[i], quarter[i], depth + 1);
        return out;
    }

    const SkyModel& sky_;
    double azimuth_, allowed_ = 0;
};

/// Coefficients x1 to x4 of a, b, c, d, e in each bin of clearness [Perez93].
constexpr double perez_table[8][5][4] = {
    {{1.3525, -0.2576, -0.2690, -1.4366},
     {-0.7670, 0.0007, 1.2734, -0.1233},
     {2.8000, 0.6004, 1.2375, 1.0000},
     {1.8734, 0.6297, 0.9738, 0.2809},
     {0.0356, -0.1246, -0.5718, 0.9938}},
    {{-1.2219, -0.7730, 1.4148, 1.1016},
     {-0.2054, 0.0367, -3.9128, 0.9156},
     {6.9750, 0.1774, 6.4477, -0.1239},
     {-1.5798, -0.5081, -1.7812, 0.1080},
     {0.2624, 0.0672, -0.2190, -0.4285}},
    {{-1.1000, -0.2515, 0.8952, 0.0156},
     {0.2782, -0.1812, -4.5000, 1.1766},
     {24.7219, -13.0812, -37.7000, 34.8438},
     {-5.0000, 1.5218, 3.9229, -2.6204},
     {-0.0156, 0.1597, 0.4199, -0.5562}},
    {{-0.5484, -0.6654, -0.2672, 0.7117},
     {0.7234, -0.6219, -5.6812, 2.6297},
     {33.3389, -18.3000, -62.2500, 52.0781},
     {-3.5000, 0.0016, 1.1477, 0.1062},
     {0.4659, -0.3296, -0.0876, -0.0329}},
    {{-0.6000, -0.3566, -2.5000, 2.3250},
     {0.2937, 0.0496, -5.6812, 1.8415},
     {21.0000, -4.7656, -21.5906, 7.2492},
     {-3.5000, -0.1554, 1.4062, 0.3988},
     {0.0032, 0.0766, -0.0656, -0.1294}},
    {{-1.0156, -0.3670, 1.0078, 1.4051},
     {0.2875, -0.5328, -3.8500, 3.3750},
     {14.0000, -0.9999, -7.1406, 7.5469},
     {-3.4000, -0.1078, -1.0750, 1.5702},
     {-0.0672, 0.4016, 0.3017, -0.4844}},
    {{-1.0000, 0.0211, 0.5025, -0.5119},
     {-0.3000, 0.1922, 0.7023, -1.6317},
     {19.0000, -5.0000, 1.2438, -1.9094},
     {-4.0000, 0.0250, 0.3844, 0.2656},
     {1.0468, -0.3788, -2.4517, 1.4656}},
    {{-1.0500, 0.0289, 0.4260, 0.3590},
     {-0.3250, 0.1156, 0.7781, 0.0025},
     {31.0625, -14.5000, -46.1148, 55.3750},
     {-7.2312, 0.4050, 13.3500, 0.6234},
     {1.5000, -0.6426, 1.8564, 0.5636}},
};

}  // namespace

bool is_product(const SkyModel& sky) {
    return !sky.intermediate && !sky.blends_ground && !sky.picture;
}

double gradation(const SkyModel& sky, double z) {
    return 1 + (sky.a != 0 ? sky.a * std::exp(sky.b / std::max(z, min_cosine)) : 0) + sky.g * z;
}

double indicatrix(const SkyModel& sky, double cos_gamma) {
    return sky.f0 + (sky.c != 0 ? sky.c * std::exp(sky.d * std::acos(cos_gamma)) : 0) +
           (sky.e != 0 ? sky.e * cos_gamma * cos_gamma : 0);
}

double SkyModel::value(const Vec3& w) const {
    if (picture) return picture->value(w, below);
    const double cos_gamma = std::clamp(dot(w, sun), -1.0, 1.0);
    double out = intermediate ? f0 * intermediate_value(w.z, std::acos(cos_gamma), sun.z)
                              : gradation(*this, w.z) * indicatrix(*this, cos_gamma);
    if (blends_ground) {
        const double base = w.z + 1.01, square = base * base, fourth = square * square;
        const double weight = fourth * fourth * square;
        out = (weight * out + ground / weight) / (weight + 1 / weight);
    }
    return std::max(0.0, out);
}

double SkyModel::smooth_width(const Vec3& w) const {
    if (picture) return SkyPicture::cell_angle;
    constexpr double near_sun = 50 * pi / 180, share = 1.5;
    double width = max_smooth_width;
    if (c != 0 && dot(w, sun) > std::cos(near_sun) && d < 0) width = std::min(width, share / -d);
    // Towards the horizon, phi varies over an angle of about |b|.
    if (a != 0 && b < 0 && std::abs(w.z) < 0.5) width = std::min(width, std::max(0.1, share * -b));
    if (blends_ground && std::abs(w.z) < 0.6) width = std::min(width, 0.15);
    return width;
}

bool SkyModel::normalize() {
    const double mean = horizontal_mean(*this);
    if (!(mean > 0) || !std::isfinite(mean)) return false;
    scale = 1 / mean;
    return true;
}

bool SkyModel::is_sane() const {
    constexpr double largest = 1e6;
    for (const double v : {a, b, g, f0, c, d, e, ground})
        if (!(std::abs(v) <= largest)) return false;
    if (picture && !SkyPicture::are_sane(picture->values())) return false;
    return std::abs(norm(sun) - 1) < 1e-6 && scale > 0 && scale <= 1e30;
}

double horizontal_mean(const SkyModel& sky) {
    if (sky.picture) return sky.picture->horizontal_mean(sky.below);
    return sky.is_uniform() ? std::max(0.0, sky.f0) : CosineMean(sky)();
}

SkyModel uniform_sky() {
    return {};
}

SkyModel overcast_sky() {
    SkyModel sky;
    sky.g = 2;
    sky.normalize();
    return sky;
}

SkyModel cie_sky(int type, const Normal& sun) {
    struct Row {
        double a, b, c, d, e;
    };
    static constexpr std::array<Row, 15> rows{{{4, -0.7, 0, -1, 0},
                                               {4, -0.7, 2, -1.5, 0.15},
                                               {1.1, -0.8, 0, -1, 0},
                                               {1.1, -0.8, 2, -1.5, 0.15},
                                               {0, -1, 0, -1, 0},
                                               {0, -1, 2, -1.5, 0.15},
                                               {0, -1, 5, -2.5, 0.3},
                                               {0, -1, 10, -3, 0.45},
                                               {-1, -0.55, 2, -1.5, 0.15},
                                               {-1, -0.55, 5, -2.5, 0.3},
                                               {-1, -0.55, 10, -3, 0.45},
                                               {-1, -0.32, 10, -3, 0.45},
                                               {-1, -0.32, 16, -3, 0.3},
                                               {-1, -0.15, 16, -3, 0.3},
                                               {-1, -0.15, 24, -2.8, 0.15}}};
    const Row& row = rows[static_cast<std::size_t>(std::clamp(type, 1, 15) - 1)];
    SkyModel sky;
    sky.a = row.a, sky.b = row.b, sky.c = row.c, sky.d = row.d, sky.e = row.e;
    sky.f0 = 1 - row.c * std::exp(row.d * pi / 2);
    sky.sun = sun;
    sky.normalize();
    return sky;
}

PerezState perez_state(const PerezInput& input, const Normal& sun) {
    constexpr double solar_constant = 1367;  // W/m^2
    const double zenith = std::acos(std::clamp(sun.z, 0.0, 1.0)), cubed = 1.041 * zenith * zenith * zenith;
    PerezState out;
    if (!(input.diffuse_horizontal > 0)) return out;
    out.clearness = ((input.diffuse_horizontal + input.direct_normal) / input.diffuse_horizontal + cubed) / (1 + cubed);
    const double mass =
        1 / (std::max(0.0, sun.z) + 0.50572 * std::pow(96.07995 - std::min(zenith * 180 / pi, 90.0), -1.6364));
    const double day = 2 * pi * (input.day_of_year - 1) / 365;
    const double orbit = 1.00011 + 0.034221 * std::cos(day) + 0.00128 * std::sin(day) + 0.000719 * std::cos(2 * day) +
                         0.000077 * std::sin(2 * day);
    out.brightness = mass * input.diffuse_horizontal / (solar_constant * orbit);
    out.clearness = std::clamp(out.clearness, 1.0, 12.01);
    out.brightness = std::clamp(out.brightness, 0.01, 0.6);
    return out;
}

namespace {

/// Returns Perez' sky with scale 1.
SkyModel unscaled_perez_sky_of(const PerezState& state, const Normal& sun) {
    static constexpr std::array<double, 7> bins{1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};
    const double clearness = state.clearness;
    double brightness = state.brightness;
    if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, 0.2);
    const auto bin = static_cast<std::size_t>(std::upper_bound(bins.begin(), bins.end(), clearness) - bins.begin());
    const double zenith = std::acos(std::clamp(sun.z, 0.0, 1.0));
    const auto coefficient = [&](std::size_t i) {
        const double* k = perez_table[bin][i];
        return k[0] + k[1] * zenith + brightness * (k[2] + k[3] * zenith);
    };
    SkyModel sky;
    sky.a = coefficient(0), sky.b = coefficient(1), sky.c = coefficient(2), sky.d = coefficient(3);
    sky.e = coefficient(4);
    if (bin == 0) {
        const double *kc = perez_table[0][2], *kd = perez_table[0][3];
        sky.c = std::exp(std::pow(brightness * (kc[0] + kc[1] * zenith), kc[2])) - kc[3];
        sky.d = -std::exp(brightness * (kd[0] + kd[1] * zenith)) + kd[2] + brightness * kd[3];
    }
    sky.sun = sun;
    return sky;
}

/// Returns the direction to a sun that is not below the horizon.
Normal raised(const Normal& sun) {
    if (!(sun.z < 0)) return sun;
    const double across = std::hypot(sun.x, sun.y);
    return across > 0 ? Normal{sun.x / across, sun.y / across, 0} : Normal{0, 1, 0};
}

}  // namespace

SkyModel perez_sky_of(const PerezState& state, const Normal& sun) {
    SkyModel sky = unscaled_perez_sky_of(state, sun);
    sky.normalize();
    return sky;
}

SkyModel perez_sky(const PerezInput& input, const Normal& direction) {
    const Normal sun = raised(direction);
    return perez_sky_of(perez_state(input, sun), sun);
}

SkyModel unscaled_perez_sky(const PerezInput& input, const Normal& direction) {
    const Normal sun = raised(direction);
    return unscaled_perez_sky_of(perez_state(input, sun), sun);
}

}  // namespace exitance
