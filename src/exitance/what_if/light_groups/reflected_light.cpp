#include "exitance/what_if/light_groups/reflected_light.hpp"

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/solve/relaxation.hpp"

namespace exitance {
namespace {

/// RMS of rho E over the leaves of `indirect` and the bands, where E is evaluated at the leaves' centres from `values`.
template <class Values>
double rms(const Solution& solution, const Values& values) {
    const ElementFunction& f = solution.indirect;
    double sum = 0, area = 0;
    for (const ElementId e : f.tree.leaves()) {
        const Between middle{f.first_value[e], corner_weights(f.tree.patch(e), f.tree.centre(e))};
        const Spectrum& rho = solution.scene.material(f.tree.region(e)).reflectance;
        sum += f.tree.area(e) * squared(rho * middle.of(values)) / static_cast<double>(bands);
        area += f.tree.area(e);
    }
    return area > 0 ? std::sqrt(sum / area) : 0;
}

}  // namespace

std::vector<Spectrum> reflected_light(const KeptOperator& F, std::span<const Spectrum> reflectance,
                                      std::span<const double> area, std::span<const Spectrum> direct, int bounces,
                                      const StopRequest* stop) {
    std::vector<Spectrum> rhs(direct.size());
    for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = reflectance[i] * direct[i];
    std::vector<Spectrum> b = rhs;
    if (bounces < 0) {
        solve_radiosity({F, reflectance, rhs, area}, Relaxation::gmres, b,
                        {.residual = calibrated::changed_light_settled, .max_iterations = 200, .request = stop});
        return b;
    }
    std::vector<Spectrum> E(b.size());
    for (int bounce = 1; bounce < bounces; ++bounce) {
        F.gather(b, E);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] = rhs[i] + reflectance[i] * E[i];
    }
    return b;
}

std::vector<Spectrum> source_means(const TransportLayout& layout, const CornerValues& interpolant) {
    std::vector<Spectrum> out(layout.sources.size());
    for (const TransportLayout::LeafShare& leaf : layout.source_mean)
        out[leaf.source] += leaf.share * leaf.at.of(interpolant);
    return out;
}

double rms_reflected(const Solution& solution) {
    return rms(solution, solution.indirect.values);
}

double relative_difference(const Solution& solution, const CornerValues& values) {
    CornerValues apart = values;
    for (std::size_t i = 0; i < apart.size(); ++i)
        for (std::size_t band = 0; band < bands; ++band) apart[i][band] -= solution.indirect.values[i][band];
    const double all = rms_reflected(solution);
    return all > 0 ? rms(solution, apart) / all : 0;
}

}  // namespace exitance
