#include "exitance/methods/plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/calibration/numbers.hpp"
#include "exitance/evaluate/unlit_sides.hpp"
#include "exitance/methods/hierarchical/hierarchical.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/plan/choice.hpp"

namespace exitance {
namespace {

/// Adds notices for link options that have no effect because the method uses no links.
void notice_unused_links(Plan& plan) {
    const std::string_view method = name_in(method_names, plan.options.method);
    if (!plan.options.importance.empty())
        plan.notices.push_back(fmt::format("--importance has no effect: the method {} has no links", method));
    if (plan.options.keep_links)
        plan.notices.push_back(
            fmt::format("--keep-links has no effect: the method {} has no links (--method hierarchical has)", method));
    if (plan.options.oracle != LinkOracle::transport)
        plan.notices.push_back(fmt::format("--oracle has no effect: the method {} has no links", method));
}

/// Uses clusters if links between all pairs would exceed the memory limit.
void fit_links(Plan& plan, const Stage& stage) {
    if (plan.options.clusters != false || !links_outgrow_memory(stage.pieces.size(), plan.options)) return;
    plan.notices.push_back(fmt::format(
        "links between all pairs of {} polygons would exceed --memory-limit: clusters are used", stage.pieces.size()));
    plan.options.clusters = true;
}

}  // namespace

void survey(Stage& stage, const SolveOptions& options, const StopRequest& stop) {
    // Published forms solve on all sides, and use rooms only if errors are judged by room.
    if (form_of(options) == Form::standard) stage.set_unlit_sides(find_unlit_sides(stage, options.seed, stop));
    if (has_estimate(options)) stage.set_rooms(find_light_rooms(stage, options.seed, stop));
}

Knobs first_knobs(const Plan& plan, const Stage& stage, double error) {
    const LitSpaces lit = stage.lit_spaces();
    Knobs knobs = knobs_for_error(error, lit, plan.options);
    knobs.links_deliver = plan.knobs.links_deliver;
    return plan.sums ? knobs_for_sums(knobs, error, lit, plan.options) : knobs;
}

Plan make_plan(const Stage& stage, const SolveOptions& asked, double first_error) {
    if (form_of(asked) != Form::standard) {
        Plan plan{.options = asked};
        plan.knobs = first_knobs(plan, stage, asked.error_target());
        return plan;
    }
    MethodChoice choice = choose_method(stage, asked);
    Plan plan{.options = std::move(choice.options), .why = std::move(choice.why)};
    const Method method = plan.options.method;
    const std::string_view name = name_in(method_names, method);
    if (choice.is_second) plan.notices.push_back(fmt::format("method {}: {}", name, std::exchange(plan.why, {})));
    if (asked.method != Method::automatic && asked.method != method)
        plan.notices.push_back(
            fmt::format("--bounces needs the method matrix, which replaces {}", name_in(method_names, asked.method)));
    const bool sharp = method == Method::discontinuity && plan.options.bounces < 0;
    plan.has_links = method == Method::hierarchical || method == Method::wavelet || sharp;
    if (plan.has_links)
        fit_links(plan, stage);
    else
        notice_unused_links(plan);
    const double error = std::max(first_error, plan.options.error_target());
    plan.sums = choice.forecast.takes_sums();
    plan.knobs.links_deliver = !plan.sums || choice.forecast.takes_links();
    plan.knobs = first_knobs(plan, stage, error);
    plan.may_step_on_delivered = asked.method == Method::automatic && method == Method::matrix && !plan.options.basis &&
                                 plan.options.bounces < 0 && !plan.sums && !plan.options.form_factors;
    return plan;
}

}  // namespace exitance
