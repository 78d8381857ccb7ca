#include "exitance/what_if/daylight/year_suns.hpp"

#include <algorithm>

#include "exitance/direct/beams.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

YearSuns::YearSuns(const YearSky& sky) : sky_(sky), suns_(sky.hours()) {
    for (std::size_t h = 0; h < suns_.size(); ++h) {
        const YearSky::Sun& sun = sky.sun(h);
        if (!(sun.illuminance > 0)) continue;
        PunctualLight light;
        light.kind = PunctualLight::Kind::directional, light.direction = -sun.towards;
        light.intensity = Spectrum(sun.illuminance);
        suns_[h].push_back(light);
    }
}

void YearSuns::find(const Occluders& occluders, const SurfacePoint& at, std::span<const float> direct,
                    std::span<float> sun) const {
    for (std::size_t h = 0; h < suns_.size(); ++h) {
        if (suns_[h].empty()) continue;
        const YearSky::Sun& shining = sky_.sun(h);
        const auto is_seen = [&](std::size_t patch) { return direct[patch] > 0; };
        if (!(dot(shining.towards, at.n) > 0) || std::none_of(shining.patches.begin(), shining.patches.end(), is_seen))
            continue;
        sun[h] = static_cast<float>(luminous_sum(Beams(suns_[h], occluders).irradiance(at)));
    }
}

void YearSuns::find_through(const Occluders& occluders, const PaneGroups& groups, const SurfacePoint& at, double least,
                            std::span<Through> out) const {
    for (std::size_t h = 0; h < suns_.size(); ++h) {
        out[h] = {};
        const YearSky::Sun& sun = sky_.sun(h);
        if (suns_[h].empty() || !(sun.illuminance * dot(sun.towards, at.n) >= least)) continue;
        const PaneGroups::Mask mask = groups.crossed_outwards(at.x, sun.towards);
        if (mask == 0) continue;
        const double E = luminous_sum(Beams(suns_[h], occluders).irradiance(at));
        if (E >= least) out[h] = {mask, static_cast<float>(E)};
    }
}

void YearSuns::keep_through(const PaneGroups& groups, std::size_t group, const SurfacePoint& at,
                            std::span<float> sun) const {
    for (std::size_t h = 0; h < suns_.size(); ++h)
        if (sun[h] > 0 && (groups.crossed_outwards(at.x, sky_.sun(h).towards) >> group & 1) == 0) sun[h] = 0;
}

}  // namespace exitance
