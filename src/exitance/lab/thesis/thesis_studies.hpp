#pragma once

#include <span>
#include <string_view>

#include "exitance/lab/thesis/csv_text.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A study that adds rows of one scene to a table: rows under a header, starting with the scene's name.
struct SceneStudy {
    std::string_view name, header;
    void (*run)(const char* scene_name, const Scene& scene, CsvText& out);
};

/// Compares the thesis's meshes [Gatenby95] with ours, on the convex receiver with the most curves.
///
/// triangulation  triangles, shapes and error of three schemes over a DM-tree and of Delaunay's triangulation, for
///                eight thresholds
/// premesh        faces, construction edges and shapes of a DM-tree, by the order of its curves, and after coarse grids
/// layers         bytes of forms of a layer, and one mesh per source against one for all, at the threshold 0.01
std::span<const SceneStudy> thesis_mesh_studies();

/// Compares the thesis's structures for visibility [Gatenby95] with ours.
///
/// candidates     share of the polygons that may hide the source: of BSP nodes by front-to-back orderings, all polygons
///                and only those that face the source; of the same fragments, and of points on them, by shafts
/// volumes        polygons that survive shadow volumes (chains of SVBSP planes) and shafts, for pairs of a source and a
///                polygon; plane tests, microseconds
/// rays           10^6 rays through the BSP tree and through Embree: rays per second, and the number of equal hits
std::span<const SceneStudy> thesis_visibility_studies();

}  // namespace exitance
