#include "exitance/direct/mirrored_light.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/direct/source_point.hpp"

namespace exitance {
namespace {

/// True if a point in the plane of a convex pane is inside it.
bool is_inside(const Pane& pane, const Point& p) {
    bool left = false, right = false;
    for (std::size_t i = 0, m = pane.corners.size(); i < m; ++i) {
        const Point &a = pane.corners[i], &b = pane.corners[i + 1 == m ? 0 : i + 1];
        const double side = dot(pane.n, cross(b - a, p - a));
        left |= side > 0, right |= side < 0;
    }
    return !(left && right);
}

Vec3 mirrored(const Vec3& w, const Normal& n) {
    return w - 2 * dot(n, w) * n;
}

/// Chooses an entry of a list with these prefix sums by a number in [0, 1). Returns its index and probability.
std::pair<std::size_t, double> chosen(const std::vector<double>& sums, double u) {
    const auto at = std::upper_bound(sums.begin(), sums.end(), u * sums.back()) - sums.begin();
    const std::size_t i = std::min(static_cast<std::size_t>(at), sums.size() - 1);
    return {i, (sums[i] - (i > 0 ? sums[i - 1] : 0)) / sums.back()};
}

}  // namespace

bool panes_may_mirror_light(const Scene& scene) {
    // Cosine of a grazing angle at which every mirroring pane mirrors; derived from Fresnel's equations.
    constexpr double oblique = 0.1;
    constexpr double negligible = 1e-4;  // derived from the accuracy of the tables of RayFates
    const auto mirrors = [](const Pane& pane) { return max(pane.reflection(oblique)) > negligible; };
    return scene.has_light() && std::any_of(scene.panes().begin(), scene.panes().end(), mirrors);
}

MirroredLight::MirroredLight(const Scene& scene, const RayTracer& tracer)
    : scene_(scene), tracer_(tracer), glass_(scene) {
    if (!panes_may_mirror_light(scene)) return;
    for (const Pane& pane : scene.panes()) pane_area_.push_back(norm(area_vector(pane.corners)));
    double power = 0;
    for (const Piece& piece : cut_into_pieces(scene)) {
        if (!scene.material(piece.region).emits()) continue;
        emitters_.push_back(piece);
        power_up_to_.push_back(power += piece.patch.area() * mean(scene.material(piece.region).exitance));
    }
}

/// Chances of the panes at a place, by their approximate solid angle, and the panes as seen from there.
class MirroredLight::Panes {
  public:
    Panes(const std::vector<Pane>& panes, const std::vector<double>& area, const SurfacePoint& place)
        : panes_(panes), area_(area), x_(place.x) {
        double total = 0;
        for (std::size_t i = 0; i < panes.size(); ++i) {
            const Vec3 way = centroid(panes[i].corners) - place.x;
            const bool is_above = std::any_of(panes[i].corners.begin(), panes[i].corners.end(),
                                              [&](const Point& p) { return dot(place.n, p - place.x) > 0; });
            up_to_.push_back(total += is_above ? area[i] / (squared_norm(way) + area[i]) : 0);
        }
    }
    bool empty() const { return up_to_.empty() || !(up_to_.back() > 0); }
    std::pair<std::size_t, double> choose(double u) const { return chosen(up_to_, u); }
    const SeenPolygon& seen(std::size_t pane) {
        const auto found = seen_.find(pane);
        if (found != seen_.end()) return found->second;
        const Pane& p = panes_[pane];
        const Normal n = dot(p.n, x_ - p.corners[0]) > 0 ? p.n : -p.n;
        return seen_.emplace(pane, SeenPolygon(p.corners, n, area_[pane], x_)).first->second;
    }

  private:
    const std::vector<Pane>& panes_;
    const std::vector<double>& area_;
    Point x_;
    std::vector<double> up_to_;
    std::map<std::size_t, SeenPolygon> seen_;
};

/// Sums over the four quarters of the samples, which are independent.
struct MirroredLight::Sums {
    std::array<Spectrum, 4> quarter;
    double open = 0;  ///< Sum over all samples of Sample::open.

    void add(std::size_t number, const Sample& sample) { quarter[number] += sample.light, open += sample.open; }

