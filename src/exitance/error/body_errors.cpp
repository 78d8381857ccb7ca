#include "exitance/error/body_errors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "exitance/base/loop_progress.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

/// Smallest error that is distinguished from noise, as a multiple of the requested error.
constexpr double resolved_errors = 1.5;  // given by the warning, whose limit is 3 times the requested error: half of it

double BodyMeasure::standard_error() const {
    if (points_ < 2) return 0;
    const double m = mean_square(), n = static_cast<double>(points_);
    return std::sqrt(std::max(0.0, squares_ / n - m * m) / (n - 1));
}

namespace {

/// Returns the RMS error relative to a radiosity, W/m^2; empty if noise hides it (`BodyMeasure::error`).
std::optional<double> resolved_error(double mean_square, double standard_error, double relative_to, double requested) {
    if (relative_to <= 0) return {};
    const double resolved = std::pow(resolved_errors * requested * relative_to, 2);
    if (standard_error > std::max(0.5 * mean_square, resolved)) return {};
    return std::sqrt(std::max({mean_square, standard_error, 0.0})) / relative_to;
}

}  // namespace

std::optional<double> BodyMeasure::error(double requested) const {
    if (points_ < min_points) return {};
    return resolved_error(mean_square(), standard_error(), reference(), requested);
}

double BodyMeasure::at_least() const {
    const double relative_to = reference();
    return relative_to > 0 ? std::sqrt(std::max(0.0, mean_square() - standard_error())) / relative_to : 0;
}

double BodyMeasure::suspected() const {
    const double relative_to = reference();
    return relative_to > 0 ? std::sqrt(std::max(0.0, mean_square() + standard_error())) / relative_to : 0;
}

namespace {

/// Returns the leaves of every body on other than unlit sides; none for bodies that do not reflect.
std::vector<std::vector<ElementId>> leaves_of_bodies(const BodyCheck& c) {
    std::vector<std::vector<ElementId>> out(c.bodies.all.size());
    for (ElementId e : c.indirect.tree.leaves()) {
        const RegionId region = c.indirect.tree.region(e);
        if (!c.stage.is_unlit(region) && max(c.stage.scene.material(region).reflectance) > 0)
            out[c.bodies.of(c.stage.scene, region)].push_back(e);
    }
    return out;
}

/// A point on a body and the parameters of its measurement.
struct BodyPoint {
    WeightedSample place;
    std::uint32_t body;
    CheckPlan plan;
    unsigned rays;
    std::uint64_t key;
};

class BodySurvey {
  public:
    BodySurvey(const BodyCheck& check, const std::function<double(std::size_t)>& light_of_room, double error,
               std::size_t max_rays)
        : c_(check),
          light_of_room_(light_of_room),
          error_(error),
          max_(max_rays),
          left_(max_rays),
          share_shown_(check.begins_at),
          leaves_(leaves_of_bodies(check)),
          measured_(unmeasured_bodies()),
          is_known_(check.bodies.all.size(), false),
          is_unknown_(check.bodies.all.size(), false) {}

    void look_at_all();
    void measure_further();
    std::vector<BodyError> errors() const;
    std::vector<PointError> close_points() const { return close_points_; }
    std::size_t rays_left() const { return left_; }
    HiddenErrors hidden() const;

  private:
    std::vector<BodyMeasure> unmeasured_bodies() const;
    /// Chooses the parameters of the checks. `requested`: requested error, W/m^2.
    CheckPlan plan(std::span<const PilotPlace> at, std::uint64_t name, double requested) const {
        // At least an eighth of the rays of a body, 16 of 128, are checked. A feature that fills a sixth of the body's
        // view is missed by all 16 checks in one of twenty cases.
        constexpr double min_share = 1.0 / 8;
        return plan_check(c_.check, c_.stage, c_.b, at, name,
                          {.tolerated = certificate_rays(0) * requested * requested, .min_share = min_share});
    }
    std::vector<PilotPlace> pilots(std::uint32_t body, std::size_t count, std::uint64_t name) const;
    std::size_t work(const CheckPlan& plan, unsigned rays, std::size_t points) const;
    std::vector<ResidualSample> measure(std::span<const BodyPoint> points);
    std::vector<PointError> add(std::span<const BodyPoint> points);
    bool measure_closely(std::uint32_t body, const CheckPlan& of_body, unsigned rays);
    bool measure_at_more_points(std::uint32_t body);
    /// Error of a body by the points of the certificate; empty if these are too few or too noisy.
    std::optional<double> error_at_points(std::size_t body) const {
        if (c_.at_points.empty() || c_.at_points[body].points < BodyAtPoints::min_points) return {};
        const BodyAtPoints& at = c_.at_points[body];
        return resolved_error(at.mean_square, at.standard_error, measured_[body].reference(), error_);
    }

