#include <fmt/format.h>

#include <limits>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/border_points.hpp"
#include "exitance/cli/common_stop.hpp"
#include "exitance/cli/light_unit.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/processes/result_of_all.hpp"
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

/// Number of written rows, and whether there is a row for every point.
struct WrittenRows {
    std::size_t count = 0;
    bool are_all = false;
};

/// The files of a run, which only the first process opens.
class ProbeFiles {
  public:
    /// Opens the file of points and the output. Collective.
    Result<void> open(const ProbeArguments& arguments, const ProbeWriter::Columns& columns) {
        return by_first([&]() -> Result<void> {
            Result<ProbeReader> reader = ProbeReader::open(arguments.points);
            if (!reader) return reader.error();
            Result<ProbeWriter> writer = ProbeWriter::create(arguments.output, columns);
            if (!writer) return writer.error();
            reader_.emplace(std::move(*reader)), writer_.emplace(std::move(*writer));
            return {};
        });
    }
    /// Reads the next points, at most `most`; empty at the end of the file. Collective.
    Result<std::vector<ProbePoint>> next(std::size_t most) {
        std::vector<ProbePoint> points;
        const Result<void> read = by_first([&]() -> Result<void> {
            ProbePoints probes;
            if (Result<void> done = reader_->next(probes, most); !done) return done;
            points = zip(probes);
            return {};
        });
        if (!read) return read.error();
        return as_first_archived(
            std::move(points), [](auto& archive, std::vector<ProbePoint>& all) { archive(all); }, "points");
    }
    void add(const ProbePoint& point, const Spectrum& irradiance, const std::optional<Spectrum>& radiosity,
             const Spectrum& standard_error) {
        if (writer_) writer_->add(point.x, point.n, irradiance, radiosity, standard_error);
    }
    /// Completes the output. Collective.
    Result<void> commit() {
        return by_first([&] { return writer_->commit(); });
    }

  private:
    std::optional<ProbeReader> reader_;
    std::optional<ProbeWriter> writer_;
};

Result<WrittenRows> write_light(const ProbeArguments& arguments, const RadiosityFunction& light, ProbeFiles& files,
                                BorderPoints& borders, const StopRequest& stop) {
    WrittenRows rows;
    for (;;) {
        const Result<std::vector<ProbePoint>> points = files.next(batch);
        if (!points) return points.error();
        rows.are_all = points->empty();
        if (rows.are_all || stop.requested()) return rows;
        const std::vector<Light> values =
            arguments.interpolant ? light.interpolant_at(*points) : light.at_until(stop, *points, arguments.component);
        for (std::size_t i = 0; i < values.size(); ++i) {
            borders.add(values[i].is_between_sides);
            files.add((*points)[i], values[i].irradiance,
                      values[i].on_surface ? std::optional(values[i].radiosity) : std::nullopt,
                      values[i].standard_error);
        }
        rows.count += values.size();
        if (values.size() < points->size()) return rows;
    }
}

/// Traces paths instead of evaluating the solution. Reads all points first, since the random numbers of a point depend
/// on its index.
Result<WrittenRows> write_reference(const ProbeArguments& arguments, const Scene& scene, ProbeFiles& files,
                                    BorderPoints& borders, Terminal& terminal, const StopRequest& stop) {
    const Result<std::vector<ProbePoint>> points = files.next(std::numeric_limits<std::size_t>::max());
    if (!points) return points.error();
    const std::vector<ReferenceLight> values =
        reference_light(scene, *points, arguments.reference_paths, arguments.seed, terminal.progress(), stop);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const SurfaceId surface = values[i].surface;
        const Spectrum& E = values[i].irradiance;
        borders.add(values[i].is_between_sides);
        std::optional<Spectrum> B;
        if (!surface.is_none()) B = scene.material(surface).exitance + scene.material(surface).reflectance * E;
        files.add((*points)[i], E, B, values[i].standard_error);
    }
    return WrittenRows{values.size(), values.size() == points->size()};
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
    const Result<Solution> solution = all_or_none(load_solution(arguments.solution));
    if (!solution) return terminal.fail(solution.error());
    const bool by_paths = arguments.reference_paths > 0;
    const LightUnit unit = unit_of(arguments.unit, solution->scene, terminal);
    const bool told = unit.is_lux() || arguments.unit.choice != UnitChoice::scene;
    ProbeFiles files;
    const ProbeWriter::Columns columns{.standard_errors = true, .unit = told ? std::optional(unit) : std::nullopt};
    if (const Result<void> opened = files.open(arguments, columns); !opened) return terminal.fail(opened.error());

    std::optional<RadiosityFunction> light;
    if (!by_paths) light.emplace(*solution, arguments.exact ? DirectBy::closed_forms : DirectBy::cheaper);
    const CommonStop stop(terminal, terminal.limits().keep());
    BorderPoints borders;
    const Scene& scene = solution->scene;
    const Result<WrittenRows> rows = by_paths
                                         ? write_reference(arguments, scene, files, borders, terminal, stop.request())
                                         : write_light(arguments, *light, files, borders, stop.request());
    terminal.progress().finish();
    if (!rows) return terminal.fail(rows.error());
    if (!rows->are_all && rows->count == 0) return stop.fail("no point was finished");
    if (const Result<void> written = files.commit(); !written) return terminal.fail(written.error());
    borders.tell(terminal);
    if (rows->are_all) return ExitCode::done;
    terminal.note(
        fmt::format("stopped by the {}: the first {} points are finished", name_of(stop.reason()), rows->count));
    return stop.stopped_code();
}

}  // namespace exitance
