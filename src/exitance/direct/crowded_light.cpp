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

std::vector<CrowdedLight::Source> CrowdedLight::take_crowded(ReceiverLight& light, const Point& middle, double allowed,
                                                             DirectLight::Workspace& scratch, unsigned& rays) const {
    // Not through panes.
    const auto is_crowded = [&](const ReceiverLight::Source& s) {
        return s.count > least_crowd && (!direct_->is_distant(s.emitter) || direct_->looks_far(s.emitter));
    };
    std::vector<Source> out;
    if (!direct_->occluders().scene().panes().empty()) return out;
    if (allowed <= 0 || !light.behind.empty() || std::none_of(light.sources.begin(), light.sources.end(), is_crowded))
        return out;
    const Receiver at = direct_->receiver(middle, light.n, light.own);
    // A ray comes or does not: the variance of n is F^2 / (4 n) at most.
    double power = 0;
    for (const ReceiverLight::Source& s : light.sources) {
        if (!is_crowded(s)) continue;
        out.push_back({s, unblocked(at, s, scratch)});
        const double E = out.back().factor * mean(direct_->emitters()[s.emitter].exitance);
        power += 0.25 * E * E;
    }
    const double wanted = std::clamp(power / allowed, static_cast<double>(least_rays), 1e9);
    if (wanted > most_rays) return {};
    rays = std::bit_ceil(static_cast<unsigned>(wanted));
    const auto pays = [&](const ReceiverLight::Source& s) { return is_crowded(s) && s.count * rays_a_blocker > rays; };
    std::erase_if(light.sources, pays);
    std::erase_if(out, [&](const Source& s) { return !pays(s.source); });
    return out;
}

CrowdedLight::Estimate CrowdedLight::at(const ReceiverLight& light, std::span<const Source> sources, const Point& x,
                                        unsigned rays, DirectLight::Workspace& scratch, Spectrum* parallel) const {
    EXI_CHECK(rays <= most_rays);
    const Receiver at = direct_->receiver(x, light.n, light.own);
    std::array<SurfacePoint, most_rays> from, to;
    std::array<double, most_rays> kernel;
    std::array<bool, most_rays> blocked;
    const Box& box = direct_->occluders().scene().box();
    const double reach = 2 * norm(box.hi - box.lo) + norm(x - box.lo);
    const auto bits = [](double c) { return std::bit_cast<std::uint64_t>(c); };
    Estimate out;
    for (const auto& [source, factor] : sources) {
        const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
        const std::span<const Point> corners = direct_->occluders().corners(source.piece);
        const double area = norm(area_vector(corners));
        const ScrambledSobol points(
            hash(static_cast<std::uint64_t>(Stream::direct), bits(x.x), bits(x.y), bits(x.z), source.piece.value));
        const bool is_far = direct_->looks_far(source.emitter);
        std::size_t count = 0;
        double all = 0, arrived = 0;
        for (std::uint32_t i = 0; i < rays; ++i) {
            const Point y = uniform_on(corners, area, points(i, 0), points(i, 1));
            const Vec3 d = y - at.x;
            const double above = dot(light.n, d), below = -dot(emitter.plane.n, d), squared = squared_norm(d);
            if (above <= 0 || below <= 0) continue;
            kernel[count] = emitter.radiance.towards(at.x, y) * above * below / (squared * squared);
            all += kernel[count];
            // Of the sky a ray needs the direction alone, and to leave the scene.
            const double part = is_far ? std::min(1.0, reach / std::sqrt(squared)) : 1;
            from[count] = {x, light.own}, to[count] = {at.x + part * d, emitter.region};
            ++count;
        }
        if (all <= 0) continue;
        tracer_->occluded(std::span(from).first(count), std::span(to).first(count), std::span(blocked).first(count));
        for (std::size_t i = 0; i < count; ++i)
            if (!blocked[i]) arrived += kernel[i];
        const double share = arrived / all, E = is_far ? factor : unblocked(at, source, scratch);
        out.irradiance += share * E * emitter.exitance;
        if (parallel && is_far) *parallel += share * E * emitter.exitance;
        const double level = E * mean(emitter.exitance);
        out.variance += share * (1 - share) * level * level / static_cast<double>(count);
    }
    return out;
}

}  // namespace exitance
