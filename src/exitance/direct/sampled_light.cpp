#include "exitance/direct/sampled_light.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/direct/source_point.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/window_view.hpp"

namespace exitance {
namespace {

constexpr unsigned rays_for_sight = 16;  // per element

/// Distributes an integer number of rays to a sequence of sources, each within one of its expected number. The total
/// has the least possible randomness: where rays of equal weight are counted, almost none.
class RayDistributor {
  public:
    /// `begin`: a random number, uniform in [0, 1).
    explicit RayDistributor(double begin) : sum_(begin) {}
    unsigned next(double expected) {
        const double before = std::floor(sum_);
        sum_ += expected;
        return static_cast<unsigned>(std::floor(sum_) - before);
    }

  private:
    double sum_;
};

/// Relative radiance towards a point, at least a minimum that allows for a beam's edge within the element.
double likely_radiance(const DirectLight::Emitter& emitter, const Point& x) {
    constexpr double least = 0.05;
    return std::max(least, emitter.radiance.towards(x, emitter.centre));
}

constexpr std::size_t max_quad_corners = 4;  ///< Maximum number of corners; a triangle repeats its last one.

}  // namespace

SampledLight::SampledLight(const DirectLight& direct, const RayTracer& tracer, std::uint64_t seed)
    : direct_(direct), tracer_(tracer), seed_(seed) {
    for (const DirectLight::Emitter& emitter : direct_.emitters())
        for (PieceId piece : emitter.pieces) {
            const std::span<const Point> corners = direct_.occluders().corners(piece);
            quads_.add({corners[0], corners[1], corners[2], corners[std::min(corners.size(), max_quad_corners) - 1]});
            area_.push_back(norm(area_vector(corners)));
        }
    F_.resize(quads_.size());
}

void SampledLight::find_sources(const Point& x, const Normal& n, RegionId own, double radius) {
    sources_.clear();
    point_to_quads(x, n, quads_, F_);
    double all = 0;
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < direct_.emitters().size(); ++i) {
        const DirectLight::Emitter& emitter = direct_.emitters()[i];
        const std::size_t first = std::exchange(next, next + emitter.pieces.size());
        if (!direct_.shines_on(emitter, own) || emitter.plane.signed_distance(x) <= 0 ||
            dot(n, emitter.centre - x) <= -emitter.radius)
            continue;
        for (std::size_t k = 0; k < emitter.pieces.size(); ++k) {
            const PieceId piece = emitter.pieces[k];
            const std::span<const Point> corners = direct_.occluders().corners(piece);
            const double F = corners.size() <= max_quad_corners ? F_[first + k] : point_to_polygon(x, n, corners);
            if (F <= 0) continue;
            const double weighted = F * likely_radiance(emitter, x);
            const double both = radius + emitter.radius;
            const double near = std::min(1.0, both * both / squared_norm(emitter.centre - x));
            sources_.push_back({{i, piece},
                                emitter.region,
                                weighted,
                                area_[first + k],
                                weighted * emitter.exitance,
                                0,
                                near,
                                {},
                                0,
                                0});
            all += mean(sources_.back().light);
        }
    }
    for (Source& source : sources_) source.share = mean(source.light) / all;
}

void SampledLight::add_rays(const ElementTree& tree, ElementId e, std::uint32_t s, unsigned rays, Purpose purpose) {
    Source& source = sources_[s];
    source.rays = rays, source.arrived = 0;
    if (rays == 0) return;
    const ScrambledSobol points(hash(seed_, static_cast<std::uint64_t>(Stream::direct), e.value,
                                     source.name.piece.value, static_cast<std::uint64_t>(purpose)));
    const RegionId own = tree.region(e);
    const Normal& n = direct_.occluders().scene().regions()[own].plane.n;
    const Plane& plane = direct_.emitters()[source.name.emitter].plane;
    const std::span<const Point> corners = direct_.occluders().corners(source.name.piece);
    for (std::uint32_t i = 0; i < rays; ++i) {
        const Point x = tree.patch(e).at(tree.uniform(e, points(i, 0), points(i, 1)));
        const Point y = uniform_on(corners, source.area, points(i, 2), points(i, 3));
        const Vec3 d = y - x;
        const double above = dot(n, d), below = -dot(plane.n, d), squared = squared_norm(d);
        if (above <= 0 || below <= 0) continue;
        from_.push_back({x, own}), to_.push_back({y, source.region});
        const double p = direct_.emitters()[source.name.emitter].radiance.towards(x, y);
        rays_.push_back({p * above * below / (pi * squared * squared), s});
    }
}

