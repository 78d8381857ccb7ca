#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/lab/classical/classical.hpp"
#include "exitance/methods/options/solve_request.hpp"
#include "exitance/methods/plan/forecast.hpp"
#include "exitance/reference/compare.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/view_factors/gray_exchange.hpp"
#include "exitance/view_factors/ray_check.hpp"
#include "exitance/view_factors/row_check.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// The one place where the program writes JSON. Every function returns text without a line end; the names and the
/// order of the keys are part of the program's interface.

/// What a report page holds of `stats --json`.
std::string statistics_json(const SolveStatistics& statistics, const LightUnit& own);

/// What the viewer's page can change: `groups [{name, factor}]`, `materials [{name, reflectance}]`; empty lists where
/// no groups are kept.
std::string light_groups_json(const LightGroups& groups, const Scene& scene);

/// `solve --json` and `stats --json`: the same, with what kind of mesh, links and direct light the solution has.
std::string statistics_json(const Solution& solution);

/// `solve --dry-run --json`.
std::string forecast_json(const Forecast& forecast);

/// The options that the light depends on, as a solution records them: neither threads nor limits.
std::string options_json(const SolveRequest& request);

/// Adds the options by which a scene was read, where they were given: length_unit (metres), up, turn_bodies.
std::string with_scene_options(const std::string& options, const LoadOptions& load);

/// Options of a published form, with what it reports.
std::string options_json(const SolveRequest& request, const ClassicalFacts& facts);

/// Names and JSON values of the options that a checkpoint depends on: the recorded ones and the memory limit.
std::vector<std::pair<std::string, std::string>> option_facts(const SolveRequest& request);

/// `check --json`.
std::string check_json(const CheckedScene& checked);

/// `compare --json`.
std::string error_json(const ErrorMeasure& error);

/// What `viewfactors` found out besides the matrix.
struct ViewFactorFacts {
    std::size_t surfaces = 0;
    double seconds = 0;
    double reciprocity_defect = 0;
    double closure_defect = 0;
    double least_row_sum = HUGE_VAL, most_row_sum = 0;
    std::size_t entries = 0, finished_rows = 0;
    double error = 0, smallest = 0;     ///< As requested.
    std::optional<double> tolerance;    ///< As requested, in place of the error of rows.
    double row_error = 0, dropped = 0;  ///< The largest of all finished rows.
    std::size_t unclosed = 0;           ///< Rows whose closure defect is not explained by their variance.
    double entry_defect = 0;
    std::size_t mended = 0, unsettled = 0;
    RayCheck check;      ///< Of entries, with a tolerance.
    RowCheck row_check;  ///< Of rows, without.
};

/// `heat --json`.
std::string heat_json(const GrayExchange& exchange);

/// `viewfactors --json`.
std::string view_factors_json(const ViewFactorFacts& facts);

/// Named numbers, such as `daylight --json` prints.
std::string values_json(const std::vector<std::pair<std::string, double>>& values);

/// One line of `--progress json`; times in seconds.
std::string progress_json(std::string_view phase, double fraction, std::string_view detail, double elapsed,
                          std::optional<double> remaining);

}  // namespace exitance
