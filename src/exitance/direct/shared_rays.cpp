#include "exitance/direct/shared_rays.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/direct/source_point.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_quad_corners = 4;  ///< Maximum number of corners; larger pieces are computed exactly.
constexpr double strong_share = 1.0 / 8;     ///< Share of the shadowed light above which a source is computed exactly.

/// Costs in rays: of a visible part, and of each piece clipped from it.
constexpr double cost_of_visible_part = 8, cost_of_blocker = 6;

/// Uncertainty of features smaller than the share of light of one ray: half of that share may be missed.
constexpr double missed_share = 0.5;

/// Nearly hidden light needs no better accuracy than this share of the unoccluded light.
constexpr double min_light_share = 0.05;

/// Share of the ends distributed as if all sources had the same light: a source that is dim at the sample points may be
/// bright at others.
constexpr double even_share = 0.1;

constexpr std::size_t max_sets_per_point = 8;  ///< Maximum per point.

std::array<Point, max_quad_corners> as_quad(std::span<const Point> corners) {
    return {corners[0], corners[1], corners[2], corners[std::min(corners.size(), max_quad_corners) - 1]};
}

}  // namespace

SharedRays::SharedRays(const DirectLight& direct, const RayTracer& tracer) : direct_(&direct), tracer_(&tracer) {
    const Scene& scene = direct.occluders().scene();
    possible_ = scene.distant().empty() && scene.panes().empty();
    for (const DirectLight::Emitter& emitter : direct.emitters())
        possible_ = possible_ && !emitter.radiance.is_directed();
    number_.resize(direct.occluders().pieces().size());
}

void SharedRays::choose(const ReceiverLight& whole, std::span<const Point> places, std::uint64_t seed) {
    const Occluders& occluders = direct_->occluders();
    for (const Source& source : sources_) number_[source.name.piece.value] = 0;
    sources_.clear(), seed_ = seed;
    for (std::vector<End>& set : ends_) set.clear();
    QuadBatch quads;
    for (const ReceiverLight::Source& s : whole.sources) {
        const std::span<const Point> corners = occluders.corners(s.piece);
        if (s.count == 0 || corners.size() > max_quad_corners) continue;
        quads.add(as_quad(corners));
        sources_.push_back({{s.emitter, s.piece}, direct_->emitters()[s.emitter].region, norm(area_vector(corners))});
        number_[s.piece.value] = static_cast<std::uint32_t>(sources_.size());
    }
    factors_.resize(sources_.size());
    double light = 0;
    for (const Point& x : places) {
        point_to_quads(direct_->receiver(x, whole.n, whole.own).x, whole.n, quads, factors_);
        for (std::size_t i = 0; i < sources_.size(); ++i) {
            const double L = factors_[i] * mean(direct_->emitters()[sources_[i].name.emitter].exitance);
            sources_[i].probability += L, light += L;
        }
    }
    before_.assign(1, 0);
    const double even = 1 / static_cast<double>(std::max<std::size_t>(1, sources_.size()));
    for (Source& source : sources_) {
        source.probability = light > 0 ? (1 - even_share) * source.probability / light + even_share * even : even;
        before_.push_back(before_.back() + source.probability);
    }
}

/// Collects the part's sources, except those whose unoccluded light exceeds `most` (W/m^2). Returns the unoccluded
/// light of the collected ones at the receiver.
double SharedRays::gather(const ReceiverLight& light, const Receiver& at, double most, Part& part) {
    part.shadowed.clear(), part.exitance.clear(), part.is_here.assign(sources_.size(), 0);
    double L = 0;
    for (const ReceiverLight::Source& s : light.sources) {
        if (s.count == 0 || number_[s.piece.value] == 0) continue;
        const std::span<const Point> corners = direct_->occluders().corners(s.piece);
        const Spectrum& exitance = direct_->emitters()[s.emitter].exitance;
        const double brings = point_to_polygon(at.x, at.n, corners) * mean(exitance);
        if (brings > most) continue;
        part.shadowed.add(as_quad(corners)), part.exitance.push_back(exitance);
        part.is_here[number_[s.piece.value] - 1] = 1;
        L += brings;
    }
    return L;
}

bool SharedRays::share(const ReceiverLight& light, const Point& middle, const LightAccuracy& accuracy, Part& part,
                       DirectLight::Workspace& scratch) {
    if (!possible_ || !light.behind.empty()) return false;
    const Receiver at = direct_->receiver(middle, light.n, light.own);
    const double all = gather(light, at, HUGE_VAL, part), L = gather(light, at, strong_share * all, part);
    if (part.exitance.empty()) return false;
    part.exact = light;
    double cost = 0;
    std::erase_if(part.exact.sources, [&](const ReceiverLight::Source& s) {
        const std::uint32_t number = s.count > 0 ? number_[s.piece.value] : 0;
        if (number == 0 || !part.is_here[number - 1]) return false;
        cost += std::max(cost_of_visible_part, cost_of_blocker * s.count);
        return true;
    });
    const double lit = mean(direct_->irradiance(part.exact, middle, scratch)) + L / 2;
    const double rays = missed_share * L / std::max(accuracy.allowed(lit), 1e-12 * L);
    return cost >
           std::clamp(rays, static_cast<double>(rays_a_set), static_cast<double>(max_sets_per_point * rays_a_set));
}

