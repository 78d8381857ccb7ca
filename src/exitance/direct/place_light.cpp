#include "exitance/direct/place_light.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/direct/mirrored_light.hpp"

namespace exitance {
namespace {

// Work in units of VisibilityWorkspace::work, about that of a ray, measured by `bench/exitance-bench`.
constexpr double work_of_shaft = 10;   ///< Work of a search for the blockers between a polygon and a source.
constexpr double work_of_blocker = 6;  ///< Work per blocker that is clipped from a source, if there are many fragments.
/// Exact light is tried again if rays need more than this many times the work that it was allowed. The work allowed for
/// exact light is then the work of the rays, divided by this number. Derived from the cost of trying in vain: at most a
/// quarter of the rays.
constexpr double worth_another = 4;

/// Limit on the rays of a place of a polygon below a sky from a picture. Derived from RayLight::error_of(), 0.3% of the
/// light of a half-hidden sky: elements average over many places.
constexpr unsigned max_rays_to_picture = 1024;

}  // namespace

PlaceLight::PlaceLight(const DirectLight& direct, const RayTracer& tracer) : direct_(&direct), rays_(direct, tracer) {
    for (const DirectLight::Emitter& emitter : direct.emitters()) {
        const bool is_directed = emitter.radiance.is_directed();
        const double pieces = static_cast<double>(emitter.pieces.size());
        preparing_ += (work_of_shaft + (is_directed ? VisibilityWorkspace::work_of_integral : 0)) * pieces;
        // This bound holds even if every piece blocks every source. Integrals over fragments have no such bound.
        max_work_ += is_directed ? HUGE_VAL : pieces * static_cast<double>(direct.occluders().pieces().size());
    }
    if (panes_may_mirror_light(direct.scene()))
        mirrored_ = std::make_unique<const MirroredLight>(direct.scene(), tracer);
}

PlaceLight::~PlaceLight() = default;

/// Adds light that panes mirror, from both sides of a diffusing pane.
void PlaceLight::add_mirrored(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                              Estimate& out) const {
    if (!mirrored_) return;
    // If no error is allowed. Derived from the accuracy of closed forms through panes (glazed_form_factor).
    constexpr LightAccuracy finest{.relative = 1e-3};
    const LightAccuracy& required = accuracy.relative > 0 || accuracy.absolute > 0 ? accuracy : finest;
    const RegionId behind = direct_->occluders().scene().behind(own);
    const double through = behind.is_none() ? 0 : direct_->occluders().scene().material(own).through;
    const double E = mean(out.irradiance);
    const auto add = [&](double share, const Normal& normal, RegionId side) {
        const MirroredLight::Estimate found =
            mirrored_->at(direct_->receiver(x, normal, side), E, required, RayLight::key_of(x, side));
        out.irradiance += share * found.irradiance, out.parallel += share * found.parallel;
        out.variance += share * share * found.variance, out.rays += found.rays;
    };
    add(1 - through, n, own);
    if (!behind.is_none()) add(through, -n, behind);
}

Spectrum PlaceLight::mirrored_images(const SurfacePoint& at, std::size_t most, std::uint64_t key) const {
    return mirrored_ ? mirrored_->images(at, most, key).irradiance : Spectrum();
}

PlaceLight::Estimate PlaceLight::by_rays(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                                         Workspace& room, const RayLight::Spreads* known) const {
    Estimate out = rays_.at(x, n, own, accuracy, room, known);
    add_mirrored(x, n, own, accuracy, out);
    return out;
}

PlaceLight::Estimate PlaceLight::at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                                    Workspace& room) const {
    std::optional<Spectrum> exact;
    double tried = 0;
    if (accuracy.relative > 0 || accuracy.absolute > 0) {
        const double of_one = RayLight::rays_for(std::max(accuracy.relative, RayLight::error_of(accuracy.max_rays)));
        const double work =
            max_work_ <= of_one || !(accuracy.absolute > 0) ? of_one : rays_.forecast(x, n, own, accuracy, room);
        exact = exact_within(x, n, own, work, room), tried = work_of(room, work);
        if (!exact) {
            // In penumbrae more rays are needed than were forecast. The first rays show how many.
            const double needed = rays_needed_at(x, n, own, work, accuracy, room, tried);
            if (needed > worth_another * work) {
                exact = exact_within(x, n, own, needed / worth_another, room);
                tried += work_of(room, needed / worth_another);
            }
        }
        if (!exact) {
            Estimate out = by_rays(x, n, own, accuracy, room);
            out.work = tried;
            return out;
        }
    } else {
        exact = direct_->irradiance(x, n, own, room.exact);
    }
    Estimate out{.irradiance = *exact, .work = tried};
    add_mirrored(x, n, own, accuracy, out);
    return out;
}

/// Returns the work that the last call of exact_within() took, in rays, at most `limit`.
double PlaceLight::work_of(const Workspace& room, double limit) const {
    return std::min(limit, max_work_ <= limit ? max_work_ : room.exact.work);
}

std::optional<Spectrum> PlaceLight::exact_within(const Point& x, const Normal& n, RegionId own, double work,
                                                 Workspace& room) const {
    return max_work_ <= work ? direct_->irradiance(x, n, own, room.exact)
                             : direct_->irradiance_within(x, n, own, work, room.exact);
}

