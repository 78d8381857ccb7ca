#include "exitance/methods/solver/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/error/direct_light_noise.hpp"
#include "exitance/error/further_measurements.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/methods/importance.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/solve_report.hpp"
#include "exitance/methods/solver/place_of_room.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

double Solver::margin(std::size_t points) {
    const double first = static_cast<double>(CertificateOptions::points_for(0));
    return 1 - calibrated::estimate_margin * (points > 0 ? std::sqrt(first / static_cast<double>(points)) : 1);
}

double Solver::judged_error() const {
    return std::max(certificate_.largest(), margin(certificate_.points) * certificate_.upper_limit());
}

void Solver::set_light_of_rooms(CertificateOptions& options, const Spectrum& direct_weight) {
    if (form_of(options_) == Form::standard && gathers() && stage_.rooms.count() > 0) {
        options.delivered_in = delivered_by_room(stage_, solution_.indirect, direct_, direct_weight);
        rooms_.correct_light(options.delivered_in, light_->mean_reflected(stage_.area), stage_);
    }
    options.light_in = rooms_.light_in(), options.allowed_in = rooms_.allowed_in();
}

void Solver::certify(CertificateOptions options, std::optional<double> demand,
                     std::span<const ElementGather> gathered) {
    options.direct_in_elements = light_->holds_direct();
    options.keeps_flux = gathers() && !light_->holds_direct() && keeps_flux() &&
                         has_kept_flux(solution_.indirect, stage_.scene, direct_, lost_light(), solution_.direct_share);
    const Spectrum c = solution_.direct_share;
    const Spectrum direct_weight = light_->holds_direct() ? Spectrum() : Spectrum(1.0) - c;
    set_light_of_rooms(options, direct_weight);
    options.bounces = options_.bounces;
    options.bodies = &bodies();
    options.stop = &stop_, options.progress = &progress_;
    if (has_links_) options.places = places_of(stage_, solution_.indirect.tree, options_.importance);
    // With a limited number of reflections, the gathered light has one reflection less than the delivered light.
    std::optional<ElementFunction> older;
    if (options_.bounces > 0) older = constant_on_leaves(*light_);
    const ElementFunction& indirect = older ? *older : solution_.indirect;
    DeliveredLight delivered(stage_.scene, indirect, direct_, direct_weight, c);
    if (!bright_.empty()) delivered.aim_at(bright_);
    const auto misfit = [&](const RayEnd& hit) {
        return std::sqrt(direct_.fit[delivered.projected().locator().find(hit.region, hit.x).element].misfit_squared);
    };
    if (!light_->holds_direct()) options.projected = {&delivered.projected(), direct_weight, misfit};
    // A tenth of the rays so far, but at least about 30 ms of work, and 2 ms for each body, so that the errors of
    // bodies can be measured.
    constexpr std::size_t min_check_rays = 1 << 17, min_rays_of_body = 1 << 13;
    options.check_rays = std::max({statistics().rays / 10, min_check_rays, min_rays_of_body * bodies().all.size()});
    SummedLight summed{.delivered = {}, .gathered = gathered, .share = ErrorBudget(options.error).certified_sum()};
    if (sums_) {
        for (const ElementFunction& part : delivered_functions(stage_.scene, indirect, direct_, direct_weight, c))
            summed.delivered.emplace_back(stage_, part);
        options.summed = &summed;
    }
    Certifier certifier(stage_, *light_, solution_.indirect, delivered, options);
    certificate_ = certifier.measure(demand ? 1 : 0);
    // The number of further points is chosen once. Points that are added until an estimate is small enough would make
    // it too small.
    const auto more = [&] {
        return further_measurements({certificate_.largest(), certificate_.largest_uncertainty()},
                                    margin(certificate_.points) * *demand, *demand);
    };
    for (std::size_t left = demand ? more() : 0; left > 0 && !stop_.requested(); --left)
        certificate_ = certifier.measure(left - 1);
    const double noise = direct_light_noise_share();
    Certificate by_paths = certificate_;
    certificate_.add_independent_error(noise);
    if (!demand || may_be_last(*demand)) {
        certifier.check_by_paths(by_paths);
        certificate_ = by_paths, certificate_.add_independent_error(noise);
    }
    if (!demand || may_be_last(*demand)) {
        certifier.measure_each_body(certificate_);
        certifier.measure_p99(certificate_);
    }
    record_errors(certifier, noise);
    if (certificate_.points == 0 && !stop_.requested()) record_darkness();
    progress_.note(describe(certificate_, *light_, solution_.indirect, gathered_));
}

void Solver::record_errors(const Certifier& certifier, double noise) {
    record_certificate(certificate_, *light_, solution_.indirect, statistics());
    statistics().rooms = certifier.rooms(), statistics().surface_errors = certifier.surface_errors();
    for (RoomError& room : statistics().rooms)
        room.error = statistics().rooms.size() == 1 ? certificate_.worst_room : std::hypot(room.error, noise);
    statistics().bodies = certifier.bodies();
}

