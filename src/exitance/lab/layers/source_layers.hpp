#pragma once

#include "exitance/lab/layers/light_layers.hpp"
#include "exitance/methods/extensions.hpp"

namespace exitance {

struct LayersReport {
    double error = 0;                   ///< Error of the sum of all layers, like DiscontinuityReport::error.
    std::size_t triangles = 0;          ///< Triangles of all meshes, including dark ones.
    std::size_t winged_edge_bytes = 0;  ///< Memory of the same meshes as winged-edge structures, bytes.
    bool interrupted = false;
};

/// Computes direct light as one compressed mesh per source: a discontinuity mesh with the curves and the light of that
/// source only. The 64 brightest sources get a mesh each, all others share one. The errors of sources are assumed to be
/// independent. The error of the sum is then measured at sample points; if it is too large, all meshes are made again
/// with a smaller error. O(sources x regions), plus the cost of the discontinuity meshes.
LightLayers make_light_layers(const Stage& stage, const DiscontinuityOptions& options, LayersReport& report,
                              const StopRequest& stop);

/// Like `make_light_layers`, in the form that the engine uses.
LayeredLight make_layered_light(const Stage& stage, const DiscontinuityOptions& options, const StopRequest& stop);

/// Memory of a mesh as a winged-edge structure with one value per node, bytes.
std::size_t winged_edge_bytes(const SixNodeMesh& mesh);

}  // namespace exitance
