#include "exitance/what_if/daylight/lm83.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace exitance {
namespace {

constexpr double max_spacing = 0.61;        ///< Metres: 2 ft [LM83].
constexpr std::size_t hours_a_year = 8760;  ///< derived from 365 days of 24 hours
constexpr double autonomy_target = 300;     ///< lx [LM83]

using Cell = std::array<std::int64_t, 3>;

/// Numbers of the points in cells of the largest spacing.
std::map<Cell, std::vector<std::size_t>> in_cells(std::span<const ProbePoint> points) {
    std::map<Cell, std::vector<std::size_t>> out;
    const auto cell = [](double v) { return static_cast<std::int64_t>(std::floor(v / max_spacing)); };
    for (std::size_t i = 0; i < points.size(); ++i)
        out[{cell(points[i].x.x), cell(points[i].x.y), cell(points[i].x.z)}].push_back(i);
    return out;
}

/// Counts the points without another one within the largest spacing.
std::size_t count_distant(std::span<const ProbePoint> points) {
    const std::map<Cell, std::vector<std::size_t>> cells = in_cells(points);
    const auto has_near = [&](const Cell& of, std::size_t i) {
        for (int k = 0; k < 27; ++k) {
            const auto found = cells.find({of[0] + k % 3 - 1, of[1] + k / 3 % 3 - 1, of[2] + k / 9 - 1});
            if (found != cells.end() && std::any_of(found->second.begin(), found->second.end(), [&](std::size_t j) {
                    return j != i && norm(points[j].x - points[i].x) <= max_spacing;
                }))
                return true;
        }
        return false;
    };
    std::size_t count = 0;
    for (const auto& [cell, inside] : cells)
        for (const std::size_t i : inside) count += !has_near(cell, i);
    return count;
}

/// Returns the deviations that sDA and ASE have in common.
std::vector<std::string> common_deviations(const DaylightTask& task, bool is_computed) {
    std::vector<std::string> out;
    if (task.hours.size() < hours_a_year) out.emplace_back("the weather is not that of a whole year");
    for (std::size_t h = 0; h < task.hours.size(); ++h)
        if (task.criteria.is_occupied(task.hours[h], h) != is_working_hour(task.hours[h].hour)) {
            out.emplace_back("the occupied hours are not 8 to 18 h of every day");
            break;
        }
    if (const std::size_t distant = count_distant(task.sensors); distant > 0)
        out.push_back(fmt::format("{} of {} sensors have no other sensor within {:g} m", distant, task.sensors.size(),
                                  max_spacing));
    if (!is_computed) out.emplace_back("the coefficients of another program have no direct sunlight");
    return out;
}

std::vector<std::string> deviations_of_blinds(const DaylightStates* states) {
    if (!states) return {"blinds are not operated"};
    std::vector<std::string> out;
    if (!states->has_all_panes) out.emplace_back("some panes belong to no group of blinds");
    for (const PaneGroup& group : states->groups)
        if (group.rule.kind != StateRule::Kind::sunlight)
            out.push_back(fmt::format("the blinds of group '{}' are not operated by direct sunlight", group.name));
    return out;
}

}  // namespace

Lm83Deviations lm83_deviations(const DaylightTask& task, bool is_computed) {
    Lm83Deviations out;
    out.exposure = out.autonomy = common_deviations(task, is_computed);
    if (task.criteria.target != autonomy_target)
        out.autonomy.push_back(
            fmt::format("the target is {:g} lx, not {:g} lx", task.criteria.target, autonomy_target));
    for (std::string& deviation : deviations_of_blinds(task.states)) out.autonomy.push_back(std::move(deviation));
    return out;
}

}  // namespace exitance