void Solver::record_darkness() {
    const double reflected = mean_direct_light(stage_, direct_).reflected;
    if (!(reflected > 0)) return record_zero_error();
    refusal_ = Error{ErrorCode::limit,
                     fmt::format("method {} found no light, but direct light makes surfaces reflect {:.3g} {} in the "
                                 "mean; nothing is written",
                                 name_in(method_names, options_.method), reflected,
                                 stage_.scene.is_photometric() ? "lm/m^2" : "W/m^2"),
                     stage_.scene.file(), "another --method may find it"};
}

bool Solver::may_be_last(double demand) const {
    if (is_intermediate()) return false;
    return has_reached(demand) || attempt_ == attempt_limit() || options_.memory_limit_bytes ||
           common_seconds_left(stop_) < HUGE_VAL;
}

double Solver::direct_light_noise_share() const {
    if (certificate_.points == 0 || light_->holds_direct()) return 0;
    return direct_light_noise(stage_, direct_, point_accuracy(certificate_.estimate)) / certificate_.mean_reflected;
}

void Solver::warn_of_hidden_errors() {
    const HiddenErrors& hidden = certificate_.hidden;
    if (hidden.bodies == 0) return;
    const Scene& scene = stage_.scene;
    const Point at = centroid(scene.outline(hidden.first));
    warn(
        fmt::format("the light of '{}' (near {:.4g}, {:.4g}, {:.4g}) may be wrong by up to {:.3g}%{}: measuring the "
                    "errors of all bodies would take too many rays; {}",
                    scene.groups()[scene.surfaces()[hidden.first].group], at.x, at.y, at.z, 100 * hidden.at_most,
                    hidden.bodies > 1 ? fmt::format(", and that of {} more by less", hidden.bodies - 1) : "",
                    advice_at_end("makes more of them known")));
}

std::string Solver::advice_at_end(std::string_view effect) const {
    StopReason why = solution_.statistics.stopped_by;
    if (why == StopReason::none && stop_.requested()) why = reason_of(stop_);
    switch (why) {
        case StopReason::time_limit:
            return fmt::format("the time limit ended the solve: more time {}", effect);
        case StopReason::memory_limit:
            return fmt::format("the memory limit ended the solve: more memory {}", effect);
        case StopReason::interrupt:
        case StopReason::termination:
            return fmt::format("the solve was stopped: a complete run {}", effect);
        default:
            return lacked_time_ ? fmt::format("another attempt did not fit into the time limit: more time {}", effect)
                                : fmt::format("a smaller --error {}", effect);
    }
}

void Solver::warn_of_rooms() {
    const std::optional<double> demand = options_.error_demand();
    const std::vector<RoomError>& rooms = statistics().rooms;
    if (!demand || statistics().converged || rooms.empty() || rooms.size() != stage_.rooms.count()) return;
    const double limit = *demand;
    const auto worst = std::max_element(rooms.begin(), rooms.end(),
                                        [](const RoomError& a, const RoomError& b) { return a.error < b.error; });
    if (worst->error <= limit) return;
    const auto wrong =
        std::count_if(rooms.begin(), rooms.end(), [&](const RoomError& room) { return room.error > limit; });
    const NumberTexts percents = distinct_percents(worst->error, limit);
    warn(fmt::format("the light of the {} is wrong by about {}%, where {}% was requested{}",
                     place_of_room(stage_, static_cast<std::size_t>(worst - rooms.begin())), percents.first,
                     percents.second, wrong > 1 ? fmt::format(", and so is that of {} more", wrong - 1) : ""));
}

void Solver::warn_of_bodies() {
    const std::optional<double> demand = options_.error_demand();
    if (!demand) return;
    warn_of_hidden_errors();
    const double limit = ErrorBudget(*demand).body();
    const BodyError* worst = nullptr;
    std::size_t wrong = 0;
    for (const BodyError& body : statistics().bodies) {
        if (!body.error || *body.error <= limit) continue;
        ++wrong;
        if (!worst || *body.error > *worst->error) worst = &body;
    }
    if (!worst) return;
    const Scene& scene = stage_.scene;
    const Surface& face = scene.surfaces()[worst->first];
    const Point at = centroid(scene.outline(worst->first));
    warn(fmt::format(
        "the light of '{}' ({} face{}, {:.3g} m^2, near {:.4g}, {:.4g}, {:.4g}) is wrong by about {}%, "
        "more than three times the {:.6g}% requested for the whole{}; {}",
        scene.groups()[face.group], worst->surfaces, worst->surfaces == 1 ? "" : "s", worst->area, at.x, at.y, at.z,
        distinct_percents(*worst->error, limit).first, 100 * *demand,
        wrong > 1 ? fmt::format(", and so is that of {} more", wrong - 1) : "", advice_at_end("corrects it")));
}

}  // namespace exitance
