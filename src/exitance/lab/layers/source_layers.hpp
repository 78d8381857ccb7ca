#pragma once

#include "exitance/methods/extensions.hpp"
#include "exitance/solution/layers/light_layers.hpp"

namespace exitance {

struct LayersReport : DiscontinuityReport {
    std::size_t triangles = 0;          ///< Triangles of all meshes, including dark ones.
    std::size_t winged_edge_bytes = 0;  ///< Memory of the same meshes as winged-edge structures, bytes.
};

/// Computes direct light as one compressed mesh per source: a discontinuity mesh with the curves and the light of that
/// source only. The 64 brightest sources get a mesh each, the others share one per light group. The errors of sources
/// are assumed to be independent. The error of the sum is then measured at sample points; if it is too large, all
/// meshes are made again with a smaller error. O(sources x regions), plus the cost of the discontinuity meshes.
/// report  error of the sum; sums of numbers and times over all meshes
/// show    receives the layers of the sources so far after each source of the first attempt; may be empty
LightLayers make_light_layers(const Stage& stage, const DiscontinuityOptions& options, LayersReport& report,
                              const StopRequest& stop, const ShowLayers& show = {});

/// Like `make_light_layers`, in the form that the engine uses. `solve`: options of the single mesh, which are recorded.
LayeredLight make_layered_light(const Stage& stage, const DiscontinuityOptions& options, const SolveOptions& solve,
                                const ShowLayers& show, const StopRequest& stop);

}  // namespace exitance
