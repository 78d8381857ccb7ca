#include "exitance/io/solution/solution_groups.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

constexpr const char* energy_unit = "energy_unit";

/// Calls `visit` for every figure with its name in the file, for writing and for reading.
template <class Statistics, class Visit>
void for_figures(Statistics& s, const Visit& visit) {
    visit("method", s.method);
    visit("basis", s.basis);
    visit("schedule", s.schedule);
    visit("threads", s.threads);
    visit("processes", s.processes);
    visit("surfaces", s.surfaces);
    visit("elements", s.elements);
    visit("leaf_elements", s.leaf_elements);
    visit("links", s.links);
    visit("rays", s.rays);
    visit("form_factors", s.form_factors);
    visit("iterations", s.iterations);
    visit("refinement_steps", s.refinement_steps);
    visit("converged", s.converged);
    visit("residual", s.residual);
    visit("relative_error_estimate", s.relative_error_estimate);
    visit("relative_error_bound", s.relative_error_bound);
    visit("relative_error_estimate_interpolant", s.relative_error_estimate_interpolant);
    visit("relative_error_estimate_worst_room", s.relative_error_estimate_worst_room);
    visit("relative_error_estimate_worst_body", s.relative_error_estimate_worst_body);
    visit("error_p99", s.error_p99);
    visit("standard_error", s.standard_error);
    visit("energy_emitted", s.energy.emitted);
    visit("energy_absorbed", s.energy.absorbed);
    visit("energy_escaped", s.energy.escaped);
    visit("energy_defect", s.energy.defect);
    visit("energy_defect_before", s.energy.defect_before);
    visit("peak_memory_bytes", s.peak_memory_bytes);
    visit("link_memory_bytes", s.link_memory_bytes);
    visit("element_memory_bytes", s.element_memory_bytes);
    visit("stopped_by", s.stopped_by);
}

/// The figures of discontinuity meshing.
template <class Counts, class Visit>
void for_counts(Counts& c, const Visit& visit) {
    visit("curves_d0", c.d0);
    visit("curves_d1", c.d1);
    visit("curves_d2", c.d2);
    visit("curves_eee", c.eee);
    visit("curves_left_out", c.left_out);
    visit("wedges", c.wedges);
    visit("faces_lit", c.lit);
    visit("faces_penumbra", c.penumbra);
    visit("faces_umbra", c.umbra);
    visit("triangles", c.triangles);
}

}  // namespace

void write_statistics(Hdf5Writer& file, const std::string& group, const SolveStatistics& statistics,
                      const LightUnit& own) {
    file.make_group(group);
    for_figures(statistics, [&]<class T>(const char* name, const T& value) {
        if constexpr (std::is_same_v<T, std::optional<double>>) {
            if (value) file.set_attribute(group, name, *value);
        } else if constexpr (std::is_same_v<T, std::string>)
            file.set_attribute(group, name, std::string_view(value));
        else if constexpr (std::is_same_v<T, double>)
            file.set_attribute(group, name, value);
        else
            file.set_attribute(group, name, static_cast<std::int64_t>(value));
    });
    if (const auto& counts = statistics.discontinuity) {
        const std::string of_mesh = group + "/discontinuity";
        file.make_group(of_mesh);
        for_counts(*counts, [&](const char* name, std::size_t count) {
            file.set_attribute(of_mesh, name, static_cast<std::int64_t>(count));
        });
        file.set_attribute(of_mesh, "mean_radius_ratio", counts->mean_radius_ratio);
    }
    file.set_attribute(group, energy_unit, std::string_view(own.power()));
    file.make_group(group + "/seconds");
    RunSeconds::for_parts([&](RunPart part) {
        if (const double seconds = statistics.seconds[part]; seconds > 0)
            file.set_attribute(group + "/seconds", RunSeconds::name(part), seconds);
    });
    file.make_group(group + "/figures");
    for (const auto& [name, value] : statistics.figures) file.set_attribute(group + "/figures", name.c_str(), value);
    if (!statistics.elements_by_level.empty()) {
        const std::vector<std::int64_t> levels(statistics.elements_by_level.begin(),
                                               statistics.elements_by_level.end());
        file.write(group + "/elements_by_level", levels, 1, {"1", "elements of a hierarchy by depth, roots first"});
    }
    if (!statistics.rooms.empty()) {
        std::vector<double> rooms, references;
        for (const RoomError& room : statistics.rooms) {
            rooms.insert(rooms.end(), {room.area, room.mean, room.error});
            references.push_back(room.reference);
        }
        file.write(group + "/rooms", rooms, 3,
                   {"m^2, W/m^2, 1", "area, mean reflected radiosity and relative error of every room"});
        file.write(group + "/room_references", references, 1,
                   {"W/m^2", "light that the error of every room is relative to"});
    }
    if (!statistics.bodies.empty()) {
        std::vector<double> bodies;
        for (const BodyError& b : statistics.bodies)
            bodies.insert(bodies.end(),
                          {static_cast<double>(b.surfaces), b.area, b.mean, b.error.value_or(std::nan("")),
                           static_cast<double>(b.points), static_cast<double>(b.first.value)});
        file.write(group + "/bodies", bodies, 6,
                   {"1, m^2, W/m^2, 1, 1, 1",
                    "faces, area, mean reflected radiosity, relative error (NaN: not known), points and first face of "
                    "every body"});
    }
    if (!statistics.surface_errors.empty()) {
        std::vector<double> errors;
        for (const FaceError& e : statistics.surface_errors)
            errors.insert(errors.end(), {e.error, static_cast<double>(e.points)});
        file.write(group + "/surface_errors", errors, 2,
                   {"1, 1", "relative error of every face, and points it was measured at; 0: that of its room"});
    }
    file.write_texts(group + "/warnings", statistics.warnings, {"1", "what the user should know"});
}

