#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/io/files/table.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Growth of cells as Bohn showed it in 2002. The tables of pictures have the columns of `add_shape`.
struct CellGrowthTables {
    /// Columns: `scene`, `form` (classic, improved), `units` (requested), `cells` (of the shading network), `rays`
    /// (units of the kernel network), `error` (estimated, relative RMS of radiosity), `seconds`, `stopped_by`.
    Table results;
    Table growth;   ///< Pictures: shading network by its light, strongest units of the kernel network (classic).
    Table samples;  ///< Pictures: ends of the rays drawn last; red where they are near a unit with a large resource.
};

/// Solves a scene with growing cells for each number of units, in both forms, and draws the classic form.
void measure_cell_growth(const std::string& name, const Scene& scene, const std::vector<std::size_t>& units,
                         std::uint64_t seed, CellGrowthTables& out, const StopRequest& stop);

/// Growth in Flatland: the kernel 1 / ((x - y)^2 + 1) between two parallel lines, blocked where x <= y.
struct FlatlandGrowth {
    /// Columns: `weights`, `units`, `error` (relative L2), `near_step`: density of centres within a tenth of the step
    /// x = y, over the mean density.
    Table errors;
    Table centres;        ///< Pictures: centres and widths of units, by the delta rule.
    Table approximation;  ///< Pictures: the kernel, and the approximation that units learned by the delta rule.
};
FlatlandGrowth measure_flatland_growth(const std::vector<std::size_t>& units, std::uint64_t seed);

}  // namespace exitance
