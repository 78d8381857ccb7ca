#include "exitance/evaluate/mirrored_light.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/scene/locator.hpp"

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

}  // namespace

bool panes_may_mirror_light(const Scene& scene) {
    // Cosine of a grazing angle, derived from Fresnel's equations: every mirroring pane mirrors there.
    constexpr double oblique = 0.1;
    constexpr double negligible = 1e-4;  // derived from the accuracy of the tables of RayFates
    const auto mirrors = [](const Pane& pane) { return max(pane.reflection(oblique)) > negligible; };
    return scene.has_light() && std::any_of(scene.panes().begin(), scene.panes().end(), mirrors);
}

MirroredLight::MirroredLight(const Scene& scene, const RayTracer& tracer) : scene_(scene), tracer_(tracer) {
    if (!panes_may_mirror_light(scene)) return;
    double power = 0;
    for (const Piece& piece : cut_into_pieces(scene)) {
        if (!scene.material(piece.region).emits()) continue;
        emitters_.push_back(piece);
        power_up_to_.push_back(power += piece.patch.area() * mean(scene.material(piece.region).exitance));
    }
}

std::array<double, 2> MirroredLight::at(const Receiver& place, std::uint32_t rays, std::uint64_t key) const {
    const double images = by_images(place, key);
    std::array<double, 2> out{};
    for (std::uint64_t i = 0; i < 2; ++i)
        out[i] = images + by_rays(place, rays, hash(key, i, 0u)) + by_emitters(place, hash(key, i, 1u));
    return out;
}

/// Estimates the mirrored light E_m of the skies by rays, W/m^2.
double MirroredLight::by_rays(const Receiver& place, std::uint32_t rays, std::uint64_t key) const {
    if (scene_.distant().domes.empty()) return 0;
    const ScrambledSobol points(key);
    const Frame frame(place.n);
    std::vector<Vec3> directions(rays);
    for (std::uint32_t i = 0; i < rays; ++i) directions[i] = cosine_direction(frame, points(i, 0), points(i, 1));
    std::vector<RayHit> hits(rays);
    tracer_.nearest(directions, place.x, place.own, hits, Mirrored::followed);
    double sum = 0;
    for (std::uint32_t i = 0; i < rays; ++i)
        if (hits[i].mirror >= 0 && hits[i].surface.is_none())
            sum += mean(scene_.distant().radiosity(normalized(arriving(scene_, hits[i], directions[i])), false));
    return sum / rays;
}

/// True if neither the way from a place to a point of a pane nor the further way along `onwards` (of length 1) to the
/// end is blocked.
bool MirroredLight::is_open(const Receiver& from, const Point& mirror, const Vec3& onwards,
                            const SurfacePoint& end) const {
    // Rays start and end away from the pane, by more than rounding to single precision, so that it does not block them.
    const double off = 0x1p-18 * scene_.size();
    const Vec3 there = mirror - from.x;
    const Point before = mirror - (off / norm(there)) * there;
    const std::array<SurfacePoint, 2> begins{{{from.x, from.own}, {mirror + off * onwards, RegionId()}}},
        ends{{{before, RegionId()}, end}};
    std::array<bool, 2> blocked{};
    tracer_.occluded(begins, ends, blocked);
    return !blocked[0] && !blocked[1];
}

/// Irradiance per area of an emitter around one of its points, by the mirror image of that point in one pane, W/m^4.
double MirroredLight::by_emitter(const Receiver& place, const Piece& piece, const Point& on, const Pane& pane) const {
    const double height = dot(pane.n, place.x - pane.corners[0]), other = dot(pane.n, on - pane.corners[0]);
    if ((height > 0) != (other > 0)) return 0;
    const Vec3 towards = on - 2 * other * pane.n - place.x;  // vector to the mirror image
    const double length = norm(towards), rise = dot(pane.n, towards), cosine = dot(place.n, towards) / length;
    const double t = -height / rise;  // at the intersection of the pane's plane and the ray to the image
    if (!(cosine > 0) || !(t > 0) || !(t < 1)) return 0;
    const Vec3 onwards = mirrored(towards, pane.n) / length;
    const double leaving = -dot(scene_.regions()[piece.region].plane.n, onwards);
    const Point mirror = place.x + t * towards;
    if (!(leaving > 0) || !is_inside(pane, mirror) || !is_open(place, mirror, onwards, {on, piece.region})) return 0;
    return mean(pane.reflection(std::abs(rise) / length) * scene_.material(piece.region).exitance) *
           scene_.relative_radiance(piece.region)(-onwards) * cosine * leaving / (pi * length * length);
}