void SampledLight::trace_rays() {
    std::array<bool, most_rays + 1> blocked;
    EXI_CHECK(rays_.size() <= blocked.size());
    tracer_.occluded(from_, to_, std::span(blocked).first(rays_.size()));
    // Rays through a window to the sky are continued from just behind the pane, which is part of the radiance.
    const Occluders& occluders = direct_.occluders();
    const double size = occluders.scene().size();
    std::vector<std::size_t> on;
    std::vector<SurfacePoint> behind, far;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        if (blocked[i] || !looks_out_on_faces(occluders, sources_[rays_[i].source].name.piece)) continue;
        constexpr double step = 1e-5, beyond_all = 2;  // both as multiples of the scene's size
        const Vec3 d = normalized(to_[i].at - from_[i].at);
        on.push_back(i);
        behind.push_back({to_[i].at + (step * size) * d, RegionId()});
        far.push_back({to_[i].at + (beyond_all * size) * d, RegionId()});
    }
    std::array<bool, most_rays + 1> hidden;
    tracer_.occluded(behind, far, std::span(hidden).first(on.size()));
    for (std::size_t k = 0; k < on.size(); ++k) blocked[on[k]] = hidden[k];
    for (std::size_t i = 0; i < rays_.size(); ++i)
        if (!blocked[i]) sources_[rays_[i].source].arrived += rays_[i].kernel;
    from_.clear(), to_.clear(), rays_.clear();
}

const SampledLight::Estimate& SampledLight::operator()(const ElementTree& tree, ElementId e, const Spectrum& weight,
                                                       double allowed, unsigned value_rays) {
    EXI_CHECK(value_rays <= most_rays && rays_for_sight <= most_rays);
    const RegionId own = tree.region(e);
    const Point x = tree.patch(e).at(tree.centre(e));
    double radius = 0;
    for (const Point& corner : tree.outline(e)) radius = std::max(radius, norm(corner - x));
    find_sources(x, direct_.occluders().scene().regions()[own].plane.n, own, radius);
    // Visibility is estimated by independent rays: otherwise a source would be considered weak just because its light
    // was missed.
    RandomStream random(seed_, Stream::direct, e.value);
    RayDistributor for_sight(random.uniform()), for_value(random.uniform());
    for (std::uint32_t s = 0; s < sources_.size(); ++s)
        add_rays(tree, e, s, for_sight.next(rays_for_sight * sources_[s].share), Purpose::sight);
    trace_rays();
    for (Source& source : sources_)
        if (source.arrived > 0) source.in_sight = (1 / std::min(1.0, rays_for_sight * source.share)) * source.light;
    ranks_.clear();
    for (std::uint32_t s = 0; s < sources_.size(); ++s)
        ranks_.push_back({mean(sources_[s].in_sight), sources_[s].near * mean(sources_[s].light), s});
    std::sort(ranks_.begin(), ranks_.end());
    // Light that varies between 0 and U has a variance of at most U^2 / 4, typically half of that. Sources found by no
    // visibility ray may still contribute: the independent value rays find their light with the right probability.
    constexpr double typical_variance = 0.125;
    const auto power = [&](const Spectrum& light) { return squared(weight * light) / static_cast<double>(bands); };
    estimate_.weak = Spectrum();
    estimate_.misfit_squared = 0;
    estimate_.strong.clear();
    // Weak light is treated as constant over the element, and a source as fully visible or hidden. Its light may vary
    // by the share (radii / distance)^2; this variation may use half of the allowed misfit, whether or not a ray was
    // cast.
    constexpr double variation_weight = 4;
    Spectrum in_sight, astray;
    for (Source& source : sources_) source.arrived = 0;
    for (const Rank& rank : ranks_) {
        const std::uint32_t s = rank.source;
        const Spectrum in_sight_with = in_sight + sources_[s].in_sight;
        const Spectrum astray_with = astray + sources_[s].near * sources_[s].light;
        const double misfit = std::max(typical_variance * power(in_sight_with), variation_weight * power(astray_with));
        if (misfit > allowed) {
            estimate_.strong.push_back(sources_[s].name);
            continue;
        }
        in_sight = in_sight_with, astray = astray_with;
        estimate_.misfit_squared = misfit;
        add_rays(tree, e, s, for_value.next(value_rays * sources_[s].share), Purpose::value);
    }
    trace_rays();
    for (const Rank& rank : ranks_) {
        const Source& source = sources_[rank.source];
        if (source.arrived == 0) continue;
        const double expected = source.F * source.rays * std::min(1.0, value_rays * source.share);
        estimate_.weak += source.area * source.arrived / expected * source.light;
    }
    return estimate_;
}

}  // namespace exitance
