#include "exitance/direct/clustered_light.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/direct/source_point.hpp"

namespace exitance {
namespace {

constexpr double strong_share = 1.0 / 8;  ///< Share of the light above which a source is computed exactly.

// Costs in rays: of a visible part, and of a cut.
constexpr double cost_of_visible_part = 8, cost_of_cut = 60;
/// Effective number of sources up to which exact light is not more expensive than rays.
constexpr double min_effective_sources = 24;

/// Minimum number of sources in a scene. With fewer, the noise of rays causes splits of elements that exact light does
/// not: a sky of 512 triangles over a room took ten times as long by clusters.
constexpr std::size_t min_sources = 1000;

constexpr unsigned least_rays = 8;

/// Uncertainty of features smaller than the share of light of one ray: half of that share may be missed.
constexpr double missed_share = 0.5;

/// Random key of a point, computed from its coordinates.
std::uint64_t key_of(const Receiver& at) {
    return hash(static_cast<std::uint64_t>(Stream::direct), std::bit_cast<std::uint64_t>(at.x.x),
                std::bit_cast<std::uint64_t>(at.x.y), std::bit_cast<std::uint64_t>(at.x.z), at.own.value);
}

unsigned power_of_two(double rays, unsigned least, unsigned most) {
    return std::bit_ceil(
        static_cast<unsigned>(std::clamp(rays, static_cast<double>(least), static_cast<double>(most))));
}

}  // namespace

ClusteredLight::ClusteredLight(const DirectLight& direct, const RayTracer& tracer)
    : direct_(&direct), tracer_(&tracer), tree_(direct) {
    // The few large faces of a sky are computed exactly.
    possible_ = tree_.sources().size() > min_sources && direct.occluders().scene().distant().empty() &&
                direct.occluders().scene().panes().empty();
    for (const DirectLight::Emitter& emitter : direct.emitters())
        possible_ = possible_ && !emitter.radiance.is_directed();
}

Receiver ClusteredLight::receiver(const Point& x, const Normal& n, RegionId own) const {
    if (own.is_none()) return {x, n, own};
    const Plane& plane = direct_->occluders().scene().regions()[own].plane;
    return {x - plane.signed_distance(x) * plane.n, n, own};
}

bool ClusteredLight::pays(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                          Workspace& room) const {
    if (!is_possible() || !direct_->occluders().scene().behind(own).is_none()) return false;
    constexpr double coarse_error = 0.2;
    tree_.cut(receiver(x, n, own), coarse_error, 0, room.cut_);
    const double light = room.cut_.light, sources = tree_.effective_sources(room.cut_);
    if (sources <= min_effective_sources) return false;
    const double rays = std::min<double>(accuracy.most_rays, light / accuracy.allowed(light));
    return cost_of_visible_part * sources > cost_of_cut + rays;
}

/// Computes the strong sources of the cut exactly, and the prefix sums of the others' light. Returns the sum of the
/// latter.
double ClusteredLight::look_closely(const Receiver& at, Workspace& room, Spectrum& exact) const {
    room.light_before_.assign(1, 0);
    for (EmitterTree::Term& term : room.cut_.terms) {
        const EmitterTree::Node& node = tree_.nodes()[term.node];
        if (node.is_leaf() && term.light > strong_share * room.cut_.light) {
            const EmitterTree::Source& source = tree_.sources()[node.first];
            const double F = visible_form_factor(direct_->occluders(), at, source.name.piece, room.exact);
            exact += F * direct_->emitters()[source.name.emitter].exitance;
            term.light = 0;
        }
        room.light_before_.push_back(room.light_before_.back() + term.light);
    }
    return room.light_before_.back();
}

/// Adds the light of `rays` rays, one per stratum of the terms' light, to `sum`. Returns its variance.
double ClusteredLight::cast(const Receiver& at, double light, unsigned rays, std::uint64_t key, Workspace& room,
                            Spectrum& sum) const {
    room.from_.clear(), room.to_.clear(), room.term_.clear();
    const ScrambledSobol places(key);
    const std::vector<double>& before = room.light_before_;
    std::size_t term = 0;
    for (std::uint32_t i = 0; i < rays; ++i) {
        const double wanted = light * (i + places(i, 2)) / rays;
        while (term + 2 < before.size() && before[term + 1] <= wanted) ++term;
        const EmitterTree::Node& node = tree_.nodes()[room.cut_.terms[term].node];
        const double within = before[term + 1] > before[term]
                                  ? std::clamp((wanted - before[term]) / (before[term + 1] - before[term]), 0.0, 1.0)
                                  : 0.5;
        const auto first = tree_.power_before().begin() + node.first, last = tree_.power_before().begin() + node.last;
        const auto found = std::upper_bound(first + 1, last, *first + within * (*last - *first));
        const EmitterTree::Source& source =
            tree_.sources()[static_cast<std::size_t>(found - tree_.power_before().begin()) - 1];
        const std::span<const Point> corners = direct_->occluders().corners(source.name.piece);
        room.from_.push_back({at.x, at.own});
        room.to_.push_back({uniform_on(corners, source.area, places(i, 0), places(i, 1)), source.region});
        room.term_.push_back(static_cast<std::uint32_t>(term));
    }
    const std::span<bool> blocked(room.blocked_.get(), rays);
    tracer_->occluded(room.from_, room.to_, blocked);
    const double each = light / rays;
    double differences = 0;
    for (std::uint32_t i = 0; i < rays; ++i) {
        if (!blocked[i]) sum += each * tree_.nodes()[room.cut_.terms[room.term_[i]].node].colour;
        // Neighbouring strata: half of their squared difference is the variance of each.
        if (i % 2 == 1 && blocked[i] != blocked[i - 1]) differences += each * each;
    }
    return differences + missed_share * missed_share * each * each;
}

ClusteredLight::Estimate ClusteredLight::by_clusters(const Point& x, const Normal& n, RegionId own,
                                                     const LightAccuracy& accuracy, Workspace& room) const {
    const Receiver at = receiver(x, n, own);
    tree_.cut(at, accuracy.relative / 2, accuracy.absolute / 2, room.cut_);
    Estimate out;
    const double light = look_closely(at, room, out.irradiance);
    // Remaining light that is only a small part of the total needs no better accuracy than this part of the total.
    constexpr double min_share_of_total = 0.05;
    const auto allowed = [&](const Spectrum& E) {
        return std::max(accuracy.allowed(std::max(mean(E), min_share_of_total * room.cut_.light)),
                        1e-12 * room.cut_.light);
    };
    if (light > 0) {
        const std::uint64_t key = key_of(at);
        constexpr unsigned max_first_rays = 128;
        const unsigned first =
            power_of_two(missed_share * light / allowed(out.irradiance + Spectrum(light)), least_rays, max_first_rays);
        Spectrum by_rays;
        double variance = cast(at, light, first, key, room, by_rays);
        out.rays = first;
        const double limit = std::pow(allowed(out.irradiance + by_rays), 2);
        if (variance > limit) {
            // The mean square error of stratified rays falls about as the power -3/2 of their number.
            const unsigned more = power_of_two(first * std::pow(variance / limit, 2.0 / 3), first, accuracy.most_rays);
            Spectrum again;
            const double variance_again = cast(at, light, more, hash(key, 1u), room, again);
            const double share = static_cast<double>(more) / (first + more);
            by_rays = (1 - share) * by_rays + share * again;
            variance = (1 - share) * (1 - share) * variance + share * share * variance_again;
            out.rays += more;
        }
        out.irradiance += by_rays;
        out.variance = variance + room.cut_.error * room.cut_.error;
    }
    if (!direct_->beams().empty()) out.irradiance += direct_->beams().irradiance(at);
    return out;
}

ClusteredLight::Estimate ClusteredLight::at(const Point& x, const Normal& n, RegionId own,
                                            const LightAccuracy& accuracy, Workspace& room) const {
    if (pays(x, n, own, accuracy, room)) return by_clusters(x, n, own, accuracy, room);
    return {direct_->irradiance(x, n, own, room.exact)};
}

}  // namespace exitance