    const BodyCheck& c_;
    const std::function<double(std::size_t)>& light_of_room_;
    double error_;
    const std::size_t max_;  ///< Rays allowed.
    std::size_t left_;       ///< Rays that remain.
    double share_shown_;     ///< Share of the phase that is done, for the progress.
    std::vector<std::vector<ElementId>> leaves_;
    std::vector<BodyMeasure> measured_;
    std::vector<PointError> close_points_;
    std::vector<bool> is_known_;    ///< Bodies measured by `measure_at_more_points`.
    std::vector<bool> is_unknown_;  ///< Bodies whose error matters, but for which the allowed rays do not suffice.
};

/// Returns the reflected light of every body, without points. It is a mean over many places of the delivered light,
/// which takes no rays: at the few points of a measurement, a sunlit edge of a dark plate would count too much or not
/// at all.
std::vector<BodyMeasure> BodySurvey::unmeasured_bodies() const {
    constexpr std::size_t places_in_all = 1 << 16, min_places = 64, max_places = 4096;
    const std::size_t count =
        std::clamp(places_in_all / std::max<std::size_t>(1, leaves_.size()), min_places, max_places);
    std::vector<BodyMeasure> out(leaves_.size());
    shared_ranges(
        out.size(), 1,
        [&](std::size_t begin, std::size_t end) {
            ResidualSampler::Workspace w;
            for (std::size_t body = begin; body < end; ++body) {
                if (leaves_[body].empty()) continue;
                double reflected = 0, light = 0;
                const std::uint64_t name = hash(c_.seed, static_cast<std::uint64_t>(Stream::certificate), 3, body);
                for (const WeightedSample& place : places_on_body(c_.indirect.tree, leaves_[body], count, name)) {
                    ResidualSample s;
                    c_.sampler.locate(place, s, w);
                    reflected += place.weight * s.reflected, light += place.weight * light_of_room_(s.room);
                }
                out[body] = {reflected, light};
            }
        },
        [&](std::size_t i) -> BodyMeasure& { return out[i]; }, {"certificate"});
    return out;
}

std::vector<PilotPlace> BodySurvey::pilots(std::uint32_t body, std::size_t count, std::uint64_t name) const {
    std::vector<PilotPlace> out;
    for (const WeightedSample& p : places_on_body(c_.indirect.tree, leaves_[body], count, name))
        out.push_back(
            {{c_.indirect.tree.patch(p.place.element).at(p.place.uv), c_.indirect.tree.region(p.place.element)},
             p.weight});
    return out;
}

/// Returns the number of rays for two gathers at each of this many points, including those of the checks.
std::size_t BodySurvey::work(const CheckPlan& plan, unsigned rays, std::size_t points) const {
    return static_cast<std::size_t>(2.0 * rays * static_cast<double>(points) * (1 + plan.work));
}

std::vector<ResidualSample> BodySurvey::measure(std::span<const BodyPoint> points) {
    std::vector<ResidualSample> out(points.size());
    constexpr std::size_t grain = 4;
    const double left = static_cast<double>(left_) / static_cast<double>(std::max<std::size_t>(1, max_)),
                 done = 1 - (1 - c_.begins_at) * left;
    LoopProgress progress({c_.progress, std::exchange(share_shown_, done), done, "bodies"},
                          own_count(points.size(), grain));
    shared_ranges(
        points.size(), grain,
        [&](std::size_t begin, std::size_t end) {
            ResidualSampler::Workspace w;
            for (std::size_t i = begin; i < end && !c_.is_stopped(); ++i) {
                const BodyPoint& p = points[i];
                out[i].is_measured = true;
                c_.sampler.locate(p.place, out[i], w);
                out[i].r1 = c_.sampler.by_rays(out[i], p.plan, p.rays, hash(p.key, 1), w);
                out[i].r2 = c_.sampler.by_rays(out[i], p.plan, p.rays, hash(p.key, 2), w);
                progress.add_one();
            }
        },
        [&](std::size_t i) -> ResidualSample& { return out[i]; }, {"certificate"});
    return out;
}

/// Measures points, and returns their errors relative to the light of their rooms.
std::vector<PointError> BodySurvey::add(std::span<const BodyPoint> points) {
    const std::vector<ResidualSample> found = measure(points);
    std::vector<PointError> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ResidualSample& s = found[i];
        if (!s.is_measured) continue;
        const double squared = s.is_covered ? 0 : mean((s.r1 + c_.late[s.leaf]) * (s.r2 + c_.late[s.leaf])),
                     light = light_of_room_(s.room);
        measured_[points[i].body].add(squared);
        out.push_back({s.surface, 1, squared / (light * light)});
    }
    return out;
}