/// Returns the ends of a set, one in each stratum of the sources.
std::span<const SharedRays::End> SharedRays::set(std::uint32_t number) {
    std::vector<End>& out = ends_[number];
    if (!out.empty()) return out;
    const ScrambledSobol places(seed_);
    std::array<std::pair<double, std::uint32_t>, rays_a_set> order;
    for (std::uint32_t i = 0; i < rays_a_set; ++i) {
        const std::uint32_t index = number * rays_a_set + i;
        order[i] = {before_.back() * places(index, 2), index};
    }
    std::sort(order.begin(), order.end());
    std::uint32_t source = 0;
    for (const auto& [wanted, index] : order) {
        while (source + 1 < sources_.size() && before_[source + 1] <= wanted) ++source;
        const std::span<const Point> corners = direct_->occluders().corners(sources_[source].name.piece);
        out.push_back({uniform_on(corners, sources_[source].area, places(index, 0), places(index, 1)), source});
    }
    return out;
}

/// Adds the light of the rays to one set of ends.
void SharedRays::cast(const Part& part, const Receiver& at, std::uint32_t number, Sums& sums) {
    from_.clear(), to_.clear(), weight_.clear();
    for (const End& end : set(number)) {
        if (!part.is_here[end.source]) continue;
        const Source& source = sources_[end.source];
        const DirectLight::Emitter& emitter = direct_->emitters()[source.name.emitter];
        const Vec3 d = end.at - at.x;
        const double above = dot(at.n, d), below = -dot(emitter.plane.n, d), squared = squared_norm(d);
        if (above <= 0 || below <= 0) continue;
        from_.push_back({at.x, at.own}), to_.push_back({end.at, source.region});
        const double K = above * below / (pi * squared * squared);
        weight_.push_back(K * source.area / source.probability * emitter.exitance);
    }
    const std::span<bool> blocked(blocked_.get(), to_.size());
    tracer_->occluded(from_, to_, blocked);
    Spectrum sent, arrived;
    for (std::size_t i = 0; i < to_.size(); ++i) {
        sent += weight_[i];
        if (!blocked[i]) arrived += weight_[i];
    }
    sums.sent += sent, sums.arrived += arrived, sums.rays += to_.size();
    // Neighbouring strata: half of the squared difference of their visible light is the variance of each.
    for (std::size_t i = 1; i < to_.size(); i += 2)
        if (blocked[i] != blocked[i - 1]) sums.squares += std::pow(mean(weight_[i] + weight_[i - 1]) / 2, 2);
}

ClusteredLight::Estimate SharedRays::at(const Part& part, const Point& x, std::uint32_t set,
                                        const LightAccuracy& accuracy, DirectLight::Workspace& scratch) {
    const Receiver at = direct_->receiver(x, part.exact.n, part.exact.own);
    ClusteredLight::Estimate out{direct_->irradiance(part.exact, x, scratch)};
    factors_.resize(part.shadowed.size());
    point_to_quads(at.x, at.n, part.shadowed, factors_);
    Spectrum L;
    for (std::size_t i = 0; i < factors_.size(); ++i) L += factors_[i] * part.exitance[i];
    if (!(mean(L) > 0)) return out;
    Sums sums;
    const auto arrived = [&] {
        Spectrum E;  // half of it if no ray gives an estimate
        for (std::size_t b = 0; b < bands; ++b)
            E[b] = L[b] * (sums.sent[b] > 0 ? sums.arrived[b] / sums.sent[b] : missed_share);
        return E;
    };
    const auto variance = [&] {
        if (sums.rays == 0) return std::pow(missed_share * mean(L), 2);
        const double scale = mean(L) / mean(sums.sent), each = missed_share * mean(L) / static_cast<double>(sums.rays);
        return scale * scale * sums.squares + each * each;
    };
    cast(part, at, set % sets, sums);
    const double allowed = accuracy.allowed(std::max(mean(out.irradiance + arrived()), min_light_share * mean(L)));
    if (const double before = variance(), limit = allowed * allowed; before > limit) {
        // The mean square error of stratified rays falls about as the power -3/2 of their number.
        const double wanted = std::clamp(std::ceil(std::pow(before / limit, 2.0 / 3)), 2.0, 1.0 * max_sets_per_point);
        for (std::uint32_t k = 1; k < static_cast<std::uint32_t>(wanted); ++k) cast(part, at, (set + k) % sets, sums);
    }
    out.irradiance += arrived();
    out.variance = variance(), out.rays = sums.rays;
    return out;
}

}  // namespace exitance
