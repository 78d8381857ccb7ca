#include "exitance/glare.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/api/inside.hpp"
#include "exitance/measure/glare/daylight_glare.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance::api {
namespace {

std::optional<Error> find_wrong_number(const GlareOptions& options) {
    const auto is_positive = [](double x) { return x > 0 && std::isfinite(x); };
    if (!is_positive(options.threshold)) return usage("must be above 0", "threshold");
    if (!is_positive(options.efficacy)) return usage("must be above 0 lm/W", "efficacy");
    return {};
}

Glare describe_glare(const DaylightGlare& found, const std::optional<double>& error) {
    Glare out;
    out.probability = found.probability();
    if (error) out.bounds = {found.probability_with(1 - *error), found.probability_with(1 + *error)};
    out.level = glare_class(out.probability);
    out.vertical_illuminance = found.vertical_illuminance, out.mean_luminance = found.mean_luminance;
    out.threshold = found.threshold;
    for (std::size_t k = 0; k < found.sources.size(); ++k) {
        const DaylightGlareSource& source = found.sources[k];
        out.sources.push_back(
            {found.names[k], to_api(source.towards), source.luminance, source.solid_angle, source.position});
    }
    return out;
}

}  // namespace

Result<Glare> glare(const Solution& solution, const Vec3& eye, const Vec3& direction, const GlareOptions& options,
                    const Control& control) {
    return take_turn<Glare>(control, [&](Run& run) -> Result<Glare> {
        if (const std::optional<Error> wrong = find_wrong_number(options)) return *wrong;
        const Probe looking{eye, direction};
        const Result<std::vector<ProbePoint>> places = api::to_engine(std::span(&looking, 1));
        if (!places) return places.error();
        const exitance::Solution& solved = solution.data().solution;
        const LightUnit lux(UnitChoice::lux, solved.scene.is_photometric(), options.efficacy);
        const Observer observer{{}, (*places)[0].x, (*places)[0].n};
        run.progress().phase("glare");
        const DaylightGlare found =
            find_daylight_glare(solution.data().light(), observer, lux, {options.threshold, options.is_multiple});
        if (run.stop().requested()) return stopped("the evaluation of glare");
        // The eye may be in any room.
        const std::optional<double> error =
            std::max(solved.statistics.relative_error_estimate, solved.statistics.relative_error_estimate_worst_room);
        return describe_glare(found, error);
    });
}

}  // namespace exitance::api