    /// Makes room for as many further samples: the existing ones become the first two quarters.
    void halve() { quarter = {quarter[0] + quarter[1], quarter[2] + quarter[3], Spectrum(), Spectrum()}; }
    Spectrum total() const { return quarter[0] + quarter[1] + quarter[2] + quarter[3]; }
    double variance(double samples) const {
        const double middle = mean(total()) / 4;
        double squares = 0;
        for (const Spectrum& q : quarter) squares += std::pow(mean(q) - middle, 2);
        // If no sample found light, all may have missed it: half of the light of one open sample, as for rays
        // (RayLight).
        const double missed = middle > 0 ? 0 : 0.5 * open / samples;
        return (4.0 / 3 * squares + missed * missed) / (samples * samples);
    }
};

MirroredLight::Estimate MirroredLight::at(const SurfacePoint& place, double E, const LightAccuracy& accuracy,
                                          std::uint64_t key) const {
    if (pane_area_.empty()) return {};
    constexpr std::size_t max_images = 64;
    const Estimate images = this->images(place, max_images, hash(key, 1u));
    Panes panes(scene_.panes(), pane_area_, place);
    if (panes.empty()) return images;
    const ScrambledSobol for_sky(hash(key, 2u)), for_emitters(hash(key, 3u));
    constexpr std::uint32_t first_samples = 32;
    const bool has_sky = !scene_.distant().domes.empty();
    Sums sky, emitters;
    for (std::uint32_t first = 0, last = first_samples;; first = last, last *= 2) {
        if (first > 0) sky.halve(), emitters.halve();
        for (std::uint32_t i = first; i < last; ++i) {
            const std::size_t q = 4ull * i / last;
            if (has_sky) sky.add(q, by_sky(place, panes, for_sky(i, 0), for_sky(i, 1), for_sky(i, 2)));
            if (!emitters_.empty())
                emitters.add(
                    q, by_emitters(place, panes,
                                   {for_emitters(i, 0), for_emitters(i, 1), for_emitters(i, 2), for_emitters(i, 3)}));
        }
        const double samples = last;
        Estimate out = images;
        out.rays = last;
        out.irradiance += (sky.total() + emitters.total()) / samples;
        out.parallel += sky.total() / samples;
        out.variance = sky.variance(samples) + emitters.variance(samples);
        if ((!has_sky && emitters_.empty()) || 2 * last > accuracy.max_rays ||
            out.variance <= std::pow(accuracy.allowed(E + mean(out.irradiance)), 2))
            return out;
    }
}

/// One sample of E_m from skies: a point of a pane.
MirroredLight::Sample MirroredLight::by_sky(const SurfacePoint& place, Panes& panes, double s, double t,
                                            double choice) const {
    const auto [number, chance] = panes.choose(choice);
    if (!(chance > 0)) return {};
    const Pane& pane = scene_.panes()[number];
    const SeenPolygon& seen = panes.seen(number);
    const Point mirror = seen.at(s, t);
    const Vec3 d = mirror - place.x;
    const double weight = seen.weight(d, place.n);
    if (!(weight > 0)) return {};
    const double length = norm(d);
    const Vec3 onwards = mirrored(d, pane.n) / length;
    const Spectrum light = scene_.distant().radiosity(onwards, false);
    if (!(max(light) > 0)) return {};
    const Spectrum open =
        (weight * seen.measure() / (pi * chance)) * pane.reflection(std::abs(dot(pane.n, d)) / length) * light;
    return {passing(place, mirror, onwards, {mirror + 2 * scene_.size() * onwards, RegionId()}) * open, mean(open)};
}

/// Factors on the bands of a ray from a place to a point of a pane that mirrors it, and along `onwards` (of length 1)
/// to the end: 0 if it is blocked before or after the pane, else the colours of the panes that it passes. Unbiased over
/// many rays.
Spectrum MirroredLight::passing(const SurfacePoint& from, const Point& mirror, const Vec3& onwards,
                                const RayEnd& end) const {
    // Rays start and end away from the pane, by more than rounding to single precision, so that it does not block them.
    const double off = 0x1p-18 * scene_.size();
    const Vec3 there = mirror - from.x;
    const Point before = mirror - (off / norm(there)) * there;
    const std::array<RayEnd, 2> begins{{{from.x, from.region}, {mirror + off * onwards, RegionId()}}},
        ends{{{before, RegionId()}, end}};
    std::array<bool, 2> blocked{};
    tracer_.occluded(begins, ends, blocked);
    if (blocked[0] || blocked[1]) return {};
    return glass_.between(from.x, before) * glass_.between(begins[1].x, end.x);
}

/// Irradiance per area of an emitter around one of its points, by the mirror image of that point in one pane, W/m^4.
MirroredLight::Sample MirroredLight::by_emitter(const SurfacePoint& place, const Piece& piece, const Point& on,
                                                const Pane& pane) const {
    const double height = dot(pane.n, place.x - pane.corners[0]), other = dot(pane.n, on - pane.corners[0]);
    if ((height > 0) != (other > 0)) return {};
    const Vec3 towards = on - 2 * other * pane.n - place.x;  // vector to the mirror image
    const double length = norm(towards), rise = dot(pane.n, towards), cosine = dot(place.n, towards) / length;
    const double t = -height / rise;  // at the intersection of the pane's plane and the ray to the image
    if (!(cosine > 0) || !(t > 0) || !(t < 1)) return {};
    const Vec3 onwards = mirrored(towards, pane.n) / length;
    const double leaving = -dot(scene_.regions()[piece.region].plane.n, onwards);
    const Point mirror = place.x + t * towards;
    if (!(leaving > 0)) return {};
    const Spectrum open =
        (scene_.relative_radiance(piece.region)(-onwards) * cosine * leaving / (pi * length * length)) *
        pane.reflection(std::abs(rise) / length) * scene_.material(piece.region).exitance;
    if (!is_inside(pane, mirror)) return {{}, mean(open)};
    return {passing(place, mirror, onwards, {on, piece.region}) * open, mean(open)};
}

/// One sample of E_m from emitters: a point chosen in proportion to power, and a pane.
MirroredLight::Sample MirroredLight::by_emitters(const SurfacePoint& place, const Panes& panes,
                                                 const std::array<double, 4>& random) const {
    const auto [e, chance] = chosen(power_up_to_, random[2]);
    const auto [p, pane_chance] = panes.choose(random[3]);
    if (!(pane_chance > 0)) return {};
    const Patch& patch = emitters_[e].patch;
    const Point on = patch.at(uniform_in_shape(patch.shape, random[0], random[1]));
    const Sample found = by_emitter(place, emitters_[e], on, scene_.panes()[p]);
    const double weight = patch.area() / (chance * pane_chance);
    return {weight * found.light, weight * found.open};
}

/// E_m from a disc of the sky (the first indices) or a light without extent (further indices), by one pane.
Spectrum MirroredLight::by_image(const SurfacePoint& place, std::size_t light, const Pane& pane) const {
    const auto& discs = scene_.distant().discs;
    const bool is_disc = light < discs.size();
    const PunctualLight* lamp = is_disc ? nullptr : &scene_.lights()[light - discs.size()];
    const bool is_parallel = is_disc || lamp->is_directional();
    const double height = dot(pane.n, place.x - pane.corners[0]);
    Vec3 towards;  // vector to the mirror image
    if (is_parallel) {
        towards = mirrored(is_disc ? discs[light].towards : -lamp->direction, pane.n);
    } else {
        const double other = dot(pane.n, lamp->position - pane.corners[0]);
        if ((height > 0) != (other > 0)) return {};
        towards = lamp->position - 2 * other * pane.n - place.x;
    }
    const double length = norm(towards), rise = dot(pane.n, towards), cosine = dot(place.n, towards) / length;
    const double t = -height / rise;  // at the intersection of the pane's plane and the ray to the image
    if (!(cosine > 0) || !(t > 0) || !std::isfinite(t)) return {};
    const Point mirror = place.x + t * towards;
    if (!is_inside(pane, mirror)) return {};
    const Vec3 onwards = mirrored(towards, pane.n) / length;
    const Point end = is_parallel ? mirror + 2 * scene_.size() * onwards : lamp->position;
    const Spectrum through = passing(place, mirror, onwards, {end, RegionId()});
    const Spectrum mirrored_share = through * pane.reflection(std::abs(rise) / length);
    if (is_disc) return cosine * mirrored_share * discs[light].irradiance;
    if (is_parallel) return cosine * mirrored_share * lamp->intensity;
    return (cosine * lamp->share_towards(-onwards) / (length * length)) * mirrored_share * lamp->intensity;
}

/// E_m from the sun and from lights without extent.
MirroredLight::Estimate MirroredLight::images(const SurfacePoint& place, std::size_t most, std::uint64_t key) const {
    Estimate out;
    const std::size_t discs = scene_.distant().discs.size(), lights = discs + scene_.lights().size();
    const std::size_t all = lights * scene_.panes().size(), count = std::min(all, most);
    RandomStream random(key, Stream::direct);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t pair =
            all == count ? i : std::min(all - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(all)));
        const std::size_t light = pair % lights;
        const Spectrum found = (static_cast<double>(all) / static_cast<double>(count)) *
                               by_image(place, light, scene_.panes()[pair / lights]);
        out.irradiance += found;
        if (light < discs || scene_.lights()[light - discs].is_directional()) out.parallel += found;
    }
    return out;
}

}  // namespace exitance
