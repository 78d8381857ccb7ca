#include "exitance/direct/distant_means.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/direct/ray_light.hpp"
#include "exitance/visibility/visible_source.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t first_rays_to_sky = 8, first_rays_to_sun = 16;
constexpr std::uint32_t max_rays = 1 << 10;  ///< Rays of a part: at a half-hidden source, an error of 0.3%.

}  // namespace

bool DistantMeans::suits(const DirectLight& direct) {
    const Scene& scene = direct.scene();
    const std::vector<DirectLight::Emitter>& emitters = direct.emitters();
    const auto is_far = [&](std::uint32_t e) {
        return emitters[e].sky == DirectLight::Emitter::Sky::open ||
               (direct.looks_far(e) && emitters[e].sky == DirectLight::Emitter::Sky::none);
    };
    if (emitters.empty() || !direct.beams().empty() || !scene.panes().empty()) return false;
    for (std::uint32_t e = 0; e < emitters.size(); ++e)
        if (!is_far(e)) return false;
    return true;
}

DistantMeans::DistantMeans(const DirectLight& direct, const RayTracer& tracer)
    : direct_(&direct),
      tracer_(&tracer),
      sky_(kept_domes(direct)),
      suns_(distant_discs(direct)),
      reach_(2 * direct.scene().size()) {}

Spectrum DistantMeans::Part::share() const {
    Spectrum all, arrived, out;
    for (const Sums& s : eighth) all += s.all, arrived += s.arrived;
    for (std::size_t b = 0; b < bands; ++b) out[b] = all[b] > 0 ? arrived[b] / all[b] : 0;
    return out;
}

/// Variance of the light, from the spread of eighths of the rays, each of which is stratified, and from the light of
/// features that no ray may have met.
double DistantMeans::Part::variance() const {
    constexpr double half = 0.5;  // share of the light of one ray that a feature between the rays may have
    const double L = mean(open), missed = half * L / rays;
    double all = 0, arrived = 0, squares = 0;
    for (const Sums& s : eighth) all += mean(s.all), arrived += mean(s.arrived);
    if (!(all > 0)) return half * half * L * L;
    for (const Sums& s : eighth) squares += std::pow(mean(s.arrived) - arrived / all * mean(s.all), 2);
    const double scale = L / all, groups = static_cast<double>(eighth.size());
    return groups / (groups - 1) * squares * scale * scale + missed * missed;
}

void DistantMeans::add_rays(const ElementTree& tree, Part& part, std::uint32_t number, Workspace& room) const {
    const std::uint32_t first = part.rays, count = part.wanted - part.rays;
    const RegionId region = tree.region(part.element);
    const Normal& n = direct_->scene().regions()[region].plane.n;
    const Patch patch = tree.patch(part.element);
    const ScrambledSobol points(hash(RayLight::key_of(patch.at(tree.centre(part.element)), region),
                                     part.sun ? part.sun->name.piece.value + 1ull : 0));
    for (int d = 0; d < 4; ++d) {
        std::vector<double>& x = room.coordinates_[static_cast<std::size_t>(d)];
        x.resize(count);
        points.fill(first, d, x);
    }
    if (first > 0)  // the rays so far become the first half of the eighths
        for (std::size_t q = 0; q < part.eighth.size(); ++q) {
            const Part::Sums none;
            const std::size_t a = 2 * q, b = 2 * q + 1;
            part.eighth[q] = b < part.eighth.size() ? Part::Sums{part.eighth[a].all + part.eighth[b].all,
                                                                 part.eighth[a].arrived + part.eighth[b].arrived}
                                                    : none;
        }
    for (std::uint32_t k = 0; k < count; ++k) {
        const double s = room.coordinates_[0][k], t = room.coordinates_[1][k];
        const std::uint32_t eighth = 8 * (first + k) / part.wanted;
        Vec3 way;
        Spectrum weight;
        if (part.sun) {
            const Point y = part.sun->seen.at(s, t), &middle = direct_->occluders().middle();
            const Vec3 d = y - middle;
            const RelativeRadiance& radiance = direct_->emitters()[part.sun->name.emitter].radiance;
            weight = Spectrum(part.sun->seen.weight(d, n) * radiance.towards(middle, y));
            way = normalized(d);
        } else {
            const SkyTree::Direction to = sky_.direction(room.aim_, s, t);
            way = to.w;
            const double cosine = dot(n, way);
            if (cosine > 0) weight = cosine / to.density * direct_->scene().distant().radiosity(way, false);
        }
        if (!(max(weight) > 0)) continue;
        part.eighth[eighth].all += weight;
        const Point x = patch.at(tree.uniform(part.element, room.coordinates_[2][k], room.coordinates_[3][k]));
        room.rays_.push_back({number, eighth, weight});
        room.from_.push_back({x, region}), room.to_.push_back({x + reach_ * way, RegionId()});
        room.ways_.push_back(way);
    }
    part.rays = part.wanted;
}