void BodySurvey::look_at_all() {
    constexpr std::size_t points = BodyMeasure::min_points;
    constexpr std::size_t pilots_of_all = 64;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;  // random, so that the first ones are a sample of all
    for (std::uint32_t b = 0; b < leaves_.size(); ++b)
        if (!leaves_[b].empty()) order.emplace_back(hash(c_.seed, b), b);
    std::sort(order.begin(), order.end());
    const std::uint64_t name = hash(c_.seed, static_cast<std::uint64_t>(Stream::certificate), 1);
    std::vector<PilotPlace> at;
    for (std::size_t k = 0; k < std::min(order.size(), pilots_of_all); ++k)
        for (const PilotPlace& p :
             pilots(order[k].second, std::max<std::size_t>(1, pilots_of_all / order.size()), name))
            at.push_back({p.at, p.weight / static_cast<double>(std::min(order.size(), pilots_of_all))});
    const CheckPlan common_plan = plan(at, name, error_ * light_of_room_(0));
    // About half of the rays are for the bodies that seem worst; each point here gets at least the least number of
    // rays.
    std::vector<double> wanted(leaves_.size());  // rays a point, a power of two
    double wanted_by_all = 0;
    for (const auto& [chance, body] : order) {
        const double allowed = resolved_errors * error_ * measured_[body].reference();
        if (allowed <= 0) continue;
        const double noise = allowed * allowed * std::sqrt(static_cast<double>(points));
        wanted[body] = certificate_rays((common_plan.gather_variance + common_plan.variance) / noise);
        wanted_by_all += static_cast<double>(work(common_plan, 1, points)) * wanted[body];
    }
    const double share = std::min(1.0, 0.5 * static_cast<double>(left_) / std::max(1.0, wanted_by_all));
    std::vector<BodyPoint> todo;
    for (const auto& [chance, body] : order) {
        if (wanted[body] == 0) continue;
        const std::vector<WeightedSample> places =
            places_on_body(c_.indirect.tree, leaves_[body], points, hash(name, body));
        const unsigned rays = certificate_rays(std::bit_floor(static_cast<unsigned>(share * wanted[body])));
        if (work(common_plan, rays, points) > left_) break;
        left_ -= work(common_plan, rays, points);
        for (std::size_t i = 0; i < points; ++i)
            todo.push_back({places[i], body, common_plan, rays, hash(name, body, i)});
    }
    add(todo);
}

constexpr std::size_t max_close_points = 128;  ///< Limit on the further points of a body.

/// Measures a body at further points with this many rays each. Returns true if its error is then sufficiently known.
bool BodySurvey::measure_closely(std::uint32_t body, const CheckPlan& of_body, unsigned rays) {
    constexpr std::size_t batch = 16;
    // Standard error of the mean square at which to stop, as a share of the mean square; given by the required accuracy
    // of its root, an eighth.
    constexpr double sufficient_error = 0.25;
    const std::uint64_t name = hash(c_.seed, static_cast<std::uint64_t>(Stream::certificate), 2, body);
    const double resolved = std::pow(resolved_errors * error_ * measured_[body].reference(), 2);
    measured_[body] = measured_[body].without_points();
    for (std::size_t k = 0; k < max_close_points / batch && !c_.is_stopped(); ++k) {
        if (work(of_body, rays, batch) > left_) return false;
        left_ -= work(of_body, rays, batch);
        std::vector<BodyPoint> todo;
        for (const WeightedSample& place : places_on_body(c_.indirect.tree, leaves_[body], batch, hash(name, k, rays)))
            todo.push_back({place, body, of_body, rays, hash(name, k, todo.size(), rays)});
        const std::vector<PointError> found = add(todo);
        close_points_.insert(close_points_.end(), found.begin(), found.end());
        const BodyMeasure& now = measured_[body];
        if (now.standard_error() <= std::max(sufficient_error * now.mean_square(), resolved)) return true;
    }
    return false;
}