/// E_m from emitters, by points chosen in proportion to power, and panes chosen by their approximate solid angle.
double MirroredLight::by_emitters(const Receiver& place, std::uint64_t key) const {
    if (emitters_.empty()) return 0;
    constexpr int samples = 4;
    std::vector<double> up_to;
    double total = 0;
    for (const Pane& pane : scene_.panes()) {
        const double area = norm(area_vector(pane.corners));
        const Vec3 way = centroid(pane.corners) - place.x;
        up_to.push_back(total += area / (squared_norm(way) + area));
    }
    const auto chosen = [](const std::vector<double>& sums, double u) {
        const auto at = std::upper_bound(sums.begin(), sums.end(), u * sums.back()) - sums.begin();
        const std::size_t i = std::min(static_cast<std::size_t>(at), sums.size() - 1);
        return std::pair(i, (sums[i] - (i > 0 ? sums[i - 1] : 0)) / sums.back());
    };
    RandomStream random(key, Stream::certificate);
    double sum = 0;
    for (int k = 0; k < samples; ++k) {
        const auto [e, chance] = chosen(power_up_to_, random.uniform());
        const auto [p, pane_chance] = chosen(up_to, random.uniform());
        const Patch& patch = emitters_[e].patch;
        const double u = random.uniform(), v = random.uniform();
        const Point on = patch.at(uniform_in_shape(patch.shape, u, v));
        sum += by_emitter(place, emitters_[e], on, scene_.panes()[p]) * patch.area() / (chance * pane_chance);
    }
    return sum / samples;
}

/// E_m from a disc of the sky (the first indices) or a light without extent (further indices), by one pane.
Spectrum MirroredLight::by_image(const Receiver& place, std::size_t light, const Pane& pane) const {
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
    if (!is_open(place, mirror, onwards, {end, RegionId()})) return {};
    const Spectrum mirrored_share = pane.reflection(std::abs(rise) / length);
    if (is_disc) return cosine * mirrored_share * discs[light].irradiance;
    if (is_parallel) return cosine * mirrored_share * lamp->intensity;
    return (cosine * lamp->share_towards(-onwards) / (length * length)) * mirrored_share * lamp->intensity;
}

/// E_m from the sun and from lights without extent.
double MirroredLight::by_images(const Receiver& place, std::uint64_t key) const {
    const std::size_t lights = scene_.distant().discs.size() + scene_.lights().size();
    const std::size_t all = lights * scene_.panes().size(), count = std::min(all, max_images);
    RandomStream random(key, Stream::certificate);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t pair =
            all == count ? i : std::min(all - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(all)));
        sum += mean(by_image(place, pair % lights, scene_.panes()[pair / lights]));
    }
    return count > 0 ? sum * static_cast<double>(all) / static_cast<double>(count) : 0;
}

