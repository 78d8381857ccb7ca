#include "exitance/io/scenes/honeybee/honeybee_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

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

std::vector<const HoneybeeDynamic*> objects_of(const HoneybeeModel& model, const std::string& group) {
    std::vector<const HoneybeeDynamic*> out;
    for (const HoneybeeDynamic& object : model.dynamic)
        if (object.group == group || object.object == group) out.push_back(&object);
    return out;
}

/// Returns the factors that all windows of a group have in common.
Result<std::vector<double>> common_factors(const HoneybeeModel& model,
                                           std::span<const HoneybeeDynamic* const> objects) {
    constexpr double rounding = 1e-6;  // derived from the digits with which models give transmissivities
    const auto is_close = [](double a, double b) { return std::abs(a - b) <= rounding; };
    std::vector<double> out;
    for (const HoneybeeDynamic* const object : objects) {
        Result<std::vector<double>> factors = factors_of(model, *object);
        if (!factors) return factors.error();
        if (!out.empty() && !std::equal(factors->begin(), factors->end(), out.begin(), out.end(), is_close))
            return fault(fmt::format("'{}' and '{}' have other states", objects.front()->object, object->object),
                         "give them groups of their own in the model");
        out = std::move(*factors);
    }
    return out;
}

/// Returns the first state whose scene shows state k of all windows of a group: 0 if the shades are those of state 0,
/// so that a factor is enough, else a state with the same shades and materials.
std::size_t same_scene(std::span<const HoneybeeDynamic* const> objects, std::size_t k) {
    std::size_t first = 0;
    const auto is_other = [&](const HoneybeeDynamic* object) {
        const HoneybeeState &a = object->states[first], &b = object->states[k];
        return a.shades != b.shades || (first > 0 && a.modifier != b.modifier);
    };
    while (std::any_of(objects.begin(), objects.end(), is_other)) ++first;
    return first;
}

}  // namespace

Result<HoneybeeStates> find_honeybee_states(const HoneybeeModel& model, const std::string& group, bool objects_only) {
    const std::vector<const HoneybeeDynamic*> objects = objects_of(model, group);
    if (objects.empty()) return fault(fmt::format("the model has no dynamic objects of group '{}'", group));
    HoneybeeStates out;
    for (const HoneybeeDynamic* const object : objects) {
        out.objects.push_back(object->object), out.has_shades |= object->is_shade;
        if (!objects_only && object->states.size() != objects.front()->states.size())
            return fault(fmt::format("'{}' and '{}' have other states", objects.front()->object, object->object),
                         "give them groups of their own in the model");
    }
    if (objects_only) return out;
    const std::size_t states = objects.front()->states.size();
    out.factors.assign(states, 1);
    if (!out.has_shades) {
        Result<std::vector<double>> factors = common_factors(model, objects);
        if (!factors) return factors.error();
        out.factors = std::move(*factors);
    }
    for (std::size_t k = 0; k < states; ++k) {
        out.scene.push_back(out.has_shades ? k : same_scene(objects, k));
        if (out.scene[k] > 0) out.factors[k] = 1;
    }
    return out;
}

HoneybeeChoices HoneybeeStates::choices(std::size_t state) const {
    HoneybeeChoices out;
    for (const std::string& object : objects) out[object] = scene[state];
    return out;
}

}  // namespace exitance
