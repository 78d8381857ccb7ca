#include "exitance/what_if/daylight/state_choice.hpp"

#include <algorithm>
#include <functional>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Blinds close if more than this share of the points has at least this direct sunlight, lx [LM83].
constexpr double max_sunny_share = 0.02, min_sunlight = 1000;

/// Finds how much direct sunlight reaches more than 2% of the sensors of a grid through each group of panes.
class CommonSunlight {
  public:
    CommonSunlight(const DaylightSetting& setting, const PaneGroups& groups)
        : setting_(setting), groups_(groups), suns_(setting.sky), hours_(setting.sky.hours()) {}

    /// Returns that sunlight, lx, for the grid that has most of it, per group and hour; 0 below 1000 lx.
    std::vector<std::vector<float>> find(const Occluders& occluders, std::span<const SurfacePoint> places) const {
        std::vector<std::vector<float>> out(groups_.count(), std::vector<float>(hours_, 0));
        std::size_t first = 0;
        for (const SensorGrid& grid : setting_.grids) {
            const auto needed = static_cast<std::size_t>(max_sunny_share * static_cast<double>(grid.count)) + 1;
            const std::vector<Largest> found = largest(occluders, places.subspan(first, grid.count), needed);
            for (std::size_t g = 0; g < groups_.count(); ++g)
                for (std::size_t h = 0; h < hours_; ++h)
                    if (const Largest& values = found[g * hours_ + h]; values.size() == needed)
                        out[g][h] = std::max(out[g][h], values.front());
            first += grid.count;
        }
        return out;
    }

  private:
    /// The largest values of an hour, the least of them first (a heap).
    using Largest = std::vector<float>;

    static void keep(float value, std::size_t most, Largest& values) {
        if (values.size() == most) {
            if (value <= values.front()) return;
            std::pop_heap(values.begin(), values.end(), std::greater<>());
            values.pop_back();
        }
        values.push_back(value);
        std::push_heap(values.begin(), values.end(), std::greater<>());
    }

    /// Returns up to `most` values of the sensors of a grid: a row per group, a column per hour.
    std::vector<Largest> largest(const Occluders& occluders, std::span<const SurfacePoint> places,
                                 std::size_t most) const {
        constexpr std::size_t together = 256;
        std::vector<Largest> out(groups_.count() * hours_);
        std::vector<YearSuns::Through> sun(together * hours_);
        for (std::size_t first = 0; first < places.size(); first += together) {
            const std::size_t n = std::min(together, places.size() - first);
            parallel_for(n, 1, [&](std::size_t i) {
                suns_.find_through(occluders, groups_, places[first + i], min_sunlight,
                                   std::span(sun).subspan(i * hours_, hours_));
            });
            for (std::size_t k = 0; k < n * hours_; ++k)
                for (std::size_t g = 0; sun[k].groups != 0 && g < groups_.count(); ++g)
                    if (sun[k].groups >> g & 1) keep(sun[k].illuminance, most, out[g * hours_ + k % hours_]);
        }
        return out;
    }

    const DaylightSetting& setting_;
    const PaneGroups& groups_;
    YearSuns suns_;
    std::size_t hours_;
};

/// Returns the mean of the light at sensors.
std::vector<std::vector<double>> mean_light(std::span<const std::size_t> sensors, std::size_t groups, std::size_t hours,
                                            const OpenLight& open_light) {
    std::vector<std::vector<double>> out(groups + 1, std::vector<double>(hours, 0));
    for (const std::size_t sensor : sensors) {
        const std::vector<std::vector<float>> lux = open_light(sensor);
        for (std::size_t row = 0; row < out.size(); ++row)
            for (std::size_t h = 0; h < hours; ++h)
                out[row][h] += double(lux[row][h]) / static_cast<double>(sensors.size());
    }
    return out;
}

/// Returns the multiple of each part that is added to the light of an hour. `factors`: of other glass, one per group.
std::vector<float> weights_of(const DaylightStates& states, std::span<const double> factors,
                              const std::vector<std::vector<std::uint8_t>>& chosen, std::size_t hour) {
    const std::size_t groups = states.groups.size();
    std::vector<float> out;
    for (std::size_t k = 0; k < groups + states.scenes.size(); ++k) {
        const std::size_t g = k < groups ? k : states.scenes[k - groups].group;
        const PaneState& state = states.groups[g].states[chosen[g][hour]];
        const bool is_here = k < groups ? !state.scene : state.scene == k - groups;
        const double factor = is_here ? state.factor * factors[g] : 0;
        out.push_back(static_cast<float>(k < groups ? factor - 1 : factor));
    }
    return out;
}

