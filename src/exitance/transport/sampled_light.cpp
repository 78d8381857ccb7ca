#include "exitance/transport/sampled_light.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include "exitance/core/random.hpp"
#include "exitance/transport/form_factor.hpp"

namespace exitance {
namespace {

constexpr unsigned rays_an_element = 16;

/// A place of a convex polygon with uniform density, from two numbers in [0, 1).
Point uniform_on(std::span<const Point> corners, double s, double t) {
    double whole = 0;
    for (std::size_t i = 2; i < corners.size(); ++i)
        whole += norm(cross(corners[i - 1] - corners[0], corners[i] - corners[0]));
    double rest = s * whole;
    for (std::size_t i = 2;; ++i) {
        const Vec3 a = corners[i - 1] - corners[0], b = corners[i] - corners[0];
        const double area = norm(cross(a, b));
        if (rest < area || i + 1 == corners.size()) {
            const Vec2 uv = uniform_in_shape(Patch::Shape::triangle, std::min(rest / area, 1.0), t);
            return corners[0] + uv.x * a + uv.y * b;
        }
        rest -= area;
    }
}

constexpr std::size_t quad = 4;  ///< Corners; a triangle repeats its last one.

}  // namespace

SampledLight::SampledLight(const DirectLight& direct, const RayTracer& tracer, std::uint64_t seed)
    : direct_(direct), tracer_(tracer), seed_(seed) {
    for (const DirectLight::Emitter& emitter : direct_.emitters())
        for (PieceId piece : emitter.pieces) {
            const std::span<const Point> corners = direct_.occluders().corners(piece);
            quads_.add({corners[0], corners[1], corners[2], corners[std::min(corners.size(), quad) - 1]});
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
        if (emitter.region == own || emitter.plane.signed_distance(x) <= 0 ||
            dot(n, emitter.centre - x) <= -emitter.radius)
            continue;
        for (std::size_t k = 0; k < emitter.pieces.size(); ++k) {
            const PieceId piece = emitter.pieces[k];
            const std::span<const Point> corners = direct_.occluders().corners(piece);
            const double F = corners.size() <= quad ? F_[first + k] : point_to_polygon(x, n, corners);
            if (F <= 0) continue;
            const double both = radius + emitter.radius;
            const double near = std::min(1.0, both * both / squared_norm(emitter.centre - x));
            sources_.push_back({{i, piece}, emitter.region, F * emitter.exitance, 0, near, {}});
            all += mean(sources_.back().light);
        }
    }
    for (Source& source : sources_) source.expected = rays_an_element * mean(source.light) / all;
}

double SampledLight::visible_part(const ElementTree& tree, ElementId e, std::size_t s, std::uint64_t purpose) {
    const Source& source = sources_[s];
    const std::uint64_t name = hash(e.value, source.name.piece.value, purpose);
    RandomStream random(seed_, Stream::direct, name);
    const unsigned rays = static_cast<unsigned>(source.expected + random.uniform());
    if (rays == 0) return 0;
    const ScrambledSobol points(random.bits());
    const Normal& n = direct_.occluders().scene().regions()[tree.region(e)].plane.n;
    const Plane& plane = direct_.emitters()[source.name.emitter].plane;
    from_.clear(), to_.clear();
    for (std::uint32_t i = 0; i < rays; ++i) {
        const Point x = tree.patch(e).at(tree.uniform(e, points(i, 0), points(i, 1)));
        const Point y = uniform_on(direct_.occluders().corners(source.name.piece), points(i, 2), points(i, 3));
        if (dot(n, y - x) <= 0 || plane.signed_distance(x) <= 0) continue;
        from_.push_back(x), to_.push_back(y);
    }
    if (from_.empty()) return 0;
    std::array<bool, rays_an_element + 1> blocked;
    tracer_.occluded(from_, to_, tree.region(e), source.region, std::span(blocked).first(from_.size()));
    const auto open = std::count(blocked.begin(), blocked.begin() + static_cast<long>(from_.size()), false);
    return static_cast<double>(open) / (static_cast<double>(from_.size()) * std::min(1.0, source.expected));
}

const SampledLight::Estimate& SampledLight::operator()(const ElementTree& tree, ElementId e, const Spectrum& weight,
                                                       double allowed) {
    const RegionId own = tree.region(e);
    const Point x = tree.patch(e).at(tree.centre(e));
    double radius = 0;
    for (const Point& corner : tree.outline(e)) radius = std::max(radius, norm(corner - x));
    find_sources(x, direct_.occluders().scene().regions()[own].plane.n, own, radius);
    // What is in sight is found by rays of its own: a source must not be thought weak because its light was missed.
    enum : std::uint64_t { sight, value };
    for (std::size_t s = 0; s < sources_.size(); ++s)
        if (visible_part(tree, e, s, sight) > 0)
            sources_[s].in_sight = (1 / std::min(1.0, sources_[s].expected)) * sources_[s].light;
    ranks_.clear();
    for (std::uint32_t s = 0; s < sources_.size(); ++s)
        ranks_.push_back({mean(sources_[s].in_sight), sources_[s].near * mean(sources_[s].light), s});
    std::sort(ranks_.begin(), ranks_.end());
    // Light that comes and goes between nothing and U misses in the mean square U^2 / 4 at most; as a rule half of
    // that. Sources that no ray has found may still send theirs: then chance has it that rays of the second kind find
    // it.
    constexpr double misses = 0.125;
    const auto power = [&](const Spectrum& light) { return squared(weight * light) / static_cast<double>(bands); };
    estimate_.weak = Spectrum();
    estimate_.misfit_squared = 0;
    estimate_.strong.clear();
    // The middle stands for the element, and all of a source for the part that is in sight, which errs by (radii /
    // distance)^2 at most and always to the same side: by half of what is allowed at most, whether a ray was drawn or
    // not.
    constexpr double askew = 4;
    Spectrum in_sight, astray;
    for (const std::uint32_t s : ranks_ | std::views::transform(&Rank::source)) {
        const Spectrum in_sight_with = in_sight + sources_[s].in_sight;
        const Spectrum astray_with = astray + sources_[s].near * sources_[s].light;
        const double misfit = std::max(misses * power(in_sight_with), askew * power(astray_with));
        if (misfit > allowed) {
            estimate_.strong.push_back(sources_[s].name);
            continue;
        }
        in_sight = in_sight_with, astray = astray_with;
        estimate_.misfit_squared = misfit;
        estimate_.weak += visible_part(tree, e, s, value) * sources_[s].light;
    }
    return estimate_;
}

}  // namespace exitance
