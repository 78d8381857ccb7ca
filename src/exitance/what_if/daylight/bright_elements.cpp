#include "exitance/what_if/daylight/bright_elements.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/direct/beams.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

/// Mean of the replicates of a row of reflected light.
void mean_row(const ElementLight& light, std::size_t leaf, std::span<float> out) {
    std::fill(out.begin(), out.end(), 0.0F);
    for (const std::vector<float>& replicate : light.reflected)
        for (std::size_t p = 0; p < light.columns; ++p)
            out[p] += replicate[leaf * light.columns + p] / static_cast<float>(daylight_replicates);
}

/// Direct sunlight that an element reflects, lm/m^2; 0 if even the whole sun would give less than `least` lm/m^2.
double reflected_sun(const YearSky::Sun& sun, const SurfacePoint& at, double reflectance, double least,
                     const Occluders& occluders) {
    const double most = reflectance * sun.illuminance * dot(sun.towards, at.n);
    if (!(most > std::max(0.0, least))) return 0;
    PunctualLight beam;
    beam.kind = PunctualLight::Kind::directional, beam.direction = -sun.towards;
    beam.intensity = Spectrum(sun.illuminance);
    return reflectance * luminous_sum(Beams({beam}, occluders).irradiance(at));
}

}  // namespace

BrightElements::BrightElements(const DaylightSetting& setting, const DaylightTransport& transport,
                               const ElementLight& light, double threshold) {
    constexpr std::size_t together = 16;  // leaves
    const YearSky& sky = setting.sky;
    const std::vector<std::size_t>& bright = sky.bright_hours();
    const std::size_t leaves = transport.leaves(), patches = light.columns;
    const Occluders& occluders = transport.stage().occluders;
    struct Found {
        std::size_t hour;  ///< Index in `bright`.
        Entry entry;
    };
    std::vector<std::vector<Found>> found((leaves + together - 1) / together);
    const auto find_in = [&](std::size_t block) {
        const std::size_t first = block * together, count = std::min(together, leaves - first);
        std::vector<float> rows(count * patches), lux(count * sky.hours(), 0.0F);
        for (std::size_t i = 0; i < count; ++i)
            mean_row(light, first + i, std::span(rows).subspan(i * patches, patches));
        sky.add_sky(rows, lux);
        for (std::size_t i = 0; i < count; ++i) {
            const SurfacePoint at = transport.leaf_centre(first + i);
            const double rho = luminous_sum(setting.scene.material(at.region).reflectance);
            for (std::size_t k = 0; k < bright.size(); ++k) {
                double B = double(lux[i * sky.hours() + bright[k]]);
                B += reflected_sun(sky.sun(bright[k]), at, rho, threshold * pi - B, occluders);
                if (B > threshold * pi)
                    found[block].push_back({k, {static_cast<std::uint32_t>(first + i), static_cast<float>(B / pi)}});
            }
        }
    };
    parallel_own_ranges(found.size(), 1,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t block = begin; block < end; ++block) find_in(block);
                        },
                        {"bright elements"});
    exchange_archived(
        std::span(found), 1, [](auto& archive, std::vector<Found>& some) { archive(some); }, "bright elements");
    is_bright_.assign(leaves, 0), first_.assign(bright.size() + 1, 0);
    for (const auto& block : found)
        for (const auto& [k, entry] : block) ++first_[k + 1], is_bright_[entry.leaf] = 1;
    for (std::size_t k = 0; k < bright.size(); ++k) first_[k + 1] += first_[k];
    entries_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& block : found)
        for (const auto& [k, entry] : block) entries_[next[k]++] = entry;
}

}  // namespace exitance
