#include "exitance/lab/cie171/exact_sky.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exitance/base/quadrature.hpp"

namespace exitance {
namespace {

/// Parameters a, b, c, d, e of the fifteen types.
constexpr std::array<std::array<double, 5>, 15> types{{{4, -0.7, 0, -1, 0},
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

void add(SkyValues& sum, const SkyValues& values, double weight) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * values[i];
}

double difference(const SkyValues& a, const SkyValues& b) {
    double largest_difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest_difference = std::max(largest_difference, std::abs(a[i] - b[i]));
    return largest_difference;
}

double largest(const SkyValues& a) {
    return difference(a, SkyValues{});
}

/// Adaptive integral of f(x, y) over a rectangle.
template <class F>
class Adaptive {
  public:
    Adaptive(const F& f, double tolerance) : f_(f), tolerance_(tolerance), rule_(gauss_legendre(12)) {}

    SkyValues operator()(double x0, double x1, double y0, double y1) const {
        return refined(x0, x1, y0, y1, panel(x0, x1, y0, y1), 0);
    }

  private:
    SkyValues panel(double x0, double x1, double y0, double y1) const {
        SkyValues sum{};
        for (std::size_t i = 0; i < rule_.size(); ++i)
            for (std::size_t k = 0; k < rule_.size(); ++k)
                add(sum, f_(x0 + (x1 - x0) * rule_.nodes[i], y0 + (y1 - y0) * rule_.nodes[k]),
                    rule_.weights[i] * rule_.weights[k] * (x1 - x0) * (y1 - y0));
        return sum;
    }
    SkyValues refined(double x0, double x1, double y0, double y1, const SkyValues& whole, int level) const {
        constexpr int max_level = 14;
        const double x = 0.5 * (x0 + x1), y = 0.5 * (y0 + y1);
        const std::array<std::array<double, 4>, 4> parts{
            {{x0, x, y0, y}, {x, x1, y0, y}, {x0, x, y, y1}, {x, x1, y, y1}}};
        std::array<SkyValues, 4> found;
        SkyValues sum{};
        for (std::size_t i = 0; i < 4; ++i) {
            found[i] = panel(parts[i][0], parts[i][1], parts[i][2], parts[i][3]);
            add(sum, found[i], 1);
        }
        if (level == max_level || difference(sum, whole) <= tolerance_ * largest(sum)) return sum;
        sum = {};
        for (std::size_t i = 0; i < 4; ++i)
            add(sum, refined(parts[i][0], parts[i][1], parts[i][2], parts[i][3], found[i], level + 1), 1);
        return sum;
    }

    const F& f_;
    double tolerance_;
    LineRule rule_;
};

}  // namespace

SkyValues Cie171Skies::relative(const Normal& w) const {
    const double cosine = std::max(w.z, 1e-12), c = std::clamp(dot(w, sun_), -1.0, 1.0), chi = std::acos(c);
    SkyValues out;
    for (std::size_t i = 0; i < types.size(); ++i) {
        const auto& t = types[i];
        out[i] = (1 + t[0] * std::exp(t[1] / cosine)) *
                 (1 + t[2] * (std::exp(t[3] * chi) - std::exp(t[3] * pi / 2)) + t[4] * c * c);
    }
    out[15] = (1 + 2 * cosine) / 3;
    return out;
}

Cie171Skies::Cie171Skies(const Normal& sun) : sun_(sun) {
    const double azimuth = std::atan2(sun.y, sun.x), zenith = std::acos(sun.z);
    const auto horizontal = [&](double theta, double phi) {
        SkyValues values =
            relative({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
        for (double& v : values) v *= std::sin(theta) * std::cos(theta);
        return values;
    };
    const Adaptive integral(horizontal, 1e-10);
    SkyValues sum{};
    for (const double phi : {azimuth - pi, azimuth}) {
        add(sum, integral(0, zenith, phi, phi + pi), 1);
        add(sum, integral(zenith, pi / 2, phi, phi + pi), 1);
    }
    for (std::size_t i = 0; i < sum.size(); ++i) scale_[i] = cie171_horizontal_lux / sum[i];
}

SkyValues Cie171Skies::luminance(const Normal& w) const {
    SkyValues out = relative(w);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] *= scale_[i];
    return out;
}

SkyValues illuminance_through(const SkyOpening& opening, const Point& x, const Normal& n, const Cie171Skies& skies) {
    const Normal out = cross(opening.a, opening.b);
    std::vector<double> as{opening.a0, opening.a1}, bs{opening.b0, opening.b1};
    const auto cut = [](std::vector<double>& at, double value) {
        if (value > at[0] + 1e-12 && value < at[1] - 1e-12) at.push_back(value);
    };
    if (std::abs(opening.b.z) > 0.5) cut(bs, (x.z - opening.o.z) / opening.b.z);
    if (const double along = dot(skies.sun(), out); std::abs(along) > 1e-9)
        if (const double t = dot(opening.o - x, out) / along; t > 0) {
            const Vec3 q = x + t * skies.sun() - opening.o;
            cut(as, dot(q, opening.a)), cut(bs, dot(q, opening.b));
        }
    std::sort(as.begin(), as.end()), std::sort(bs.begin(), bs.end());
    const auto kernel = [&](double a, double b) {
        const Vec3 r = opening.o + a * opening.a + b * opening.b - x;
        const double r2 = squared_norm(r);
        const Vec3 w = r / std::sqrt(r2);
        const double g = std::max(0.0, dot(w, n)) * std::abs(dot(w, out)) / r2;
        SkyValues values{};
        if (g == 0) return values;
        if (w.z > 0)
            values = skies.luminance(w);
        else
            values.fill(cie171_ground_luminance);
        for (double& v : values) v *= g;
        return values;
    };
    const Adaptive integral(kernel, 1e-9);
    SkyValues sum{};
    for (std::size_t i = 0; i + 1 < as.size(); ++i)
        for (std::size_t k = 0; k + 1 < bs.size(); ++k)
            if (as[i + 1] > as[i] && bs[k + 1] > bs[k]) add(sum, integral(as[i], as[i + 1], bs[k], bs[k + 1]), 1);
    return sum;
}

}  // namespace exitance
