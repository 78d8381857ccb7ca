#include "exitance/io/solution/solution_groups.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>

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

void write_figure(Hdf5Writer& file, const std::string& group, const char* name, const std::optional<double>& value) {
    if (value) file.set_attribute(group, name, *value);
}
void write_figure(Hdf5Writer& file, const std::string& group, const char* name, const std::string& value) {
    file.set_attribute(group, name, std::string_view(value));
}
void write_figure(Hdf5Writer& file, const std::string& group, const char* name, StopReason value) {
    file.set_attribute(group, name, name_of(value));
}
void write_figure(Hdf5Writer& file, const std::string& group, const char* name, double value) {
    file.set_attribute(group, name, value);
}
void write_figure(Hdf5Writer& file, const std::string& group, const char* name, std::integral auto value) {
    file.set_attribute(group, name, static_cast<std::int64_t>(value));
}

/// Reads a figure. One that the file does not have keeps its value.
void read_figure(Hdf5Reader& file, const std::string& group, const char* name, std::optional<double>& value) {
    value = file.number_attribute(group, name);
}
void read_figure(Hdf5Reader& file, const std::string& group, const char* name, std::string& value) {
    value = file.text_attribute(group, name).value_or(value);
}
void read_figure(Hdf5Reader& file, const std::string& group, const char* name, StopReason& value) {
    value = stop_reason_of(file.text_attribute(group, name).value_or(""));
}
void read_figure(Hdf5Reader& file, const std::string& group, const char* name, double& value) {
    value = file.number_attribute(group, name).value_or(value);
}
template <std::integral T>
void read_figure(Hdf5Reader& file, const std::string& group, const char* name, T& value) {
    if (const auto whole = file.integer_attribute(group, name)) value = static_cast<T>(*whole);
}

void write_discontinuity(Hdf5Writer& file, const std::string& group, const DiscontinuityCounts& counts) {
    file.make_group(group);
    for_counts(counts, [&](const char* name, std::size_t count) { write_figure(file, group, name, count); });
    file.set_attribute(group, "mean_radius_ratio", counts.mean_radius_ratio);
}

DiscontinuityCounts read_discontinuity(Hdf5Reader& file, const std::string& group) {
    DiscontinuityCounts counts;
    for_counts(counts, [&](const char* name, std::size_t& count) {
        count = static_cast<std::size_t>(std::max<std::int64_t>(0, file.integer_attribute(group, name).value_or(0)));
    });
    counts.mean_radius_ratio = file.number_attribute(group, "mean_radius_ratio").value_or(0);
    return counts;
}

void write_levels(Hdf5Writer& file, const std::string& path, const std::vector<std::size_t>& elements_by_level) {
    const std::vector<std::int64_t> levels(elements_by_level.begin(), elements_by_level.end());
    file.write(path, levels, 1, {"1", "elements of a hierarchy by depth, roots first"});
}

std::vector<std::size_t> read_levels(Hdf5Reader& file, const std::string& path) {
    std::vector<std::size_t> out;
    for (const std::int64_t count : file.read<std::int64_t>(path))
        out.push_back(static_cast<std::size_t>(std::max<std::int64_t>(0, count)));
    return out;
}

void write_rooms(Hdf5Writer& file, const std::string& path, const std::string& references_path,
                 const std::vector<RoomError>& rooms) {
    std::vector<double> values, references;
    for (const RoomError& room : rooms) {
        values.insert(values.end(), {room.area, room.mean, room.error});
        references.push_back(room.reference);
    }
    file.write(path, values, 3, {"m^2, W/m^2, 1", "area, mean reflected radiosity and relative error of every room"});
    file.write(references_path, references, 1, {"W/m^2", "light that the error of every room is relative to"});
}

/// Reads the errors of rooms. Without references in the file, the means serve as references.
std::vector<RoomError> read_rooms(Hdf5Reader& file, const std::string& path, const std::string& references_path) {
    const std::vector<double> values = file.read<double>(path, 3);
    std::vector<RoomError> out;
    for (std::size_t i = 0; i + 2 < values.size(); i += 3)
        out.push_back({values[i], values[i + 1], values[i + 2], values[i + 1]});
    if (!file.has(references_path)) return out;
    const std::vector<double> references = file.read<double>(references_path);
    for (std::size_t i = 0; i < std::min(references.size(), out.size()); ++i) out[i].reference = references[i];
    return out;
}

/// Returns a number of a file as a count, at most `limit`; 0 for a number that is none.
std::size_t count_of(double value, double limit) {
    return static_cast<std::size_t>(std::isfinite(value) ? std::clamp(value, 0.0, limit) : 0);
}