bool is_any(std::span<const float> weights) {
    return std::any_of(weights.begin(), weights.end(), [](float w) { return w != 0; });
}

VariantWeights weights_of(const DaylightStates& states, const GlassVariant& variant, const StateChooser& chooser,
                          const HourlyStates& hourly) {
    VariantWeights out;
    out.factors = variant.factors;
    out.parts.resize(hourly.parts.size());
    const std::vector<std::vector<std::uint8_t>> chosen = chooser.choose(variant.factors);
    for (const std::size_t h : hourly.occupied) {
        const std::vector<float> weights = weights_of(states, variant.factors, chosen, h);
        for (std::size_t k = 0; k < weights.size(); ++k) out.parts[k].push_back(weights[k]);
        out.uncertainty.push_back(is_any(weights) ? static_cast<float>(hourly.twice) : 0.0f);
    }
    return out;
}

}  // namespace

StateChooser::StateChooser(const DaylightStates& states, const DaylightSetting& setting, const Occluders& occluders,
                           const PaneGroups& groups, std::span<const SurfacePoint> places, const OpenLight& open_light)
    : states_(states), hours_(setting.sky.hours()) {
    const auto is_by_sun = [](const PaneGroup& g) { return g.rule.kind == StateRule::Kind::sunlight; };
    if (std::any_of(states.groups.begin(), states.groups.end(), is_by_sun))
        sunlight_ = CommonSunlight(setting, groups).find(occluders, places);
    for (const PaneGroup& group : states.groups)
        light_.push_back(group.rule.kind == StateRule::Kind::illuminance
                             ? mean_light(group.rule.sensors, states.groups.size(), hours_, open_light)
                             : std::vector<std::vector<double>>());
}

std::vector<std::vector<std::uint8_t>> StateChooser::choose(std::span<const double> factors) const {
    std::vector<std::vector<std::uint8_t>> out;
    for (std::size_t g = 0; g < states_.groups.size(); ++g) {
        const StateRule& rule = states_.groups[g].rule;
        switch (rule.kind) {
            case StateRule::Kind::schedule:
                out.push_back(rule.schedule);
                break;
            case StateRule::Kind::illuminance:
                out.push_back(by_illuminance(g, factors));
                break;
            case StateRule::Kind::sunlight:
                out.push_back(by_sunlight(g, factors[g]));
                break;
        }
    }
    return out;
}

/// Counts the limits that the mean illuminance at the sensors of the rule exceeds.
std::vector<std::uint8_t> StateChooser::by_illuminance(std::size_t group, std::span<const double> factors) const {
    std::vector<std::uint8_t> out(hours_, 0);
    for (std::size_t h = 0; h < hours_; ++h) {
        double E = light_[group][0][h];
        for (std::size_t g = 0; g < factors.size(); ++g)
            if (factors[g] != 1) E -= (1 - factors[g]) * light_[group][g + 1][h];
        for (const double limit : states_.groups[group].rule.limits) out[h] += E > limit;
    }
    return out;
}

std::vector<std::uint8_t> StateChooser::by_sunlight(std::size_t group, double factor) const {
    std::vector<std::uint8_t> out(hours_, 0);
    const auto closed = static_cast<std::uint8_t>(states_.groups[group].states.size() - 1);
    for (std::size_t h = 0; h < hours_; ++h)
        if (factor * double(sunlight_[group][h]) >= min_sunlight) out[h] = closed;
    return out;
}

HourlyStates make_hourly_states(const DaylightStates& states, const StateChooser& chooser,
                                const DaylightSetting& setting, double twice) {
    HourlyStates out;
    out.twice = twice;
    const std::size_t groups = states.groups.size();
    const std::vector<double> same(groups, 1);
    out.state = chooser.choose(same);
    out.parts.resize(groups + states.scenes.size());
    for (std::size_t g = 0; g < groups; ++g) out.parts[g].group = g;
    for (std::size_t h = 0; h < setting.hours.size(); ++h) {
        const std::vector<float> weights = weights_of(states, same, out.state, h);
        for (std::size_t k = 0; k < weights.size(); ++k) out.parts[k].weights.push_back(weights[k]);
        out.is_changed.push_back(is_any(weights));
        if (!states.variants.empty() && setting.criteria.is_occupied(setting.hours[h], h)) out.occupied.push_back(h);
    }
    for (const GlassVariant& variant : states.variants)
        out.variants.push_back(weights_of(states, variant, chooser, out));
    return out;
}

}  // namespace exitance
