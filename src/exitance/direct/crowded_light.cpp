#include "exitance/direct/crowded_light.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/direct/source_point.hpp"

namespace exitance {
namespace {

/// Cost of a blocker that is clipped from a source, in rays: about a microsecond if there are many fragments.
constexpr unsigned rays_a_blocker = 6;
constexpr std::size_t max_exact_candidates = 3;  ///< With at most this many candidates, visible parts are exact.

}  // namespace

/// Sums over four quarters of the rays from a point to a source: unoccluded and arrived light.
struct CrowdedLight::Sums {
    std::array<double, 4> all{}, arrived{};

    /// Makes room for as many further rays: the existing ones become the first two quarters.
    void halve() {
        for (auto* sums : {&all, &arrived}) *sums = {(*sums)[0] + (*sums)[1], (*sums)[2] + (*sums)[3], 0, 0};
    }
    double total() const { return all[0] + all[1] + all[2] + all[3]; }
    double share() const { return (arrived[0] + arrived[1] + arrived[2] + arrived[3]) / total(); }
    /// Variance of the share, as if quarters were independent; linearized for the quotient of two sums.
    double variance() const {
        const double whole = total(), part = share();
        double squares = 0;
        for (std::size_t q = 0; q < 4; ++q) squares += std::pow(arrived[q] - part * all[q], 2);
        return 4.0 / 3 * squares / (whole * whole);
    }
};

unsigned CrowdedLight::rays_for(double E, double allowed) {
    // A ray arrives or not: the variance of n rays is at most E^2 / (4 n).
    const double wanted = std::clamp(0.25 * E * E / allowed, static_cast<double>(least_rays), 1e9);
    return std::bit_ceil(static_cast<unsigned>(wanted));
}

bool CrowdedLight::may_be_crowded(const SourceName& source) const {
    return !direct_->is_distant(source.emitter) || direct_->looks_far(source.emitter);  // not through panes
}

double CrowdedLight::unblocked(const Receiver& at, const SourceName& source, DirectLight::Workspace& scratch) const {
    const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
    return visible_form_factor(direct_->occluders(), at, source.piece, {}, scratch, emitter.radiance);
}

/// Unoccluded light of the sources that may be crowded, W/m^2. Added as a root of the sum of squares, since their noise
/// adds up so.
double CrowdedLight::power_at(const Receiver& at, RegionId own, const std::vector<SourceName>* named,
                              DirectLight::Workspace& scratch) const {
    double power = 0;
    const auto add = [&](const SourceName& source) {
        if (!may_be_crowded(source)) return;
        power = std::hypot(power, unblocked(at, source, scratch) * mean(direct_->emitters()[source.emitter].exitance));
    };
    if (named) {
        for (const SourceName& source : *named) add(source);
        return power;
    }
    for (std::uint32_t e = 0; e < direct_->emitters().size(); ++e) {
        const DirectLight::Emitter& emitter = direct_->emitters()[e];
        if (!direct_->shines_on(emitter, own)) continue;
        for (const PieceId piece : emitter.pieces) add({e, piece});
    }
    return power;
}

CrowdedLight::Crowd CrowdedLight::prepare(std::span<const Point> receiver, const Normal& n, RegionId own,
                                          double allowed, ReceiverLight& light, DirectLight::Workspace& scratch,
                                          const std::vector<SourceName>* named) const {
    DirectLight::WorthCounting worth;
    const Point middle = centroid(receiver);
    const bool is_possible = allowed > 0 && direct_->occluders().scene().panes().empty();
    std::optional<unsigned> rays;  // number of rays to each source, if all of them were estimated by rays
    if (is_possible)
        worth = [&](const SourceName& source) -> std::size_t {
            const Receiver at = direct_->receiver(middle, n, own);
            if (!rays) rays = rays_for(power_at(at, own, named, scratch), allowed);
            // A source below the horizon of the centre gives no estimate of the rays that other points need.
            if (*rays > most_rays || !may_be_crowded(source) || unblocked(at, source, scratch) <= 0)
                return Shaft::all_candidates;
            return std::max<std::size_t>(max_exact_candidates, *rays / rays_a_blocker);
        };
    if (named)
        direct_->prepare(receiver, n, own, *named, light, scratch, worth);
    else
        direct_->prepare(receiver, n, own, light, scratch, worth);
    return is_possible && light.behind.empty() ? take_crowded(light, middle, allowed, scratch) : Crowd();
}

CrowdedLight::Crowd CrowdedLight::take_crowded(ReceiverLight& light, const Point& middle, double allowed,
                                               DirectLight::Workspace& scratch) const {
    const auto may_be = [&](const ReceiverLight::Source& s) {
        return s.is_crowded || (s.count > max_exact_candidates && may_be_crowded({s.emitter, s.piece}));
    };
    Crowd out{.sources = {}, .allowed = allowed};
    if (std::none_of(light.sources.begin(), light.sources.end(), may_be)) return out;
    const Receiver at = direct_->receiver(middle, light.n, light.own);
    double power = 0;
    for (const ReceiverLight::Source& s : light.sources) {
        if (!may_be(s)) continue;
        out.sources.push_back({s, unblocked(at, {s.emitter, s.piece}, scratch)});
        power = std::hypot(power, out.sources.back().factor * mean(direct_->emitters()[s.emitter].exitance));
    }
    const unsigned wanted = rays_for(power, allowed);
    out.rays = std::min(wanted, most_rays);
    const auto pays = [&](const ReceiverLight::Source& s) {
        return s.is_crowded || (may_be(s) && s.count * rays_a_blocker > wanted);
    };
    std::erase_if(out.sources, [&](const Crowd::Source& s) { return !pays(s.source); });
    std::erase_if(light.sources, pays);
    return out;
}

/// Casts rays `first` to `last` of every point; each point has its own Sobol points.
void CrowdedLight::cast(const ReceiverLight& light, const ReceiverLight::Source& source, std::span<const Point> places,
                        unsigned first, unsigned last, std::span<Sums> sums) const {
    constexpr std::size_t together = 64;
    std::array<SurfacePoint, together> from, to;
    std::array<double, together> kernel, s, t;
    std::array<std::uint32_t, together> quarter;  // 4 times the point's index, plus the quarter of the ray
    std::array<bool, together> blocked;
    const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
    const std::span<const Point> corners = direct_->occluders().corners(source.piece);
    const double area = norm(area_vector(corners));
    const Box& box = direct_->occluders().scene().box();
    const bool is_far = direct_->looks_far(source.emitter);
    const auto bits = [](double c) { return std::bit_cast<std::uint64_t>(c); };
    std::size_t count = 0;
    const auto trace = [&] {
        tracer_->occluded(std::span(from).first(count), std::span(to).first(count), std::span(blocked).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            Sums& of = sums[quarter[i] / 4];
            of.all[quarter[i] % 4] += kernel[i];
            if (!blocked[i]) of.arrived[quarter[i] % 4] += kernel[i];
        }
        count = 0;
    };
    for (std::uint32_t p = 0; p < places.size(); ++p) {
        const Point &name = places[p], x = direct_->receiver(name, light.n, light.own).x;
        const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::direct), bits(name.x), bits(name.y),
                                         bits(name.z), source.piece.value));
        const SeenPolygon seen(corners, emitter.plane.n, area, x);
        const double reach = 2 * norm(box.hi - box.lo) + norm(x - box.lo);
        for (unsigned begin = first; begin < last;) {
            const auto some = std::min<std::size_t>(together - count, last - begin);
            points.fill(begin, 0, std::span(s).first(some));
            points.fill(begin, 1, std::span(t).first(some));
            for (std::size_t i = 0; i < some; ++i) {
                const Point y = seen.at(s[i], t[i]);
                const Vec3 d = y - x;
                const double weight = seen.weight(d, light.n);
                if (weight <= 0) continue;
                kernel[count] = weight * emitter.radiance.towards(x, y);
                // For the sky only the direction matters; the ray must leave the scene.
                const double part = is_far ? std::min(1.0, reach / norm(d)) : 1;
                from[count] = {places[p], light.own}, to[count] = {x + part * d, emitter.region};
                quarter[count++] = 4 * p + 4 * (begin + static_cast<std::uint32_t>(i)) / last;
            }
            begin += static_cast<unsigned>(some);
            if (count == together) trace();
        }
    }
    trace();
}