void write_bodies(Hdf5Writer& file, const std::string& path, const std::vector<BodyError>& bodies) {
    std::vector<double> values;
    for (const BodyError& b : bodies)
        values.insert(values.end(), {static_cast<double>(b.surfaces), b.area, b.mean, b.error.value_or(std::nan("")),
                                     static_cast<double>(b.points), static_cast<double>(b.first.value)});
    file.write(path, values, 6,
               {"1, m^2, W/m^2, 1, 1, 1",
                "faces, area, mean reflected radiosity, relative error (NaN: not known), points and first face of "
                "every body"});
}

std::vector<BodyError> read_bodies(Hdf5Reader& file, const std::string& path) {
    constexpr double max_count = 4e9;  // derived from ids of faces, which have 32 bits
    const std::vector<double> values = file.read<double>(path, 6);
    std::vector<BodyError> out;
    for (std::size_t i = 0; i + 5 < values.size(); i += 6) {
        BodyError body{count_of(values[i], max_count),
                       values[i + 1],
                       values[i + 2],
                       {},
                       count_of(values[i + 4], max_count),
                       SurfaceId(count_of(values[i + 5], max_count))};
        if (std::isfinite(values[i + 3])) body.error = values[i + 3];
        out.push_back(body);
    }
    return out;
}

void write_surface_errors(Hdf5Writer& file, const std::string& path, const std::vector<FaceError>& errors) {
    std::vector<double> values;
    for (const FaceError& e : errors) values.insert(values.end(), {e.error, static_cast<double>(e.points)});
    file.write(path, values, 2,
               {"1, 1", "relative error of every face, and points it was measured at; 0: that of its room"});
}

std::vector<FaceError> read_surface_errors(Hdf5Reader& file, const std::string& path) {
    constexpr double max_points = 1e15;  // derived from the integers that a double holds exactly
    const std::vector<double> values = file.read<double>(path, 2);
    std::vector<FaceError> out;
    for (std::size_t i = 0; i + 1 < values.size(); i += 2)
        out.push_back({values[i], count_of(values[i + 1], max_points)});
    return out;
}

}  // namespace

void write_statistics(Hdf5Writer& file, const std::string& group, const SolveStatistics& statistics,
                      const LightUnit& own) {
    file.make_group(group);
    for_figures(statistics, [&](const char* name, const auto& value) { write_figure(file, group, name, value); });
    if (statistics.discontinuity) write_discontinuity(file, group + "/discontinuity", *statistics.discontinuity);
    file.set_attribute(group, energy_unit, std::string_view(own.power()));
    file.make_group(group + "/seconds");
    RunSeconds::for_parts([&](RunPart part) {
        if (const double seconds = statistics.seconds[part]; seconds > 0)
            file.set_attribute(group + "/seconds", RunSeconds::name(part), seconds);
    });
    file.make_group(group + "/figures");
    for (const auto& [name, value] : statistics.figures) file.set_attribute(group + "/figures", name.c_str(), value);
    if (!statistics.elements_by_level.empty())
        write_levels(file, group + "/elements_by_level", statistics.elements_by_level);
    if (!statistics.rooms.empty()) write_rooms(file, group + "/rooms", group + "/room_references", statistics.rooms);
    if (!statistics.bodies.empty()) write_bodies(file, group + "/bodies", statistics.bodies);
    if (!statistics.surface_errors.empty())
        write_surface_errors(file, group + "/surface_errors", statistics.surface_errors);
    file.write_texts(group + "/warnings", statistics.warnings, {"1", "what the user should know"});
}

SolveStatistics read_statistics(Hdf5Reader& file, const std::string& group) {
    SolveStatistics statistics;
    for_figures(statistics, [&](const char* name, auto& value) { read_figure(file, group, name, value); });
    if (!file.text_attribute(group, energy_unit))
        for (double* sum : {&statistics.energy.emitted, &statistics.energy.absorbed, &statistics.energy.escaped})
            *sum /= static_cast<double>(bands);  // files without this attribute store the sum over the bands
    if (const std::string at = group + "/discontinuity"; file.has(at))
        statistics.discontinuity = read_discontinuity(file, at);
    RunSeconds::for_parts([&](RunPart part) {
        statistics.seconds[part] = file.number_attribute(group + "/seconds", RunSeconds::name(part)).value_or(0);
    });
    if (const std::string at = group + "/figures"; file.has(at))
        for (const std::string& name : file.attribute_names(at))
            if (const auto value = file.number_attribute(at, name.c_str())) statistics.figures[name] = *value;
    if (const std::string at = group + "/elements_by_level"; file.has(at))
        statistics.elements_by_level = read_levels(file, at);
    if (const std::string at = group + "/rooms"; file.has(at))
        statistics.rooms = read_rooms(file, at, group + "/room_references");
    if (const std::string at = group + "/bodies"; file.has(at)) statistics.bodies = read_bodies(file, at);
    if (const std::string at = group + "/surface_errors"; file.has(at))
        statistics.surface_errors = read_surface_errors(file, at);
    statistics.warnings = file.read_texts(group + "/warnings");
    return statistics;
}

}  // namespace exitance
