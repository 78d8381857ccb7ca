#include "exitance/cli/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

std::string seconds_line(const RunSeconds& seconds) {
    constexpr double least = 0.0005;  // Parts that take less time than this are left out, s.
    std::string parts;
    RunSeconds::for_parts([&](RunPart part) {
        if (part == RunPart::total || seconds[part] < least) return;
        parts += fmt::format("{}{} {:.3g}", parts.empty() ? "" : ", ", RunSeconds::name(part), seconds[part]);
    });
    return fmt::format("{:.3g} s{}", seconds[RunPart::total], parts.empty() ? "" : " (" + parts + ")");
}

/// Area, mean radiosity and error of the four largest rooms.
std::string rooms_line(const std::vector<RoomError>& rooms, const LightUnit& unit) {
    constexpr std::size_t max_rooms = 4;
    std::string text;
    for (std::size_t i = 0; i < std::min(max_rooms, rooms.size()); ++i)
        text += fmt::format("{}{:.4g} m^2: {:.3g} {}, error {}", i > 0 ? "; " : "", rooms[i].area, rooms[i].mean,
                            unit.radiosity(), percent(rooms[i].error));
    return rooms.size() > max_rooms ? text + fmt::format("; and {} more", rooms.size() - max_rooms) : text;
}

/// The upper bound of the error, with the advice to use the estimate if the bound is more than twice as large.
std::string bound_line(const SolveStatistics& s) {
    constexpr double far_apart = 2;  // ratio of bound and estimate that needs an explanation
    const std::string bound = percent(*s.relative_error_bound) + " at most, with 95% confidence";
    if (*s.relative_error_bound <= far_apart * *s.relative_error_estimate) return bound;
    return bound +
           "; use the estimate: it follows the error through the scene, while the bound assumes that reflections "
           "amplify all of it as much as any light";
}

/// Whether the requested error was reached, and in which part it was not. The recorded options have no error if none
/// was requested.
std::string reached_line(const Solution& solution) {
    const SolveStatistics& s = solution.statistics;
    const bool is_requested = solution.options.find("\"error\":null") == std::string::npos;
    if (!s.is_stopped() && !is_requested) return "no error was requested";
    if (s.converged) return is_requested ? "yes" : "no error was requested";
    std::string why = s.is_stopped() ? fmt::format(", stopped by {}", name_of(s.stopped_by)) : "";
    // The whole may be accurate enough while a room is not.
    const double whole = s.relative_error_estimate.value_or(0), room = s.relative_error_estimate_worst_room.value_or(0);
    if (s.rooms.size() > 1 && room > whole) why += fmt::format("; {} in the worst room", percent(room));
    return "no" + why;
}

}  // namespace

std::string percent(double share) {
    return fmt::format("{:.3g}%", 100 * share);
}

std::string bytes(std::size_t count) {
    const std::array<const char*, 5> units{"B", "kB", "MB", "GB", "TB"};
    double value = static_cast<double>(count);
    std::size_t unit = 0;
    while (value >= 999.5 && unit + 1 < units.size()) value /= 1000, ++unit;
    return fmt::format("{:.3g} {}", value, units[unit]);
}

std::string summary(const Solution& solution) {
    const SolveStatistics& s = solution.statistics;
    const LightUnit unit = own_unit(solution.scene.is_photometric());
    std::string text;
    const auto line = [&](std::string_view name, const std::string& value) {
        text += fmt::format("{:<10} {}\n", name, value);
    };
    line("method", s.basis.empty() ? s.method : fmt::format("{}, {} basis", s.method, s.basis));
    const auto known = [](const std::optional<double>& error) { return error ? percent(*error) : "not known"; };
    line("error", s.relative_error_estimate
                      ? fmt::format("{} estimated (RMS of radiosity), {} in the exported mesh",
                                    percent(*s.relative_error_estimate), known(s.relative_error_estimate_interpolant))
                  : s.is_stopped() ? "not known: the run was stopped before its first estimate"
                                   : "not estimated");
    if (s.relative_error_estimate && s.relative_error_bound) line("bound", bound_line(s));
    if (s.bodies.size() > 1 && s.relative_error_estimate_worst_body)
        line("bodies", fmt::format("{} error in the worst of {}", percent(*s.relative_error_estimate_worst_body),
                                   s.bodies.size()));
    if (const auto predicted = s.figures.find("predicted_links"); predicted != s.figures.end())
        line("tasks", fmt::format("{}, {} stolen; {:.4g} links predicted", s.figures.at("tasks"),
                                  s.figures.at("stolen_tasks"), predicted->second));
    if (s.rooms.size() > 1) line("rooms", rooms_line(s.rooms, unit));
    line("reached", reached_line(solution));
    line("elements", fmt::format("{} ({} leaves) on {} surfaces", s.elements, s.leaf_elements, s.surfaces));
    line("transport", fmt::format("{} links ({}), {} form factors, {} rays", s.links, bytes(s.link_memory_bytes),
                                  s.form_factors, s.rays));
    if (!s.elements_by_level.empty()) {
        std::size_t all = 0;
        for (std::size_t count : s.elements_by_level) all += count;
        line("hierarchy", fmt::format("{} elements by level; {:.3g} bytes per link, {:.3g} per element",
                                      fmt::join(s.elements_by_level, " "),
                                      static_cast<double>(s.link_memory_bytes) / std::max<std::size_t>(1, s.links),
                                      static_cast<double>(s.element_memory_bytes) / all));
    }
    line("solution", fmt::format("{} iterations, residual {:.2g}", s.iterations, s.residual));
    if (s.standard_error > 0)
        line("noise", fmt::format("standard error {} of the method's light", percent(s.standard_error)));
    const std::string apart = percent(s.energy.defect);
    const std::string before = s.energy.defect_before ? percent(*s.energy.defect_before) : apart;
    line("energy",
         fmt::format("{:.6g} {} emitted, {:.6g} {} absorbed, {}{} apart{}", s.energy.emitted, unit.power(),
                     s.energy.absorbed, unit.power(),
                     s.energy.escaped > 0 ? fmt::format("{:.4g} {} escaped, ", s.energy.escaped, unit.power()) : "",
                     apart, before != apart ? fmt::format(" ({} before light was scaled)", before) : ""));
    line("time", fmt::format("{} on {} thread{}{}", seconds_line(s.seconds), s.threads, s.threads == 1 ? "" : "s",
                             s.processes > 1 ? fmt::format(" of {} processes each", s.processes) : std::string()));
    line("memory", bytes(s.peak_memory_bytes) + " at most");
    for (const std::string& warning : s.warnings) line("warning", warning);
    return text;
}

std::string summary(const Forecast& f) {
    const char* const about = f.is_at_least ? "at least" : "about";
    return fmt::format(
        "surfaces   {1} ({2} after joining coplanar neighbours), {3} emitters\n"
        "method     {4}\n"
        "elements   {0} {5} to solve on, {6} to gather on\n"
        "rays       {0} {7:.2g}\n"
        "time       {0} {8:.2g} s\n"
        "memory     {0} {9}\n",
        about, f.surfaces, f.regions, f.emitters, f.method, f.solve_elements, f.gather_elements, f.rays, f.seconds,
        bytes(static_cast<std::size_t>(f.memory_bytes)));
}

}  // namespace exitance
