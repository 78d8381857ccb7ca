#include <fmt/format.h>

#include <limits>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/border_points.hpp"
#include "exitance/cli/light_unit.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {
namespace {

/// Number of points that are evaluated together. It bounds the memory for long files.
constexpr std::size_t batch = 1 << 13;

std::vector<ProbePoint> zip(const ProbePoints& probes) {
    std::vector<ProbePoint> out;
    out.reserve(probes.size());
    for (std::size_t i = 0; i < probes.size(); ++i) out.push_back({probes.points[i], probes.normals[i]});
    return out;
}

/// Number of written rows, and whether they are those of all points.
struct WrittenRows {
    std::size_t count = 0;
    bool are_all = false;
};

Result<WrittenRows> write_light(const ProbeArguments& arguments, const RadiosityFunction& light, ProbeReader& reader,
                                ProbeWriter& writer, BorderPoints& borders, const StopRequest& stop) {
    ProbePoints probes;
    WrittenRows rows;
    for (;;) {
        if (const Result<void> read = reader.next(probes, batch); !read) return read.error();
        rows.are_all = probes.size() == 0;
        if (rows.are_all || stop.requested()) return rows;
        const std::vector<ProbePoint> points = zip(probes);
        const std::vector<Light> values =
            arguments.interpolant ? light.interpolant_at(points) : light.at_until(stop, points, arguments.component);
        for (std::size_t i = 0; i < values.size(); ++i) {
            borders.add(values[i].is_between_sides);
            writer.add(points[i].x, points[i].n, values[i].irradiance,
                       values[i].on_surface ? std::optional(values[i].radiosity) : std::nullopt,
                       values[i].standard_error);
        }
        rows.count += values.size();
        if (values.size() < points.size()) return rows;
    }
}

/// Traces paths instead of evaluating the solution. Reads all points first, since the random numbers of a point depend
/// on its index.
Result<WrittenRows> write_reference(const ProbeArguments& arguments, const Scene& scene, ProbeReader& reader,
                                    ProbeWriter& writer, BorderPoints& borders, Terminal& terminal,
                                    const StopRequest& stop) {
    ProbePoints probes;
    if (const Result<void> read = reader.next(probes, std::numeric_limits<std::size_t>::max()); !read)
        return read.error();
    const std::vector<ProbePoint> points = zip(probes);
    const std::vector<ReferenceLight> values =
        reference_light(scene, points, arguments.reference_paths, arguments.seed, terminal.progress(), stop);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const SurfaceId surface = values[i].surface;
        const Spectrum& E = values[i].irradiance;
        borders.add(values[i].is_between_sides);
        std::optional<Spectrum> B;
        if (!surface.is_none()) B = scene.material(surface).exitance + scene.material(surface).reflectance * E;
        writer.add(points[i].x, points[i].n, E, B, values[i].standard_error);
    }
    return WrittenRows{values.size(), values.size() == points.size()};
}

/// The error of options that would have no effect together; none if there is no error.
std::optional<Error> find_misuse(const ProbeArguments& a) {
    const bool is_part = a.component != Component::total;
    const auto usage = [](const char* where, const char* message) {
        return Error{ErrorCode::usage, message, where, "leave one of them out"};
    };
    if (a.reference_paths > 0 && a.interpolant)
        return usage("--interpolant", "cannot be combined with --reference, which does not evaluate the solution");
    if (a.reference_paths > 0 && is_part)
        return usage("--component", "cannot be combined with --reference, which computes all light");
    if (a.exact && (a.interpolant || a.reference_paths > 0))
        return usage("--exact", "cannot be combined with --interpolant or --reference, which evaluate no direct light");
    if (a.interpolant && is_part)
        return usage("--component", "cannot be combined with --interpolant, which evaluates all light");
    return std::nullopt;
}

}  // namespace

/// Runs `exitance probe SOLUTION --points POINTS -o LIGHT`.
ExitCode run(const ProbeArguments& arguments, Terminal& terminal) {
    if (const std::optional<Error> misuse = find_misuse(arguments)) return terminal.fail(*misuse);
    set_threads(arguments.threads);
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    Result<ProbeReader> reader = ProbeReader::open(arguments.points);
    if (!reader) return terminal.fail(reader.error());
    const bool by_paths = arguments.reference_paths > 0;
    const LightUnit unit = unit_of(arguments.unit, solution->scene, terminal);
    const bool told = unit.is_lux() || arguments.unit.choice != UnitChoice::scene;
    Result<ProbeWriter> writer = ProbeWriter::create(
        arguments.output, {.standard_errors = true, .unit = told ? std::optional(unit) : std::nullopt});
    if (!writer) return terminal.fail(writer.error());

    RunLimits& limits = terminal.limits();
    std::optional<RadiosityFunction> light;
    if (!by_paths) light.emplace(*solution, arguments.exact ? DirectBy::closed_forms : DirectBy::cheaper);
    const StopRequest& stop = limits.keep();
    BorderPoints borders;
    const Scene& scene = solution->scene;
    const Result<WrittenRows> rows = by_paths
                                         ? write_reference(arguments, scene, *reader, *writer, borders, terminal, stop)
                                         : write_light(arguments, *light, *reader, *writer, borders, stop);
    terminal.progress().finish();
    if (!rows) return terminal.fail(rows.error());
    if (!rows->are_all && rows->count == 0) return terminal.fail_stopped("no point was finished");
    if (const Result<void> written = writer->commit(); !written) return terminal.fail(written.error());
    borders.tell(terminal);
    if (rows->are_all) return ExitCode::done;
    terminal.note(fmt::format("stopped by the {}: the first {} points are finished", limits.reason(), rows->count));
    return limits.stopped_code();
}

}  // namespace exitance
