#include "exitance/view_factors.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/api/inside.hpp"
#include "exitance/io/view_factors/view_factor_file.hpp"
#include "exitance/view_factors/accuracy.hpp"
#include "exitance/view_factors/entry_factors.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance::api {
namespace {

/// The error of arrays that are not a sparse matrix; none if they are.
std::optional<Error> find_misfit(const ViewFactors& f) {
    const std::size_t n = f.areas.size();
    const auto is_absent_or = [n](const std::vector<double>& values) { return values.empty() || values.size() == n; };
    bool fits = f.emittances.size() == n && f.row_sums.size() == n && is_absent_or(f.row_errors) &&
                is_absent_or(f.sky) && is_absent_or(f.back) && (f.finished.empty() || f.finished.size() == n) &&
                f.starts.size() == n + 1 && f.columns.size() == f.values.size();
    fits = fits && f.starts.front() == 0 && f.starts.back() == f.values.size() &&
           std::is_sorted(f.starts.begin(), f.starts.end()) &&
           std::all_of(f.columns.begin(), f.columns.end(), [&](std::uint32_t j) { return j < n; });
    if (fits) return std::nullopt;
    return usage("the arrays do not form a sparse matrix", "view factors", "save the result of view_factors()");
}

}  // namespace

std::optional<Error> find_misuse(const Scene& scene, const ViewFactorOptions& options) {
    const auto is_within = [](double value, double least, double most) { return value >= least && value <= most; };
    const auto range = [](double least, double most) { return fmt::format("must be from {:g} to {:g}", least, most); };
    if (!is_within(options.error, min_row_error, max_row_error))
        return usage(range(min_row_error, max_row_error), "error");
    if (options.tolerance && !is_within(*options.tolerance, min_entry_error, max_entry_error))
        return usage(range(min_entry_error, max_entry_error), "tolerance");
    if (!(options.smallest >= 0 && options.smallest < 1)) return usage("must be from 0 to below 1", "smallest");
    if (options.time_limit && !(*options.time_limit > 0)) return usage("must be above 0 seconds", "time_limit");
    if (options.threads < 0) return usage("must be at least 0", "threads");
    if (!scene.data().scene->panes().empty())
        return usage("has clear glass, which stops some of the rays", "scene", "leave its panes out");
    return std::nullopt;
}

Result<ViewFactors> view_factors(const Scene& scene, const ViewFactorOptions& options, const Control& control) {
    return take_turn<ViewFactors>(control, [&](Run& run) -> Result<ViewFactors> {
        if (const std::optional<Error> misuse = find_misuse(scene, options)) return *misuse;
        const ThreadsOfCall threads(options.threads);
        run.limit_time(options.time_limit);
        const exitance::Scene& inside = *scene.data().scene;
        SparseFactors table;
        if (options.tolerance) {
            const EntryFactorOptions in{*options.tolerance, options.smallest, SIZE_MAX};
            table = compute_entry_factors(inside, in, nullptr, run.progress(), run.stop());
        } else {
            RowFactorOptions in;
            in.error = options.error, in.smallest = options.smallest, in.seed = options.seed;
            table = compute_row_factors(inside, in, nullptr, run.progress(), run.stop());
        }
        const auto finished = std::count(table.finished.begin(), table.finished.end(), 1);
        const bool is_complete = table.is_settled && static_cast<std::size_t>(finished) == table.size();
        if (!is_complete && finished == 0) return stopped("the computation of the first row of view factors");
        return ViewFactors{std::move(table.areas),
                           std::move(table.emittances),
                           std::move(table.starts),
                           std::move(table.columns),
                           std::move(table.values),
                           std::move(table.row_sums),
                           std::move(table.row_errors),
                           std::move(table.sky),
                           std::move(table.back),
                           std::move(table.finished),
                           is_complete};
    });
}

Result<void> save(const ViewFactors& factors, const std::string& path) {
    return take_turn<void>([&]() -> Result<void> {
        if (const std::optional<Error> misfit = find_misfit(factors)) return *misfit;
        SparseFactors table;
        table.areas = factors.areas, table.emittances = factors.emittances;
        table.starts = factors.starts, table.columns = factors.columns, table.values = factors.values;
        table.row_sums = factors.row_sums, table.row_errors = factors.row_errors;
        table.sky = factors.sky, table.back = factors.back, table.finished = factors.finished;
        if (table.finished.empty()) table.finished.assign(table.size(), 1);
        table.dropped.assign(table.size(), 0);
        table.combined = factors.is_complete && !table.row_errors.empty();
        return to_api(write_view_factors(path, table, exitance::StopRequest()));
    });
}

}  // namespace exitance::api