namespace {

/// A point on a solution's surfaces.
struct Place {
    std::size_t room = 0;
    double arriving = 0;                 ///< E, mean over bands, W/m^2.
    std::array<double, 2> by_mirrors{};  ///< Two independent estimates of the mirrored light E_m, W/m^2.
};

/// Places that are uniform in area within each room, equally many in every room.
std::vector<Place> measured_places(const Solution& solution, const Stage& stage, const MirroredLight& light,
                                   std::uint64_t seed) {
    constexpr std::size_t count =
        4096;  // light varies more between places than between rays, so many places get few rays
    constexpr std::uint32_t rays = 32;  // number of rays per estimate
    const ElementTree& tree = solution.interpolant.tree;
    const std::vector<ElementId> leaves = tree.leaves();
    std::vector<double> up_to;
    double area = 0;
    for (const ElementId e : leaves) up_to.push_back(area += stage.counted_area(tree, e));
    std::vector<Place> out(area > 0 ? count : 0);
    parallel_for(out.size(), 16, [&](std::size_t i) {
        RandomStream random(seed, Stream::certificate, i, 0x6d6972726f72);  // key of this purpose: "mirror"
        const double at = area * (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
        const auto k = static_cast<std::size_t>(std::upper_bound(up_to.begin(), up_to.end(), at) - up_to.begin());
        const ElementId e = leaves[std::min(k, leaves.size() - 1)];
        const double s = random.uniform(), t = random.uniform();
        const Vec2 uv = tree.uniform(e, s, t);
        const RegionId region = tree.region(e);
        out[i].arriving = mean(solution.interpolant.at({e, uv}));
        out[i].room = stage.rooms.count() > 0 ? stage.rooms.of(tree, e) : 0;
        out[i].by_mirrors =
            light.at({tree.patch(e).at(uv), stage.scene.regions()[region].plane.n, region}, rays, random.bits());
    });
    return out;
}

/// Share in one room. The product of two independent estimates has no bias due to noise, unlike the square of one.
MirroredShare share_of(std::span<const Place> places, std::size_t room) {
    constexpr double least_light = 0.1;       // derived from the error norm of parts: share of the room's mean
    constexpr std::size_t fewest_places = 8;  // number of places from which a standard error can be computed
    double arriving = 0, n = 0;
    for (const Place& place : places)
        if (place.room == room) arriving += place.arriving, ++n;
    if (n < fewest_places) return {};
    const double mean_light = arriving / n;
    double sum = 0, squares = 0;
    for (const Place& place : places) {
        if (place.room != room) continue;
        const auto& [a, b] = place.by_mirrors;
        if (a == 0 && b == 0) continue;
        const double light = std::max(place.arriving, least_light * mean_light);
        const double square = light > 0 ? a * b / (light * light) : 1;  // without other light, all light is mirrored
        sum += square, squares += square * square;
    }
    const double mean_square = sum / n;
    const double error = std::sqrt(std::max(0.0, squares / n - mean_square * mean_square) / (n - 1));
    return {std::sqrt(std::max(0.0, mean_square)), std::sqrt(std::max(0.0, mean_square - 2 * error))};
}

}  // namespace

MirroredShare mirrored_share(const Solution& solution, const Stage& stage, std::uint64_t seed) {
    if (!panes_may_mirror_light(stage.scene)) return {};
    const MirroredLight light(stage.scene, stage.tracer);
    const std::vector<Place> places = measured_places(solution, stage, light, seed);
    MirroredShare out;
    for (std::size_t room = 0; room < std::max<std::size_t>(1, stage.rooms.count()); ++room) {
        const MirroredShare own = share_of(places, room);
        if (own.certainly > out.certainly || (own.certainly == out.certainly && own.share > out.share)) out = own;
    }
    return out;
}

MirroredAtPoints mirrored_at_points(const Scene& scene, std::span<const ProbePoint> points,
                                    std::span<const Spectrum> light, double limit, std::uint64_t seed) {
    MirroredAtPoints out;
    if (points.empty() || !panes_may_mirror_light(scene)) return out;
    constexpr std::size_t max_points = 64;
    constexpr std::uint32_t rays = 512;
    const RayTracer tracer(scene);
    const MirroredLight mirrored(scene, tracer);
    const Locator locator(scene);
    const std::size_t step = (points.size() + max_points - 1) / max_points;
    out.points = (points.size() + step - 1) / step;
    std::vector<double> shares(out.points);
    parallel_for(out.points, 1, [&](std::size_t k) {
        const std::size_t i = k * step;
        const Normal n = normalized(points[i].n);
        const SurfaceId surface = locator.find(points[i].x, n);
        const RegionId own = surface.is_none() ? RegionId() : scene.surfaces()[surface].region;
        const auto [a, b] = mirrored.at({points[i].x, n, own}, rays, hash(seed, i));
        const double all = mean(light[i]) + 0.5 * (a + b);
        if (std::min(a, b) > limit * all) shares[k] = 0.5 * (a + b) / all;
    });
    for (const double share : shares) out.above += share > 0, out.largest = std::max(out.largest, share);
    return out;
}

}  // namespace exitance
