#include "exitance/direct/ray_light.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Errors of n rays fall as n^(-error_exponent), variances with twice that power. Derived from points of a Sobol
/// sequence, for light that is cut by edges.
constexpr double error_exponent = 0.75;
/// Exponent of a part's variance in its number of rays. Derived from the least number of all rays for a sum of
/// variances.
constexpr double power_of_variance = 1 / (1 + 2 * error_exponent);
constexpr std::uint32_t fastest_growth = 16;  ///< Limit per round, since a variance from few rays is uncertain.

}  // namespace

std::uint32_t RayLight::power_of_two(double rays, std::uint32_t least, std::uint32_t most) {
    return std::bit_ceil(
        static_cast<std::uint32_t>(std::clamp(rays, static_cast<double>(least), static_cast<double>(most))));
}

std::uint64_t RayLight::key_of(const Point& x, RegionId own) {
    const auto bits = [](double c) { return std::bit_cast<std::uint64_t>(c); };
    return hash(static_cast<std::uint64_t>(Stream::direct), bits(x.x), bits(x.y), bits(x.z), own.value);
}

Spectrum RayLight::Estimate::standard_error() const {
    const double level = mean(irradiance), error = std::sqrt(variance);
    return level > 0 ? error / level * irradiance : Spectrum(error);
}

double RayLight::rays_for(double relative_error) {
    return std::pow(half_hidden / relative_error, 1 / error_exponent);
}

double RayLight::rays_for(const LightAccuracy& accuracy, double open) {
    // Derived from 32-bit counts of rays: a smaller error requires more rays than they hold.
    constexpr double min_error = 1e-9;
    return rays_for(std::max(accuracy.allowed(open) / open, min_error));
}

double RayLight::error_of(double rays) {
    return half_hidden * std::pow(rays, -error_exponent);
}

RayLight::RayLight(const DirectLight& direct, const RayTracer& tracer)
    : direct_(&direct),
      tracer_(&tracer),
      tree_(direct),
      sky_(kept_domes(direct)),
      discs_(distant_discs(direct)),
      size_(direct.occluders().scene().size()),
      glass_(direct.occluders().scene()) {}

/// Returns the variance of a part that decides its number of rays.
double RayLight::expected_variance(const Part& part, const Spread* known) const {
    if (!known || part.kind == Part::Kind::piece) return variance(part);
    const std::optional<double> of_one = part.kind == Part::Kind::sky        ? known->sky
                                         : part.kind == Part::Kind::openings ? known->openings
                                                                             : known->others;
    return of_one ? *of_one * std::pow(part.rays, -2 * error_exponent) : variance(part);
}

RayLight::Estimate RayLight::on_side(const Start& start, const LightAccuracy& accuracy, const Spread* known,
                                     Workspace& room) const {
    Estimate out;
    const double open = find_parts(start.at, accuracy, room);
    for (Part& part : room.parts_) add_rays(start, part, 4 * part.block, room);
    for (bool grows = true; grows;) {
        trace(room);
        out = Estimate();
        double expected = 0;
        double rates = 0;  // sum of c^(2/5), c the variance of one ray; 2/5 is `power_of_variance`
        for (const Part& part : room.parts_) {
            out.irradiance += part.light(), out.variance += this->variance(part), out.rays += part.rays;
            const double variance = expected_variance(part, known);
            expected += variance;
            rates += std::pow(variance * std::pow(part.rays, 2 * error_exponent), power_of_variance);
        }
        // Less than the light found by a standard deviation: light that is overestimated must not end the search.
        const double least = std::max(mean(out.irradiance) - std::sqrt(out.variance), min_share * open);
        const double allowed = accuracy.allowed(least);
        const double limit = allowed * allowed;
        if (expected <= limit || out.rays >= accuracy.max_rays) break;
        // The variance sum of c_i n_i^(-3/2) is reached with fewest rays by n_i in proportion to c_i^(2/5).
        grows = false;
        const double scale = std::pow(rates / limit, 0.5 / error_exponent);
        for (Part& part : room.parts_) {
            const double wanted =
                scale *
                std::pow(expected_variance(part, known) * std::pow(part.rays, 2 * error_exponent), power_of_variance);
            const std::uint32_t rays = power_of_two(wanted, 1, std::min(fastest_growth * part.rays, accuracy.max_rays));
            if (rays <= part.rays) continue;
            add_rays(start, part, rays, room);
            grows = true;
        }
    }
    for (const Part& part : room.parts_)
        out.parallel += part.kind == Part::Kind::others ? part.distant / static_cast<double>(part.rays)
                        : part.kind != Part::Kind::piece || direct_->is_distant(part.source.emitter) ? part.light()
                                                                                                     : Spectrum();
    if (!direct_->beams().empty()) out.irradiance += direct_->beams().irradiance(start.at, &out.parallel);
    return out;
}

