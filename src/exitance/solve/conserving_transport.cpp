#include "exitance/solve/conserving_transport.hpp"

#include <cmath>
#include <vector>

#include "exitance/core/parallel.hpp"

namespace exitance {

void ConservingTransport::conserve(std::span<const Spectrum> b) {
    std::vector<Spectrum> E(b.size());
    F_.gather(b, E);
    const auto power = [&](std::span<const Spectrum> x, std::span<const double> share) {
        return parallel_sum<Spectrum>(x.size(),
                                      [&](std::size_t i) { return (share.empty() ? 1 : share[i]) * area_[i] * x[i]; });
    };
    const Spectrum all = power(b, {}), sent = power(b, kept_), received = power(E, {});
    if (mean(sent) < least_kept * mean(all)) return;
    constexpr double small = 0.05;
    for (std::size_t band = 0; band < bands; ++band) {
        const double s = received[band] > 0 ? sent[band] / received[band] : 1;
        if (std::abs(s - 1) < small) scale_[band] = s;
    }
}

void ConservingTransport::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    F_.gather(radiosity, irradiance);
    parallel_for(irradiance.size(), 4096, [&](std::size_t i) { irradiance[i] = scale_ * irradiance[i]; });
}

SolveReport solve_conserving(const RadiositySystem& system, ConservingTransport& F, bool closed, Relaxation method,
                             std::span<Spectrum> b, StopRule stop) {
    SolveReport report = solve_radiosity(system, method, b, stop);
    constexpr int times = 2;
    for (int i = 0; closed && i < times && !(stop.request && stop.request->requested()); ++i) {
        F.conserve(b);
        const std::size_t before = report.iterations + 1;
        report = solve_radiosity(system, method, b, stop);
        report.iterations += before;
    }
    return report;
}

}  // namespace exitance
