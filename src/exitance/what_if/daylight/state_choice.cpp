#include "exitance/what_if/daylight/state_choice.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// LM-83: blinds close if more than this share of the points has at least this direct sunlight, lx [LM83].
constexpr double max_sunny_share = 0.02, least_sunlight = 1000;

/// Finds the hours in which more than 2% of the sensors of some grid have direct sunlight through panes of a group.
class SunnyHours {
  public:
    SunnyHours(const DaylightSetting& setting, const PaneGroups& groups)
        : setting_(setting), groups_(groups), suns_(setting.sky), hours_(setting.sky.hours()) {}

    /// Returns 1 for every such hour, else 0, per group.
    std::vector<std::vector<std::uint8_t>> find(const Occluders& occluders, std::span<const Receiver> places) const {
        std::vector<std::vector<std::uint8_t>> out(groups_.count(), std::vector<std::uint8_t>(hours_, 0));
        std::size_t first = 0;
        for (const SensorGrid& grid : setting_.grids) {
            const std::vector<std::uint32_t> counts = count(occluders, places.subspan(first, grid.count));
            for (std::size_t g = 0; g < groups_.count(); ++g)
                for (std::size_t h = 0; h < hours_; ++h)
                    if (counts[g * hours_ + h] > max_sunny_share * static_cast<double>(grid.count)) out[g][h] = 1;
            first += grid.count;
        }
        return out;
    }

  private:
    /// Returns the number of sunny sensors: a row per group, a column per hour.
    std::vector<std::uint32_t> count(const Occluders& occluders, std::span<const Receiver> places) const {
        constexpr std::size_t together = 256;
        std::vector<std::uint32_t> counts(groups_.count() * hours_, 0);
        std::vector<PaneGroups::Mask> crossed(together * hours_);
        for (std::size_t first = 0; first < places.size(); first += together) {
            const std::size_t n = std::min(together, places.size() - first);
            parallel_for(n, 1, [&](std::size_t i) {
                suns_.find_through(occluders, groups_, places[first + i], least_sunlight,
                                   std::span(crossed).subspan(i * hours_, hours_));
            });
            for (std::size_t k = 0; k < n * hours_; ++k)
                for (std::size_t g = 0; crossed[k] != 0 && g < groups_.count(); ++g)
                    counts[g * hours_ + k % hours_] += crossed[k] >> g & 1;
        }
        return counts;
    }

    const DaylightSetting& setting_;
    const PaneGroups& groups_;
    YearSuns suns_;
    std::size_t hours_;
};

/// Chooses states by the number of limits that the mean illuminance at the sensors of a rule exceeds.
std::vector<std::uint8_t> by_illuminance(const StateRule& rule, std::size_t hours, const OpenLight& open_light) {
    std::vector<double> mean(hours, 0);
    for (const std::size_t sensor : rule.sensors) {
        const std::vector<float> lux = open_light(sensor);
        for (std::size_t h = 0; h < hours; ++h) mean[h] += double(lux[h]) / static_cast<double>(rule.sensors.size());
    }
    std::vector<std::uint8_t> out(hours, 0);
    for (std::size_t h = 0; h < hours; ++h)
        for (const double limit : rule.limits) out[h] += mean[h] > limit;
    return out;
}

}  // namespace

std::vector<std::vector<std::uint8_t>> choose_states(const DaylightStates& states, const DaylightSetting& setting,
                                                     const Occluders& occluders, const PaneGroups& groups,
                                                     std::span<const Receiver> places, const OpenLight& open_light) {
    const auto is_by_sun = [](const PaneGroup& g) { return g.rule.kind == StateRule::Kind::sunlight; };
    std::vector<std::vector<std::uint8_t>> sunny, out;
    if (std::any_of(states.groups.begin(), states.groups.end(), is_by_sun))
        sunny = SunnyHours(setting, groups).find(occluders, places);
    for (std::size_t g = 0; g < states.groups.size(); ++g) {
        const PaneGroup& group = states.groups[g];
        switch (group.rule.kind) {
            case StateRule::Kind::schedule:
                out.push_back(group.rule.schedule);
                break;
            case StateRule::Kind::illuminance:
                out.push_back(by_illuminance(group.rule, setting.sky.hours(), open_light));
                break;
            case StateRule::Kind::sunlight:
                for (std::uint8_t& state : sunny[g]) state *= static_cast<std::uint8_t>(group.states.size() - 1);
                out.push_back(std::move(sunny[g]));
                break;
        }
    }
    return out;
}

HourlyStates make_hourly_states(const DaylightStates& states, std::vector<std::vector<std::uint8_t>> chosen,
                                double twice) {
    HourlyStates out;
    out.twice = twice;
    const std::size_t groups = states.groups.size(), hours = chosen.empty() ? 0 : chosen.front().size();
    out.is_changed.assign(hours, 0);
    for (std::size_t k = 0; k < groups + states.scenes.size(); ++k) {
        StatePart& part = out.parts.emplace_back();
        part.group = k < groups ? k : 0;
        const std::size_t g = k < groups ? k : states.scenes[k - groups].group;
        for (std::size_t h = 0; h < hours; ++h) {
            const PaneState& state = states.groups[g].states[chosen[g][h]];
            const bool is_here = k < groups ? !state.scene : state.scene == k - groups;
            const double factor = is_here ? state.factor : 0;
            part.weights.push_back(static_cast<float>(k < groups ? factor - 1 : factor));
            out.is_changed[h] |= chosen[g][h] > 0;
        }
    }
    out.state = std::move(chosen);
    return out;
}

}  // namespace exitance
