#include "exitance/solve/conserving_transport.hpp"

#include <cmath>
#include <vector>

#include "exitance/base/parallel.hpp"

namespace exitance {

bool is_kept(const Spectrum& arriving, const Spectrum& sent) {
    constexpr double min_kept_share = 0.98;
    return mean(arriving) >= min_kept_share * mean(sent);
}

Spectrum conserving_scale(const Spectrum& arriving, const Spectrum& received) {
    constexpr double max_difference = 0.05;
    Spectrum scale(1.0);
    for (std::size_t band = 0; band < bands; ++band)
        if (std::abs(arriving[band] - received[band]) < max_difference * received[band])
            scale[band] = arriving[band] / received[band];
    return scale;
}

bool ConservingTransport::conserve(std::span<const Spectrum> b) {
    const auto power = [&](std::span<const Spectrum> x, std::span<const double> share) {
        return parallel_sum<Spectrum>(x.size(),
                                      [&](std::size_t i) { return (share.empty() ? 1 : share[i]) * area_[i] * x[i]; });
    };
    const Spectrum arriving = power(b, kept_);
    if (!is_kept(arriving, power(b, {}))) return false;
    std::vector<Spectrum> E(b.size());
    F_.gather(b, E);
    scale_ = conserving_scale(arriving, power(E, {}));
    return true;
}

void ConservingTransport::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    F_.gather(radiosity, irradiance);
    multiply(irradiance);
}

void ConservingTransport::gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    F_.gather_own(radiosity, irradiance);
    multiply(irradiance);
}

void ConservingTransport::multiply(std::span<Spectrum> irradiance) const {
    parallel_for(irradiance.size(), 4096, [&](std::size_t i) { irradiance[i] = scale_ * irradiance[i]; });
}

namespace {

/// Power of the light reflected at least twice, sum_i A_i (b_i - rhs_i), W.
Spectrum power_of_returns(const RadiositySystem& system, std::span<const Spectrum> b) {
    return parallel_sum<Spectrum>(b.size(), [&](std::size_t i) { return system.area[i] * (b[i] - system.rhs[i]); });
}

}  // namespace

SolveReport solve_conserving(const RadiositySystem& system, ConservingTransport& F, bool closed, Relaxation method,
                             std::span<Spectrum> b, StopRule stop) {
    SolveReport report = solve_radiosity(system, method, b, stop);
    const Spectrum unscaled = power_of_returns(system, b);
    constexpr int max_repeats = 2;
    for (int i = 0; closed && i < max_repeats && !(stop.request && stop.request->requested()); ++i) {
        if (!F.conserve(b)) break;
        const std::size_t before = report.iterations + 1;
        report = solve_radiosity(system, method, b, stop);
        report.iterations += before;
    }
    const Spectrum found = power_of_returns(system, b);
    for (std::size_t band = 0; band < bands; ++band)
        report.unscaled[band] = found[band] > 0 ? unscaled[band] / found[band] : 1;
    return report;
}

}  // namespace exitance
