#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/scenes/view3d.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Nodes of a thermal network: groups of faces whose view factors become one row and column.
struct FactorNodes {
    std::vector<std::uint32_t> row_of_face;  ///< Node of every face, or no_row for a face that only blocks.
    std::vector<std::string> names;
    std::vector<View3dMask> masks = {};  ///< See apply_masks().
};

/// Returns one node per group or material of the scene that has faces, in the order of their first faces.
FactorNodes nodes_by_group(const Scene& scene);
FactorNodes nodes_by_material(const Scene& scene);

/// Returns the rows of View3D's result for a scene of read_view3d(): its groups, without those that only block, and the
/// masks of its file `path`.
FactorNodes view3d_rows(const Scene& scene, const std::string& path);

/// Returns the table of nodes: the rows of faces are merged (merge_rows), and masks take their parts of their bases.
SparseFactors merge_nodes(const SparseFactors& table, const FactorNodes& nodes);

/// Accounts for masks in a table whose rows are those of View3D's result. The area of a base, which excludes its
/// covered parts, is extended to include them. The covered parts exchange heat with their masks only, F_mb = 1 and F_bm
/// = A_m / A_b, and no other row has a factor to a mask. Keeps reciprocity.
void apply_masks(SparseFactors& table, std::span<const View3dMask> masks);

/// Reads a CSV file with a header and the columns `face` (its number from 1 in the order of the scene file) and `node`
/// (any text). Nodes are in the order of their first lines. Faces without a line only block.
/// Errors: cannot_read; bad_input for other columns, a face that does not exist or has two nodes, and an empty name.
Result<FactorNodes> read_node_table(const std::string& path, std::size_t faces);

/// Names of faces for files of other programs: the name of a face's group, followed by a number if the group has
/// several faces.
std::vector<std::string> face_names(const Scene& scene);

}  // namespace exitance