SolveStatistics read_statistics(Hdf5Reader& file, const std::string& group) {
    SolveStatistics statistics;
    for_figures(statistics, [&]<class T>(const char* name, T& value) {  // a missing figure keeps its default
        if constexpr (std::is_same_v<T, std::optional<double>>)
            value = file.number_attribute(group, name);
        else if constexpr (std::is_same_v<T, std::string>)
            value = file.text_attribute(group, name).value_or(value);
        else if constexpr (std::is_same_v<T, double>)
            value = file.number_attribute(group, name).value_or(value);
        else if (const auto whole = file.integer_attribute(group, name))
            value = static_cast<T>(*whole);
    });
    if (!file.text_attribute(group, energy_unit))
        for (double* sum : {&statistics.energy.emitted, &statistics.energy.absorbed, &statistics.energy.escaped})
            *sum /= static_cast<double>(bands);  // files without this attribute store the sum over the bands
    if (const std::string of_mesh = group + "/discontinuity"; file.has(of_mesh)) {
        DiscontinuityCounts& counts = statistics.discontinuity.emplace();
        for_counts(counts, [&](const char* name, std::size_t& count) {
            count =
                static_cast<std::size_t>(std::max<std::int64_t>(0, file.integer_attribute(of_mesh, name).value_or(0)));
        });
        counts.mean_radius_ratio = file.number_attribute(of_mesh, "mean_radius_ratio").value_or(0);
    }
    RunSeconds::for_parts([&](RunPart part) {
        statistics.seconds[part] = file.number_attribute(group + "/seconds", RunSeconds::name(part)).value_or(0);
    });
    if (const std::string figures = group + "/figures"; file.has(figures))
        for (const std::string& name : file.attribute_names(figures))
            if (const auto value = file.number_attribute(figures, name.c_str())) statistics.figures[name] = *value;
    if (const std::string levels = group + "/elements_by_level"; file.has(levels))
        for (const std::int64_t count : file.read<std::int64_t>(levels))
            statistics.elements_by_level.push_back(static_cast<std::size_t>(std::max<std::int64_t>(0, count)));
    if (const std::string rooms = group + "/rooms"; file.has(rooms)) {
        const std::vector<double> values = file.read<double>(rooms, 3);
        // Without references in the file, the means serve as references.
        for (std::size_t i = 0; i + 2 < values.size(); i += 3)
            statistics.rooms.push_back({values[i], values[i + 1], values[i + 2], values[i + 1]});
        if (const std::string references = group + "/room_references"; file.has(references)) {
            const std::vector<double> given = file.read<double>(references);
            for (std::size_t i = 0; i < std::min(given.size(), statistics.rooms.size()); ++i)
                statistics.rooms[i].reference = given[i];
        }
    }
    if (const std::string bodies = group + "/bodies"; file.has(bodies)) {
        const std::vector<double> values = file.read<double>(bodies, 6);
        const auto count = [](double value) {
            return static_cast<std::size_t>(std::isfinite(value) ? std::clamp(value, 0.0, 4e9) : 0);
        };
        for (std::size_t i = 0; i + 5 < values.size(); i += 6) {
            BodyError body{count(values[i]),     values[i + 1],
                           values[i + 2],        {},
                           count(values[i + 4]), SurfaceId(count(values[i + 5]))};
            if (std::isfinite(values[i + 3])) body.error = values[i + 3];
            statistics.bodies.push_back(body);
        }
    }
    if (const std::string errors = group + "/surface_errors"; file.has(errors)) {
        const std::vector<double> values = file.read<double>(errors, 2);
        for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
            const double points = std::isfinite(values[i + 1]) ? std::clamp(values[i + 1], 0.0, 1e15) : 0;
            statistics.surface_errors.push_back({values[i], static_cast<std::size_t>(points)});
        }
    }
    statistics.warnings = file.read_texts(group + "/warnings");
    return statistics;
}

}  // namespace exitance
