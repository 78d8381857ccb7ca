// The light of an element from emitters that contribute little there, by rays over the tree of emitters.
#include <algorithm>
#include <cmath>

#include "exitance/direct/ray_light.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t rays_for_sight = 16;  // per element

/// Radiance of a cluster towards a point, relative to diffuse emitters of the same power. Every emitter has at least a
/// minimum that allows for a beam's edge within the element.
double likely_radiance(const DirectLight& direct, const EmitterTree& tree, const EmitterTree::Node& node,
                       const Point& x) {
    // Derived from unbiased sampling, which requires some chance for every emitter.
    constexpr double least = 0.05;
    double sum = 0;
    for (std::uint32_t i = node.first; i < node.last; ++i) {
        const EmitterTree::Source& source = tree.sources()[i];
        const DirectLight::Emitter& emitter = direct.emitters()[source.name.emitter];
        sum += source.power * std::max(least, emitter.radiance.towards(x, emitter.centre));
    }
    return sum / node.power;
}

}  // namespace

/// Finds the clusters of emitters that may shine on an element about a point, and their unoccluded light there. Sources
/// in whose plane or behind it the point lies are left out although they may shine on other parts of the element. This
/// loses 2% of the light in the sample scene `carpet` if elements have edges of 1 m, and 0.2% if they have 0.5 m.
/// radius  distance of the element's farthest corner from the point, metres
void RayLight::find_terms(const SurfacePoint& at, double radius, Workspace& room) const {
    // Clusters whose light is wrong by this share have the wrong rank at most. Chosen: half of it takes 2.5 times as
    // many rays and twice it 2.9 times, measured by `exitance solve carpet.obj --error 0.1` (carpet u=12 v=13 cuts=1
    // books=0).
    constexpr double error_of_light = 0.1;
    tree_.cut(at, error_of_light, 0, room.cut_);
    const bool is_directed = direct_->scene().has_directed_emission();
    room.terms_.clear(), room.chance_before_.assign(1, 0);
    for (std::uint32_t t = 0; t < room.cut_.terms.size(); ++t) {
        const EmitterTree::Term& term = room.cut_.terms[t];
        const EmitterTree::Node& node = tree_.nodes()[term.node];
        const double light =
            (term.light + term.error) * (is_directed ? likely_radiance(*direct_, tree_, node, at.x) : 1);
        // The pieces of one emitter vary together.
        const double whole = direct_->emitters()[tree_.sources()[node.first].name.emitter].radius;
        const double both = radius + std::max(whole, node.radius);
        const double near = std::min(1.0, both * both / squared_norm(node.centre - at.x));
        room.terms_.push_back({0, near * light, t, light});
        room.chance_before_.push_back(room.chance_before_.back() + light);
    }
}

/// Finds out by rays which clusters shine on the element, and sorts them: the weakest comes first. The rays are
/// independent of those that estimate light: otherwise a source would be considered weak just because its light was
/// missed.
void RayLight::find_terms_in_sight(const Start& start, Workspace& room) const {
    room.parts_.assign(1, {.kind = Part::Kind::others, .open = Spectrum(), .by_term = true});
    add_rays(start, room.parts_[0], rays_for_sight, room);
    trace(room);
    for (Workspace::ElementTerm& term : room.terms_) {
        if (!(max(room.parts_[0].blocks[term.term].arrived) > 0)) continue;
        const double expected = rays_for_sight * term.light / room.chance_before_.back();
        term.in_sight = term.light / std::min(1.0, expected);
    }
    std::sort(room.terms_.begin(), room.terms_.end());
}

RayLight::ElementEstimate RayLight::on_element(const ElementTree& tree, ElementId e, const Spectrum& weight,
                                               double allowed, std::uint32_t rays, Workspace& room) const {
    ElementEstimate out;
    const RegionId own = tree.region(e);
    const Point x = tree.patch(e).at(tree.centre(e));
    const Start start{direct_->receiver(x, direct_->scene().regions()[own].plane.n, own), key_of(x, own), &tree, e};
    double radius = 0;
    for (const Point& corner : tree.outline(e)) radius = std::max(radius, norm(corner - x));
    find_terms(start.at, radius, room);
    const double all = room.chance_before_.back();
    if (!(all > 0)) return out;
    find_terms_in_sight(start, room);

    // Sources found by no visibility ray may still contribute: the independent rays below find their light with the
    // right probability. Weak light is treated as constant over the element, and a source as fully visible or hidden.
    // Its light may vary by the share (radii / distance)^2; this variation may use half of the allowed misfit, whether
    // or not a ray was cast.
    constexpr double variation_weight = 4;
    const auto power = [&](const Spectrum& light) { return squared(weight * light) / static_cast<double>(bands); };
    std::vector<double> chance(room.terms_.size(), 0);
    Spectrum in_sight, astray, weak;
    for (const Workspace::ElementTerm& term : room.terms_) {
        const EmitterTree::Node& node = tree_.nodes()[room.cut_.terms[term.term].node];
        const Spectrum in_sight_with = in_sight + term.in_sight * node.colour;
        const Spectrum astray_with = astray + term.astray * node.colour;
        const double misfit = std::max(typical_variance * power(in_sight_with), variation_weight * power(astray_with));
        if (misfit > allowed) {
            for (std::uint32_t i = node.first; i < node.last; ++i) out.strong.push_back(tree_.sources()[i].name);
            continue;
        }
        in_sight = in_sight_with, astray = astray_with;
        out.misfit_squared = misfit;
        weak += term.light * node.colour, chance[term.term] = term.light;
    }
    if (!(mean(weak) > 0)) return out;
    for (std::size_t t = 0; t < chance.size(); ++t) room.chance_before_[t + 1] = room.chance_before_[t] + chance[t];
    room.parts_.assign(1, {.kind = Part::Kind::others, .open = weak});
    Part& part = room.parts_[0];
    part.block = power_of_two(rays * mean(weak) / all, 4, rays) / 4;
    add_rays(start, part, 4 * part.block, room);
    trace(room);
    out.irradiance = part.light(), out.variance = part.variance(half_hidden * mean(weak) / part.rays);
    return out;
}

}  // namespace exitance