/// Returns the number of rays that a point needs for the required accuracy; 0 if the trial rays reach it. Estimates the
/// number from the variance of about `work` trial rays, whose number is added to `tried`: the variance of n stratified
/// rays is proportional to n^(-3/2).
double PlaceLight::rays_needed_at(const Point& x, const Normal& n, RegionId own, double work,
                                  const LightAccuracy& accuracy, Workspace& room, double& tried) const {
    LightAccuracy first = accuracy;
    first.max_rays = std::min(accuracy.max_rays, std::bit_ceil(static_cast<unsigned>(std::max(1.0, work))));
    const Estimate found = rays_.at(x, n, own, first, room);
    tried += static_cast<double>(found.rays);
    const double allowed = accuracy.allowed(mean(found.irradiance));
    if (found.variance <= allowed * allowed) return 0;
    const double rays = found.rays * std::pow(found.variance / (allowed * allowed), 2.0 / 3);
    return std::min<double>(rays, accuracy.max_rays);
}

/// Work of exact light at one place of a prepared polygon.
double PlaceLight::exact_work(const ReceiverLight& light) const {
    double work = 0;
    for (const ReceiverLight::Source& source : light.sources) {
        if (source.in_batch || source.far_factor >= 0) continue;
        const double blockers = source.count;
        work += 1 + work_of_blocker * blockers;
        const RelativeRadiance& radiance = direct_->emitters()[source.emitter].radiance;
        if (radiance.is_directed()) work += VisibilityWorkspace::work_of_integral * (1 + blockers);
        if (radiance.is_picture()) return HUGE_VAL;  // integrating a picture costs more than any number of rays
    }
    return light.behind.empty() ? work : work + exact_work(light.behind[0]);
}

DirectLight::WorthCounting PlaceLight::worth_counting(double work) {
    return [work](const SourceName&) { return static_cast<std::size_t>(work / work_of_blocker); };
}

/// Prepares exact light at places of a polygon. Returns false if one place certainly takes more than `work`.
bool PlaceLight::prepare(const Polygon& on, double work, const std::vector<SourceName>* named, Workspace& room) const {
    const DirectLight::WorthCounting worth = work < HUGE_VAL ? worth_counting(work) : DirectLight::WorthCounting();
    if (named)
        direct_->prepare(on.outline, on.n, on.own, *named, room.light_, room.exact, worth);
    else
        direct_->prepare(on.outline, on.n, on.own, room.light_, room.exact, worth);
    const double of_one = exact_work(room.light_);
    return !room.light_.has_crowded() && of_one <= work && of_one < HUGE_VAL;
}

/// Returns the forecast cost of a place by rays, in rays, minus its share of the cost of finding the blockers; infinite
/// if no error is allowed.
double PlaceLight::forecast_work(const Polygon& on, const std::vector<SourceName>* named, const LightAccuracy& accuracy,
                                 Workspace& room) const {
    if (!(accuracy.relative > 0 || accuracy.absolute > 0)) return HUGE_VAL;
    return rays_.forecast(centroid(on.outline), on.n, on.own, accuracy, room) - preparing_a_place(on, named);
}

double PlaceLight::preparing_a_place(const Polygon& on, const std::vector<SourceName>* named) const {
    const double preparing = named ? work_of_shaft * static_cast<double>(named->size()) : preparing_;
    return preparing / static_cast<double>(on.places.size());
}

bool PlaceLight::exact_at_places(const Polygon& on, const std::vector<SourceName>* named, const LightAccuracy& accuracy,
                                 Workspace& room, std::vector<Estimate>& out) const {
    return exact_within(on, named, forecast_work(on, named, accuracy, room), accuracy, room, out);
}

/// Computes exact light at the places if each takes at most `work`.
bool PlaceLight::exact_within(const Polygon& on, const std::vector<SourceName>* named, double work,
                              const LightAccuracy& accuracy, Workspace& room, std::vector<Estimate>& out) const {
    if (work <= 0 || !prepare(on, work, named, room)) return false;
    out.assign(on.places.size(), {});
    for (std::size_t i = 0; i < out.size() && !room.light_.is_dark(); ++i)
        out[i].irradiance = direct_->irradiance(room.light_, on.places[i], room.exact, &out[i].parallel);
    for (std::size_t i = 0; i < out.size(); ++i) add_mirrored(on.places[i], on.n, on.own, accuracy, out[i]);
    return true;
}

void PlaceLight::at_places(const Polygon& on, const LightAccuracy& accuracy, Workspace& room,
                           std::vector<Estimate>& out) const {
    const double work = forecast_work(on, nullptr, accuracy, room);
    if (exact_within(on, nullptr, work, accuracy, room, out)) return;
    LightAccuracy limited = accuracy;
    if (std::any_of(direct_->emitters().begin(), direct_->emitters().end(),
                    [](const DirectLight::Emitter& emitter) { return emitter.radiance.is_picture(); }))
        limited.max_rays = std::min(limited.max_rays, max_rays_to_picture);
    // In penumbrae, and where little of the light arrives, more rays are needed than were forecast. The first rays show
    // how many.
    double tried = 0;
    const double needed = rays_needed_at(on.places[on.places.size() / 2], on.n, on.own, work, limited, room, tried);
    if (needed > worth_another * work &&
        exact_within(on, nullptr, needed / worth_another - preparing_a_place(on, nullptr), accuracy, room, out))
        return;
    out.clear();
    const RayLight::Spreads known = rays_.spreads(on.places, on.n, on.own, limited, room);
    for (const Point& x : on.places) out.push_back(by_rays(x, on.n, on.own, limited, room, &known));
}

}  // namespace exitance
