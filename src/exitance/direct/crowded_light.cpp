#include "exitance/direct/crowded_light.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "exitance/core/random.hpp"
#include "exitance/direct/source_point.hpp"

namespace exitance {
namespace {

/// What a blocker costs that is cut out of a source, in rays: a microsecond and some, where fragments are many.
constexpr unsigned rays_a_blocker = 6;
constexpr unsigned least_rays = 16;
constexpr std::uint32_t least_crowd = least_rays / rays_a_blocker + 1;

}  // namespace

double CrowdedLight::unblocked(const Receiver& at, const ReceiverLight::Source& source,
                               DirectLight::Workspace& scratch) const {
    const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
    return visible_form_factor(direct_->occluders(), at, source.piece, {}, scratch, emitter.radiance);
}

std::vector<ReceiverLight::Source> CrowdedLight::take_crowded(ReceiverLight& light, const Point& middle, double allowed,
                                                              DirectLight::Workspace& scratch, unsigned& rays) const {
    // Not of the sky, whose light varies over a source, nor through panes.
    const auto is_crowded = [&](const ReceiverLight::Source& s) {
        return s.count > least_crowd && !direct_->is_distant(s.emitter);
    };
    std::vector<ReceiverLight::Source> out;
    if (!direct_->occluders().scene().panes().empty()) return out;
    if (allowed <= 0 || !light.behind.empty() || std::none_of(light.sources.begin(), light.sources.end(), is_crowded))
        return out;
    const Receiver at = direct_->receiver(middle, light.n, light.own);
    // A ray comes or does not: the variance of n is F^2 / (4 n) at most.
    double power = 0;
    for (const ReceiverLight::Source& s : light.sources) {
        if (!is_crowded(s)) continue;
        const double E = unblocked(at, s, scratch) * mean(direct_->emitters()[s.emitter].exitance);
        power += 0.25 * E * E;
    }
    const double wanted = std::clamp(power / allowed, static_cast<double>(least_rays), 1e9);
    if (wanted > most_rays) return out;
    rays = std::bit_ceil(static_cast<unsigned>(wanted));
    std::erase_if(light.sources, [&](const ReceiverLight::Source& s) {
        if (!is_crowded(s) || s.count * rays_a_blocker <= rays) return false;
        out.push_back(s);
        return true;
    });
    return out;
}

CrowdedLight::Estimate CrowdedLight::at(const ReceiverLight& light, std::span<const ReceiverLight::Source> sources,
                                        const Point& x, unsigned rays, DirectLight::Workspace& scratch) const {
    EXI_CHECK(rays <= most_rays);
    const Receiver at = direct_->receiver(x, light.n, light.own);
    std::array<SurfacePoint, most_rays> from, to;
    std::array<double, most_rays> kernel;
    std::array<bool, most_rays> blocked;
    const auto bits = [](double c) { return std::bit_cast<std::uint64_t>(c); };
    Estimate out;
    for (const ReceiverLight::Source& source : sources) {
        const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
        const std::span<const Point> corners = direct_->occluders().corners(source.piece);
        const double area = norm(area_vector(corners));
        const ScrambledSobol points(
            hash(static_cast<std::uint64_t>(Stream::direct), bits(x.x), bits(x.y), bits(x.z), source.piece.value));
        std::size_t count = 0;
        double all = 0, arrived = 0;
        for (std::uint32_t i = 0; i < rays; ++i) {
            const Point y = uniform_on(corners, area, points(i, 0), points(i, 1));
            const Vec3 d = y - at.x;
            const double above = dot(light.n, d), below = -dot(emitter.plane.n, d), squared = squared_norm(d);
            if (above <= 0 || below <= 0) continue;
            kernel[count] = emitter.radiance.towards(at.x, y) * above * below / (squared * squared);
            all += kernel[count];
            from[count] = {x, light.own}, to[count] = {y, emitter.region};
            ++count;
        }
        if (all <= 0) continue;
        tracer_->occluded(std::span(from).first(count), std::span(to).first(count), std::span(blocked).first(count));
        for (std::size_t i = 0; i < count; ++i)
            if (!blocked[i]) arrived += kernel[i];
        const double share = arrived / all, E = unblocked(at, source, scratch);
        out.irradiance += share * E * emitter.exitance;
        const double level = E * mean(emitter.exitance);
        out.variance += share * (1 - share) * level * level / static_cast<double>(count);
    }
    return out;
}

}  // namespace exitance
