#pragma once

#include <optional>

#include "exitance/cli/options/arguments.hpp"
#include "exitance/io/view_factors/node_table.hpp"
#include "exitance/io/view_factors/view_factor_file.hpp"

namespace exitance {

/// Format of the output of `viewfactors`: the one of --format, otherwise the one that the output's ending selects.
FactorFormat format_of(const ViewFactorArguments& arguments);

/// Error (usage) if an option for the output does not apply to its format.
Result<void> check_output_options(const ViewFactorArguments& arguments);

/// Returns the nodes that --nodes selects, or for a .vs3 file the rows of View3D's result; empty: every face is a row.
/// Errors: those of read_node_table.
Result<std::optional<FactorNodes>> nodes_of(const ViewFactorArguments& arguments, const Scene& scene);

/// Returns the error of the table that --emissivity names, so that it is known before the view factors are computed.
Result<void> check_emissivities(const ViewFactorArguments& arguments, const Scene& scene,
                                const std::optional<FactorNodes>& nodes);

/// Merges the rows of faces into nodes, adds exchange factors if --emissivity is set, and writes the output.
/// scene_origin: subtracted from the coordinates of the scene's file, metres.
Result<void> write_factor_output(const ViewFactorArguments& arguments, const Scene& scene, const Point& scene_origin,
                                 const std::optional<FactorNodes>& nodes, SparseFactors table, const StopRequest& stop);

}  // namespace exitance
