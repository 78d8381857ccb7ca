#include "exitance/light_probes.hpp"

#include <cmath>

#include "exitance/api/inside.hpp"
#include "exitance/measure/probes/light_probe.hpp"

namespace exitance::api {

static_assert(harmonic_count == exitance::harmonic_count);

Spectrum LightProbe::irradiance(const Vec3& normal) const {
    Harmonics<exitance::Spectrum> coefficients;
    for (std::size_t i = 0; i < harmonic_count; ++i) coefficients[i] = api::to_engine(radiance[i]);
    return to_api(irradiance_of(coefficients, normalized(to_engine(normal))));
}

Result<std::vector<LightProbe>> light_probes(const Solution& solution, std::span<const Vec3> points,
                                             const LightProbeOptions& options, const Control& control) {
    return take_turn<std::vector<LightProbe>>(control, [&](Run& run) -> Result<std::vector<LightProbe>> {
        constexpr int min_rays = 64, max_rays = 1 << 20;
        const int rays = options.rays;
        if (rays < min_rays || rays > max_rays || (rays & (rays - 1)) != 0)
            return usage("must be a power of two from 64 to 1048576", "rays");
        std::vector<Point> places;
        for (const Vec3& p : points) {
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                return usage("point " + std::to_string(places.size()) + " is not finite", "points");
            places.push_back(to_engine(p));
        }
        const std::vector<exitance::LightProbe> found = exitance::light_probes(
            solution.data().light(), places, static_cast<unsigned>(rays), run.progress(), run.stop());
        if (found.size() < places.size()) return stopped("the computation of light probes");
        std::vector<LightProbe> out;
        out.reserve(found.size());
        for (const exitance::LightProbe& probe : found) {
            LightProbe& one = out.emplace_back();
            for (std::size_t i = 0; i < harmonic_count; ++i) {
                one.radiance[i] = to_api(probe.radiance[i]);
                one.standard_error[i] = to_api(probe.standard_error[i]);
            }
            one.back_share = probe.back_share;
        }
        return out;
    });
}

}  // namespace exitance::api
