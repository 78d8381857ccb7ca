#include "exitance/methods/plan/choice.hpp"

#include <fmt/format.h>

#include "exitance/calibration/numbers.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/methods/hierarchical/hierarchical.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/plan/delivery_forecast.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

namespace {

/// True if the options allow a solve over links, whose linear or quadratic elements also deliver the light.
bool may_deliver(const SolveOptions& options) {
    const bool is_polynomial =
        !options.basis || options.basis == BasisKind::multiwavelet2 || options.basis == BasisKind::multiwavelet3;
    return is_polynomial && (options.method == Method::automatic || options.method == Method::wavelet) &&
           options.error_demand() && !options.epsilon && options.importance.empty() && options.bounces < 0;
}

MethodChoice choose_alone(const Stage& stage, const SolveOptions& options) {
    MethodChoice out{.options = options, .forecast = forecast_delivery(stage, options, may_deliver(options))};
    const auto choose = [&](Method method, std::string why) {
        out.options.method = method, out.why = std::move(why);
        return out;
    };
    // Only `matrix` can limit the number of reflections, since its iterations are reflections.
    if (options.bounces > 0 && options.method != Method::discontinuity)
        return choose(Method::matrix, "counts reflections");
    if (options.method == Method::wavelet && !options.basis) out.options.basis = BasisKind::multiwavelet2;
    if (options.method != Method::automatic) return out;
    if (!options.importance.empty()) return choose(Method::hierarchical, "refines for the points of --importance");
    if (options.error_interpolant && *options.error_interpolant <= calibrated::sharp_interpolant &&
        !ElementGather::suits(stage))
        return choose(Method::discontinuity,
                      fmt::format("an error of {:.3g}% of the exported mesh needs elements along shadows",
                                  100 * *options.error_interpolant));
    if (!ElementGather::suits(stage))
        return choose(Method::matrix, fmt::format("{} polygons that occlude one another: rays suit such scenes best",
                                                  stage.scene.surfaces().size()));
    if (!out.forecast.takes_links()) return choose(Method::matrix, describe(out.forecast));
    out.options.basis = BasisKind::multiwavelet3;
    return choose(Method::wavelet, describe(out.forecast));
}

}  // namespace

bool runs_over_processes(Relaxation relaxation) {
    return relaxation != Relaxation::gauss_seidel && relaxation != Relaxation::southwell;
}

bool runs_over_processes(Method method, const SolveOptions& options) {
    return method == Method::matrix || (method == Method::hierarchical && !asks_for_judged_links(options));
}

MethodChoice choose_method(const Stage& stage, const SolveOptions& options) {
    const bool is_free = options.method == Method::automatic;
    if (is_free && stage.scene.has_diffusing_panes() && supports_all(Method::matrix, options)) {
        MethodChoice choice{.options = options, .why = "counts both sides of diffusing panes"};
        choice.options.method = Method::matrix;
        return choice;
    }
    MethodChoice choice = choose_alone(stage, options);
    const Method other = first_supporting(options);
    if (is_free && other != Method::automatic && !supports_all(choice.options.method, options)) {
        choice.options = options;
        choice.options.method = other;
        choice.why = "supports all given options";
    }
    const bool by_rays = runs_over_processes(choice.options.method, choice.options) &&
                         !(choice.options.method == Method::hierarchical &&
                           // such a solve uses clusters instead of rays
                           links_outgrow_memory(stage.pieces.size(), choice.options));
    if (processes() == 1 || by_rays) return choice;
    choice.why = fmt::format("{} would be the choice ({}), but does not run over processes",
                             name_in(method_names, choice.options.method), choice.why);
    choice.options = options;
    choice.options.method = Method::matrix;
    choice.is_second = true;
    return choice;
}

}  // namespace exitance