/// Returns the unoccluded light of all parts but those of sky and sun that probably pass by the openings, W/m^2.
double RayLight::light_through_openings(const Workspace& room) const {
    double sum = 0;
    for (const Part& part : room.parts_) {
        double share = 1;
        if (part.kind == Part::Kind::sky)
            share = openings().hidden_sky(part.scene_part, min_pilot);
        else if (part.is_sun && !room.portals_.is_aimed_at(part.seen->at(0.5, 0.5) - part.from))
            share = openings().hidden_sun(part.scene_part, min_pilot);
        sum += share * mean(part.open);
    }
    return sum;
}

double RayLight::forecast(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                          Workspace& room) const {
    constexpr double work_of_place = 20;  // time to choose the parts, in times of a ray; measured by hand
    double open = find_parts(direct_->receiver(x, n, own), accuracy, room);
    if (std::any_of(room.parts_.begin(), room.parts_.end(),
                    [](const Part& part) { return part.kind == Part::Kind::openings; }))
        open = light_through_openings(room);
    const double rays = open > 0 ? rays_for(accuracy, open) : 0;
    return work_of_place + std::clamp(rays, 1.0 * min_pilot, 1.0 * accuracy.max_rays);
}

/// Measures the spread at every fourth place.
RayLight::Spread RayLight::spread_on_side(std::span<const Point> places, const Normal& n, RegionId own,
                                          const LightAccuracy& accuracy, Workspace& room) const {
    constexpr std::size_t every = 4;  // derived from the cost: a quarter of the rays
    struct Mean {
        double sum = 0, count = 0;

        std::optional<double> value() const { return count > 0 ? std::optional(sum / count) : std::nullopt; }
    } sky, openings, others;
    for (std::size_t i = every / 2; i < places.size(); i += every) {
        on_side({direct_->receiver(places[i], n, own), hash(key_of(places[i], own))}, accuracy, nullptr, room);
        for (const Part& part : room.parts_) {
            if (part.kind == Part::Kind::piece) continue;
            Mean& of_kind = part.kind == Part::Kind::sky ? sky : part.kind == Part::Kind::openings ? openings : others;
            of_kind.sum += variance(part) * std::pow(part.rays, 2 * error_exponent), of_kind.count += 1;
        }
    }
    return {sky.value(), openings.value(), others.value()};
}

RayLight::Spreads RayLight::spreads(std::span<const Point> places, const Normal& n, RegionId own,
                                    const LightAccuracy& accuracy, Workspace& room) const {
    const RegionId behind = direct_->occluders().scene().behind(own);
    Spreads out{spread_on_side(places, n, own, accuracy, room), {}};
    if (!behind.is_none()) out.back = spread_on_side(places, -n, behind, accuracy, room);
    return out;
}

RayLight::Estimate RayLight::at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                                Workspace& room, const Spreads* known) const {
    const RegionId behind = direct_->occluders().scene().behind(own);
    const auto on = [&](const Normal& normal, RegionId side, const Spread* spread) {
        return on_side({direct_->receiver(x, normal, side), key_of(x, side)}, accuracy, spread, room);
    };
    const Estimate front = on(n, own, known ? &known->front : nullptr);
    if (behind.is_none()) return front;
    const double through = direct_->occluders().scene().material(own).through, not_through = 1 - through;
    const Estimate back = on(-n, behind, known ? &known->back : nullptr);
    return {not_through * front.irradiance + through * back.irradiance,
            not_through * front.parallel + through * back.parallel,
            not_through * not_through * front.variance + through * through * back.variance, front.rays + back.rays};
}

}  // namespace exitance
