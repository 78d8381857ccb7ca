#include "exitance/solve/shooting.hpp"

#include <cmath>

#include "exitance/core/parallel.hpp"

namespace exitance {
namespace {

double power(const Spectrum& u, double area) {
    double sum = 0;
    for (double v : u.value) sum += std::abs(v);
    return area * sum / static_cast<double>(bands);
}

/// What a patch may expect to have to send later: its reflectance of the ambient light, the mean of what is unshot and
/// its reflections, sum A u / sum A / (1 - mean rho).
Spectrum ambient(const ShootingProblem& problem, std::span<const Spectrum> unshot, const Spectrum& mean_reflectance) {
    Spectrum sum;
    double area = 0;
    for (std::size_t p = 0; p < unshot.size(); ++p) {
        sum += problem.patch_area[p] * unshot[p];
        area += problem.patch_area[p];
    }
    for (std::size_t b = 0; b < bands; ++b) sum[b] = std::max(0.0, sum[b]) / (area * (1 - mean_reflectance[b]));
    return sum;
}

}  // namespace

double unshot_power(std::span<const Spectrum> unshot, std::span<const double> patch_area) {
    double sum = 0;
    for (std::size_t p = 0; p < unshot.size(); ++p) sum += power(unshot[p], patch_area[p]);
    return sum;
}

SolveReport shoot(const ShootingProblem& problem, const ShootingOptions& options, std::span<Spectrum> unshot,
                  std::span<Spectrum> irradiance) {
    const std::size_t receivers = irradiance.size(), patches = unshot.size();
    std::vector<Spectrum> patch_reflectance(patches), arrived(receivers);
    Spectrum mean_reflectance;
    double area = 0;
    for (std::size_t i = 0; i < receivers; ++i) {
        patch_reflectance[problem.patch_of[i]] +=
            (problem.receiver_area[i] / problem.patch_area[problem.patch_of[i]]) * problem.reflectance[i];
        mean_reflectance += problem.receiver_area[i] * problem.reflectance[i];
        area += problem.receiver_area[i];
    }
    mean_reflectance *= 1 / area;
    const double at_first = options.reference > 0 ? options.reference : unshot_power(unshot, problem.patch_area);

    SolveReport report;
    while (at_first > 0) {
        double left = 0, most = -1;
        std::size_t j = 0;
        for (std::size_t p = 0; p < patches; ++p) {
            const double own = power(unshot[p], problem.patch_area[p]);
            left += own;
            if (own > most) most = own, j = p;
        }
        report.residual = left / at_first;
        report.converged = report.residual <= options.unshot;
        report.interrupted = !report.converged && options.request && options.request->requested();
        if (report.converged || report.interrupted || report.iterations >= options.max_shots) break;

        const Spectrum extra =
            options.overshooting ? patch_reflectance[j] * ambient(problem, unshot, mean_reflectance) : Spectrum();
        const Spectrum sent = unshot[j] + extra;
        unshot[j] = -1.0 * extra;
        const std::span<const float> F = problem.column(j);
        parallel_for(receivers, 2048, [&](std::size_t i) {
            arrived[i] = static_cast<double>(F[i]) * sent;
            irradiance[i] += arrived[i];
        });
        for (std::size_t i = 0; i < receivers; ++i) {
            if (F[i] == 0) continue;
            const std::uint32_t p = problem.patch_of[i];
            unshot[p] += (problem.receiver_area[i] / problem.patch_area[p]) * (problem.reflectance[i] * arrived[i]);
        }
        ++report.iterations;
        if (options.progress && report.iterations % 16 == 0)
            options.progress->advance(std::log(report.residual) / std::log(options.unshot));
    }
    return report;
}

}  // namespace exitance