/// Traces the rays in the order of their directions, and adds those that arrive.
void DistantMeans::trace(Workspace& room) const {
    const std::span<const std::uint32_t> order = room.order_.sort(room.ways_);
    room.sorted_from_.clear(), room.sorted_to_.clear();
    for (const std::uint32_t i : order)
        room.sorted_from_.push_back(room.from_[i]), room.sorted_to_.push_back(room.to_[i]);
    static_assert(sizeof(bool) == sizeof(std::uint8_t));
    room.blocked_.resize(order.size());
    tracer_->occluded(room.sorted_from_, room.sorted_to_,
                      std::span(reinterpret_cast<bool*>(room.blocked_.data()), order.size()));
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (room.blocked_[k]) continue;
        const Workspace::Ray& ray = room.rays_[order[k]];
        room.parts_[ray.part].eighth[ray.eighth].arrived += ray.weight;
    }
    room.rays_.clear(), room.from_.clear(), room.to_.clear(), room.ways_.clear();
}

/// Makes the parts of all elements, with their first rays.
void DistantMeans::find_parts(const ElementTree& tree, std::span<const ElementId> elements, Workspace& room) const {
    room.parts_.clear();
    for (std::uint32_t i = 0; i < elements.size(); ++i) {
        const ElementId e = elements[i];
        const RegionId region = tree.region(e);
        const Normal& n = direct_->scene().regions()[region].plane.n;
        const auto add = [&](const DistantDisc* sun, const Spectrum& open, std::uint32_t rays) {
            if (!(max(open) > 0)) return;
            room.parts_.push_back({.element = e, .index = i, .sun = sun, .open = open, .wanted = rays});
            add_rays(tree, room.parts_.back(), static_cast<std::uint32_t>(room.parts_.size()) - 1, room);
        };
        if (!sky_.empty()) {
            sky_.aim(n, room.aim_);
            if (room.aim_.weight[0] > 0) add(nullptr, room.aim_.open, first_rays_to_sky);
        }
        const SurfacePoint at = direct_->receiver(tree.patch(e).at(tree.centre(e)), n, region);
        for (const DistantDisc& sun : suns_) {
            const DirectLight::Emitter& emitter = direct_->emitters()[sun.name.emitter];
            if (!direct_->shines_on(emitter, region)) continue;
            add(&sun,
                visible_form_factor(direct_->occluders(), at, sun.name.piece, {}, room.exact_, emitter.radiance) *
                    emitter.exitance,
                first_rays_to_sun);
        }
    }
}

void DistantMeans::find(const ElementTree& tree, std::span<const ElementId> elements,
                        std::span<const LightAccuracy> accuracy, Workspace& room, std::span<Mean> out) const {
    constexpr double rounding = 1e-9;  // of sums of weights; derived from double precision
    constexpr double min_seen = 0.1;   // share of the sky; derived from the share that one of the first rays has
    find_parts(tree, elements, room);
    std::vector<std::uint8_t> is_open(elements.size(), 1);  // 1 while an element may need more rays
    for (bool grows = true; grows;) {
        trace(room);
        grows = false;
        for (std::size_t first = 0, last = 0; first < room.parts_.size(); first = last) {
            const std::uint32_t i = room.parts_[first].index;
            while (last < room.parts_.size() && room.parts_[last].index == i) ++last;
            if (!is_open[i]) continue;
            is_open[i] = 0;
            Mean mean_of;
            double open = 0;
            bool is_divided = false;
            const auto parts = std::span(room.parts_).subspan(first, last - first);
            for (const Part& part : parts) {
                const Spectrum share = part.share();
                mean_of.irradiance += part.open * share, mean_of.variance += part.variance();
                open += mean(part.open);
                is_divided |= part.sun ? max(share) > rounding && max(share) < 1 - rounding : max(share) < min_seen;
            }
            out[i] = mean_of;
            if (is_divided) continue;
            const double least =
                std::max(mean(mean_of.irradiance) - std::sqrt(mean_of.variance), RayLight::min_share * open);
            const double allowed = accuracy[i].allowed(least);
            out[i].is_found = true;
            if (mean_of.variance <= allowed * allowed) continue;
            // The part with the largest variance for its rays gets more.
            Part& worst = *std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
                return a.variance() / a.rays < b.variance() / b.rays;
            });
            if (worst.rays >= max_rays) continue;
            worst.wanted = 2 * worst.rays;
            if (!worst.sun) sky_.aim(direct_->scene().regions()[tree.region(worst.element)].plane.n, room.aim_);
            add_rays(tree, worst, static_cast<std::uint32_t>(&worst - room.parts_.data()), room);
            is_open[i] = 1, grows = true;
        }
    }
    // Elements that no source can shine on are dark.
    std::vector<std::uint8_t> has_part(elements.size(), 0);
    for (const Part& part : room.parts_) has_part[part.index] = 1;
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (!has_part[i]) out[i] = {.irradiance = {}, .variance = 0, .is_found = true};
}

}  // namespace exitance
