#include "exitance/measure/glare/daylight_glare.hpp"

#include "exitance/measure/glare/eye_light.hpp"
#include "exitance/measure/glare/field_of_view.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

double DaylightGlare::probability_with(double factor) const {
    double terms = 0;
    for (const DaylightGlareSource& source : sources) terms += factor * factor * source.term();
    return daylight_glare_probability(factor * vertical_illuminance, terms);
}

double DaylightGlare::probability() const {
    return probability_with(1);
}

DaylightGlare find_daylight_glare(const RadiosityFunction& light, const Observer& at, const LightUnit& lux,
                                  const GlareThreshold& threshold) {
    const Observer observer = off_walls(light, at);
    const ProbePoint plane{observer.eye, observer.view};
    DaylightGlare out;
    const SurfacePoint eye{observer.eye, observer.view, RegionId()};
    const FieldOfView view(light, eye, lux);
    out.vertical_illuminance =
        lux(light.at(std::span(&plane, 1), Component::direct)[0].irradiance) + view.reflected_illuminance();
    out.mean_luminance = view.mean_luminance();
    out.threshold = threshold.luminance(out.mean_luminance);
    out.sources = join_glare_parts(observer.view, view.brighter_than(out.threshold));
    for (const DaylightGlareSource& source : out.sources) out.names.push_back(view.name(source.origin));
    return out;
}

}  // namespace exitance