std::vector<CrowdedLight::Estimate> CrowdedLight::at(const ReceiverLight& light, const Crowd& crowd,
                                                     std::span<const Point> places,
                                                     DirectLight::Workspace& scratch) const {
    EXI_CHECK(crowd.rays <= most_rays && std::has_single_bit(crowd.rays));
    const std::size_t count = places.size();
    std::vector<double> level(crowd.sources.size() * count);  // F at every point
    std::vector<Sums> sums(level.size());
    for (std::size_t k = 0, i = 0; k < crowd.sources.size(); ++k)
        for (const Point& x : places) {
            const auto& [source, factor] = crowd.sources[k];
            const Receiver at = direct_->receiver(x, light.n, light.own);
            level[i++] =
                direct_->looks_far(source.emitter) ? factor : unblocked(at, {source.emitter, source.piece}, scratch);
        }
    std::vector<Estimate> out;
    unsigned rays = std::max(least_rays, crowd.rays / 4);
    for (unsigned before = 0;; before = rays, rays *= 2) {
        for (Sums& s : sums)
            if (before > 0) s.halve();
        for (std::size_t k = 0; k < crowd.sources.size(); ++k)
            cast(light, crowd.sources[k].source, places, before, rays, std::span(sums).subspan(k * count, count));
        out.assign(count, {});
        double variance = 0;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (sums[i].total() <= 0) continue;
            const ReceiverLight::Source& source = crowd.sources[i / count].source;
            const Spectrum whole = level[i] * direct_->emitters()[source.emitter].exitance;
            Estimate& at = out[i % count];
            at.irradiance += sums[i].share() * whole;
            if (direct_->looks_far(source.emitter)) at.parallel += sums[i].share() * whole;
            const double own = sums[i].variance() * mean(whole) * mean(whole);
            at.variance += own, variance += own / static_cast<double>(count);
        }
        if (variance <= crowd.allowed || rays >= crowd.rays) return out;
    }
}

}  // namespace exitance
