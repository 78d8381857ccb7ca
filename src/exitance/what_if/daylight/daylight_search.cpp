#include "exitance/what_if/daylight/daylight_search.hpp"

#include <cmath>

namespace exitance {
namespace {

/// Factor on the number of rays for which noise falls to `wanted`: noise falls at least with the root of the rays.
unsigned more_rays(double noise, double wanted) {
    constexpr unsigned max_factor = 64;
    unsigned factor = 2;
    while (factor < max_factor && noise > wanted * std::sqrt(1.0 * factor)) factor *= 2;
    return factor;
}

}  // namespace

DaylightLight find_daylight_light(const DaylightSetting& setting, DaylightTransport& transport, DaylightSample& sample,
                                  double error, Progress& progress, const StopRequest& stop) {
    constexpr int max_attempts = 7;
    const double share = std::sqrt(0.5);  // noise and bias may each have half of the squared error
    // A first attempt that suffices for a simple room at 2%.
    DaylightLight out{{.elements = 1500, .rays_an_element = 64, .rays_a_sensor = 1024, .seed = setting.seed}, {}, {}};
    transport.make_elements(out.options.elements);
    for (int k = 0; k < max_attempts && !stop.requested(); ++k) {
        progress.phase("rays");
        transport.cast_rows(out.options.rays_an_element);
        sample.evaluate(transport, out.options.rays_a_sensor);
        out.bias = {};
        const double noise = worst_of(sample.errors(out.bias)).largest();
        if (noise > share * error) {
            const unsigned factor = more_rays(noise, share * error);
            out.options.rays_an_element *= factor, out.options.rays_a_sensor *= factor;
            continue;
        }
        out.bias = sample.measure_bias(error, progress, stop);
        if (worst_of(sample.errors(out.bias)).largest() <= error || out.bias.elements <= share * error) break;
        if (k + 1 == max_attempts) break;
        out.options.elements *= 4;
        transport.make_elements(out.options.elements);
        sample.forget_rays();
    }
    progress.phase("solve");
    const SkyColumns columns = SkyColumns::of_patches(setting.patches.size());
    out.elements = transport.solve(columns);
    for (std::size_t g = 0; g < transport.pane_groups().count(); ++g)
        out.through.push_back(transport.solve_through(columns, out.elements, g));
    if (!out.through.empty()) out.twice = sample.measure_twice(transport);
    return out;
}

}  // namespace exitance
