#include "exitance/reference/compare.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Sums over points and bands, with weight w: the reflectance or 1.
struct Sums {
    double squares = 0;      ///< (w (E - E_ref))^2
    double differences = 0;  ///< Sum of w (E - E_ref), W/m^2.
    double noise = 0;        ///< (w se)^2
    double level = 0;        ///< w E_ref

    void add(double weight, double difference, double error, double reference) {
        squares += weight * difference * weight * difference;
        differences += weight * difference;
        noise += weight * error * weight * error;
        level += weight * reference;
    }
    Sums& operator+=(const Sums& o) {
        squares += o.squares, differences += o.differences, noise += o.noise, level += o.level;
        return *this;
    }
};

struct BothSums {
    Sums radiosity, irradiance;

    BothSums& operator+=(const BothSums& o) {
        radiosity += o.radiosity, irradiance += o.irradiance;
        return *this;
    }
};

using Indices = std::span<const std::size_t>;

BothSums sum(const ErrorSamples& samples, const Scene& scene, Indices points) {
    return parallel_sum<BothSums>(points.size(), [&](std::size_t k) {
        const std::size_t i = points[k];
        const SurfaceId s = samples.surfaces[i];
        BothSums out;
        for (std::size_t b = 0; b < bands; ++b) {
            const double difference = samples.irradiance[i][b] - samples.reference[i][b];
            const double error = samples.standard_errors.empty() ? 0 : samples.standard_errors[i][b];
            const double reflectance = s.is_none() ? 0 : scene.material(s).reflectance[b];
            out.radiosity.add(reflectance, difference, error, samples.reference[i][b]);
            out.irradiance.add(1, difference, error, samples.reference[i][b]);
        }
        return out;
    });
}

/// Returns a / b, with 0 / 0 = 0 and an infinite result for any other a over 0.
double ratio(double a, double b) {
    return a == 0 ? 0 : b > 0 ? a / b : std::copysign(HUGE_VAL, a);
}

std::vector<double> relative_errors(const ErrorSamples& samples, Indices points) {
    std::vector<double> out;
    for (const std::size_t i : points)
        if (mean(samples.reference[i]) > 0)
            out.push_back(std::sqrt(squared(samples.irradiance[i] - samples.reference[i]) / double(bands)) /
                          mean(samples.reference[i]));
    std::sort(out.begin(), out.end());
    return out;
}

double quantile(const std::vector<double>& sorted, double f) {
    if (sorted.empty()) return 0;
    return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(f * static_cast<double>(sorted.size())))];
}

ErrorMeasure measure(const ErrorSamples& samples, const Scene& scene, Indices points) {
    ErrorMeasure out;
    out.points = points.size();
    if (points.empty()) return out;
    for (const std::size_t i : points)
        if (!is_finite(samples.irradiance[i])) {
            out.relative_rms_error = out.raw_relative_rms_error = out.bias = HUGE_VAL;
            out.median_relative_error = out.p95_relative_error = HUGE_VAL;
            return out;
        }
    const BothSums sums = sum(samples, scene, points);
    out.of_irradiance = !(sums.radiosity.level > 0);
    const Sums& s = out.of_irradiance ? sums.irradiance : sums.radiosity;
    const double n = static_cast<double>(points.size() * bands), level = s.level / n;
    out.raw_relative_rms_error = ratio(std::sqrt(s.squares / n), level);
    out.reference_noise = ratio(std::sqrt(s.noise / n), level);
    out.relative_rms_error = ratio(std::sqrt(std::max(0.0, s.squares - s.noise) / n), level);
    out.bias = ratio(s.differences / n, level);
    const std::vector<double> errors = relative_errors(samples, points);
    out.median_relative_error = quantile(errors, 0.5);
    out.p95_relative_error = quantile(errors, 0.95);
    return out;
}

/// Returns the points on faces, sorted by face; all points if none is on a face.
std::vector<std::size_t> points_by_face(const ErrorSamples& samples) {
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < samples.surfaces.size(); ++i)
        if (!samples.surfaces[i].is_none()) points.push_back(i);
    if (points.empty()) {
        points.resize(samples.surfaces.size());
        std::iota(points.begin(), points.end(), std::size_t(0));
    }
    std::stable_sort(points.begin(), points.end(),
                     [&](std::size_t a, std::size_t b) { return samples.surfaces[a] < samples.surfaces[b]; });
    return points;
}

}  // namespace

ErrorMeasure measure_error(const ErrorSamples& samples, const Scene& scene) {
    const std::size_t n = samples.irradiance.size();
    EXI_CHECK(samples.reference.size() == n && samples.surfaces.size() == n);
    EXI_CHECK(samples.standard_errors.empty() || samples.standard_errors.size() == n);
    return measure(samples, scene, points_by_face(samples));
}

}  // namespace exitance