/// Measures a body at further points. Returns false if the rays do not suffice.
bool BodySurvey::measure_at_more_points(std::uint32_t body) {
    const std::uint64_t name = hash(c_.seed, static_cast<std::uint64_t>(Stream::certificate), 2, body);
    // The noise of each gather may be as large as the apparent error, but not larger than the limit at which users are
    // warned. Otherwise, among many bodies, those with the largest noise would seem to have the largest errors.
    const BodyMeasure before = measured_[body];
    const double requested = std::pow(error_ * before.reference(), 2);
    const double limit = max_body_errors * max_body_errors * requested;
    const CheckPlan of_body = plan(pilots(body, 16, name), name, std::sqrt(requested));
    const double noise = std::clamp(before.mean_square(), requested, limit);
    // More rays per point reduce the noise faster than more points do: the standard error falls in proportion to the
    // rays. If there are rare large differences, more rays are needed than the pilot predicts. One body may then take a
    // sixteenth of the remaining rays.
    constexpr unsigned more_rays = 4, largest_part = 16;
    unsigned rays = certificate_rays((of_body.gather_variance + of_body.variance) / noise);
    bool is_sufficient = measure_closely(body, of_body, rays);
    while (!is_sufficient && !c_.is_stopped()) {
        const unsigned more = certificate_rays(more_rays * rays);
        if (more == rays || work(of_body, more, max_close_points) > left_ / largest_part) break;
        rays = more;
        const BodyMeasure last = measured_[body];
        is_sufficient = measure_closely(body, of_body, rays);
        if (measured_[body].points() < BodyMeasure::min_points) measured_[body] = last;  // a stop ended it
    }
    if (measured_[body].points() < BodyMeasure::min_points) measured_[body] = before;
    return measured_[body].points() > BodyMeasure::min_points && measured_[body].error(error_);
}

/// Measures bodies at further points, in descending order of the error that they may have, until the others can neither
/// be the worst nor exceed the limit of a body's error.
void BodySurvey::measure_further() {
    double largest = 0;  // largest error that is known
    for (;;) {
        std::optional<std::uint32_t> worst;
        for (std::uint32_t b = 0; b < measured_.size(); ++b)
            if (!is_known_[b] && !is_unknown_[b] &&
                (!worst || measured_[b].suspected() > measured_[*worst].suspected()))
                worst = b;
        const double of_interest = std::clamp(largest, error_, max_body_errors * error_);
        if (!worst || measured_[*worst].suspected() <= of_interest) return;
        is_known_[*worst] = measure_at_more_points(*worst);
        is_unknown_[*worst] = !is_known_[*worst];
        if (is_known_[*worst]) largest = std::max(largest, *measured_[*worst].error(error_));
    }
}

HiddenErrors BodySurvey::hidden() const {
    HiddenErrors out;
    for (std::uint32_t b = 0; b < measured_.size(); ++b) {
        const double possible = measured_[b].suspected();
        if (!is_unknown_[b] || possible <= max_body_errors * error_ || error_at_points(b)) continue;
        ++out.bodies;
        if (possible > out.at_most) out.at_most = possible, out.first = c_.bodies.all[b].first;
    }
    return out;
}

std::vector<BodyError> BodySurvey::errors() const {
    std::vector<BodyError> out;
    for (std::size_t b = 0; b < measured_.size(); ++b) {
        const SceneBody& body = c_.bodies.all[b];
        const BodyMeasure& found = measured_[b];
        BodyError error{body.surfaces,  body.area,  found.mean_reflected(), found.error(error_),
                        found.points(), body.first, found.at_least()};
        if (is_unknown_[b]) error.error.reset();
        if (!error.error && (error.error = error_at_points(b))) {
            const BodyAtPoints& at = c_.at_points[b];
            error.points = at.points;
            error.at_least = std::sqrt(std::max(0.0, at.mean_square - at.standard_error)) / found.reference();
        }
        out.push_back(error);
    }
    std::stable_sort(out.begin(), out.end(), [](const BodyError& a, const BodyError& b) { return a.area > b.area; });
    return out;
}

}  // namespace

MeasuredBodies measure_bodies(const BodyCheck& check, const std::function<double(std::size_t)>& light_of_room,
                              double error, std::size_t max_rays) {
    BodySurvey survey(check, light_of_room, error, max_rays);
    survey.look_at_all();
    survey.measure_further();
    return {survey.errors(), survey.close_points(), max_rays - survey.rays_left(), survey.hidden()};
}

}  // namespace exitance
