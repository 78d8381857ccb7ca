#include "exitance/io/scenes/honeybee/honeybee_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

Error fault(std::string message, std::string hint = "") {
    return {ErrorCode::bad_input, std::move(message), "", std::move(hint)};
}

/// Returns the transmittance of a glass modifier at normal incidence; none for other materials.
std::optional<double> transmittance_of(const HoneybeeModel& model, const std::string& modifier) {
    for (const RadPrimitive& p : model.modifiers) {
        if (p.name != modifier || p.type != "glass" || p.numbers.size() < bands) continue;
        Pane pane;
        for (std::size_t b = 0; b < bands; ++b) pane.transmissivity[b] = std::clamp(p.numbers[b], 0.0, 1.0);
        if (p.numbers.size() > bands) pane.index = p.numbers[bands];
        return luminous_sum(pane.transmission(1));
    }
    return std::nullopt;
}

Result<std::vector<double>> factors_of(const HoneybeeModel& model, const HoneybeeDynamic& object) {
    std::vector<double> out;
    double first = 0;
    for (std::size_t k = 0; k < object.states.size(); ++k) {
        const HoneybeeState& state = object.states[k];
        if (k > 0 && state.has_shades)
            return fault(fmt::format("state {} of '{}' has shades", k, object.object),
                         "give the states with [[group.state]], and these shades as 'files'");
        const std::optional<double> T = transmittance_of(model, state.modifier);
        if (!T || (k == 0 && !(*T > 0)))
            return fault(fmt::format("the material '{}' of state {} of '{}' is not clear glass", state.modifier, k,
                                     object.object),
                         "give the states with [[group.state]]");
        if (k == 0) first = *T;
        if (*T > first)
            return fault(fmt::format("state {} of '{}' passes more light than its first state", k, object.object),
                         "put the clearest state first in the model");
        out.push_back(*T / first);
    }
    return out;
}

}  // namespace

Result<HoneybeeStates> find_honeybee_states(const HoneybeeModel& model, const std::string& group, bool objects_only) {
    constexpr double rounding = 1e-6;  // derived from the digits with which models give transmissivities
    HoneybeeStates out;
    for (const HoneybeeDynamic& object : model.dynamic) {
        if (object.group != group && object.object != group) continue;
        Result<std::vector<double>> factors =
            objects_only ? Result<std::vector<double>>(std::vector<double>()) : factors_of(model, object);
        if (!factors) return factors.error();
        const auto is_close = [&](double a, double b) { return std::abs(a - b) <= rounding; };
        if (!out.objects.empty() &&
            !std::equal(factors->begin(), factors->end(), out.factors.begin(), out.factors.end(), is_close))
            return fault(fmt::format("'{}' and '{}' have other states", out.objects.front(), object.object),
                         "give them groups of their own in the model");
        out.objects.push_back(object.object), out.factors = std::move(*factors);
    }
    if (out.objects.empty()) return fault(fmt::format("the model has no dynamic objects of group '{}'", group));
    return out;
}

}  // namespace exitance
