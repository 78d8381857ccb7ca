#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/measure/glare/daylight_glare.hpp"
#include "exitance/methods/options/solve_request.hpp"
#include "exitance/methods/plan/forecast.hpp"
#include "exitance/reference/compare.hpp"
#include "exitance/view_factors/gray_exchange.hpp"
#include "exitance/view_factors/ray_check.hpp"
#include "exitance/view_factors/row_check.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

// JSON of the command line. Every function returns text without a line end. The names and the order of the keys are
// part of the program's interface.

/// Light groups and materials that the viewer's page can change: `groups [{name, factor}]`, `materials [{name,
/// reflectance}]`. Both lists are empty if the solution keeps no groups.
std::string light_groups_json(const LightGroups& groups, const Scene& scene);

/// `solve --dry-run --json`.
std::string forecast_json(const Forecast& forecast);

/// Options that affect the light, as a solution file records them. Threads and limits are not among them.
std::string options_json(const SolveRequest& request);

/// Adds to `options` (JSON) those options for reading the scene that were given: length_unit (metres), up, lod,
/// turn_bodies, texture_parts.
std::string with_scene_options(const std::string& options, const LoadOptions& load);

/// Names and JSON values of the options that a checkpoint depends on: the recorded options and the memory limit.
std::vector<std::pair<std::string, std::string>> option_facts(const SolveRequest& request);

/// `check --json`.
std::string check_json(const CheckedScene& checked);

/// `compare --json`.
std::string error_json(const ErrorMeasure& error);

/// Facts about the operator that `viewfactors --operator` writes.
struct OperatorFacts {
    std::size_t entries = 0, node_entries = 0;
    double row_error = 0, closure_defect = 0;
    double product_seconds = 0;  ///< Time of one product F x, seconds of wall time.
};

/// Facts about a matrix of view factors, for `viewfactors --json` and its summary.
struct ViewFactorFacts {
    std::size_t surfaces = 0;
    double seconds = 0;
    bool has_defects = true;  ///< False after a stop: the defects, which need all rows, were not computed.
    double reciprocity_defect = 0;
    double closure_defect = 0;
    double min_row_sum = HUGE_VAL, max_row_sum = 0;
    std::size_t entries = 0, finished_rows = 0;
    double error = 0, smallest = 0;     ///< Options --error and --smallest.
    std::optional<double> tolerance;    ///< Option --tolerance; replaces `error`.
    double row_error = 0, dropped = 0;  ///< Largest value of all finished rows.
    std::size_t unclosed = 0;  ///< Number of rows whose closure defect exceeds the one that their variance explains.
    double entry_defect = 0;
    std::size_t mended = 0, unsettled = 0;
    RayCheck check;      ///< Check of entries, used with --tolerance.
    RowCheck row_check;  ///< Check of rows, used without --tolerance; of the operator if there is one.
    std::optional<OperatorFacts> transport;  ///< With --operator.
};

/// `heat --json`.
std::string heat_json(const GrayExchange& exchange);

/// `viewfactors --json`.
std::string view_factors_json(const ViewFactorFacts& facts);

/// `glare --json`: one entry per observer. `error`: relative error of the light, if known.
std::string glare_json(std::span<const Observer> observers, std::span<const DaylightGlare> glare,
                       std::optional<double> error);

/// JSON object of named numbers, for `daylight --json`.
/// Texts follow the numbers, each key with a list.
std::string values_json(const std::vector<std::pair<std::string, double>>& values,
                        const std::vector<std::pair<std::string, std::vector<std::string>>>& texts = {});

/// One line of `--progress json`; times in seconds.
std::string progress_json(std::string_view phase, double fraction, std::string_view detail, double elapsed,
                          std::optional<double> remaining);

}  // namespace exitance
