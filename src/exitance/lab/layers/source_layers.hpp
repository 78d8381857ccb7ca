#pragma once

#include "exitance/lab/layers/light_layers.hpp"
#include "exitance/methods/extensions.hpp"

namespace exitance {

struct LayersReport {
    double error = 0;                   ///< Of the layers' sum, like DiscontinuityReport::error.
    std::size_t triangles = 0;          ///< Of all meshes, dark ones too.
    std::size_t winged_edge_bytes = 0;  ///< Of the same meshes with winged edges.
    bool interrupted = false;
};

/// Direct light as one mesh a source, compressed: each is a discontinuity mesh of its own, with the curves and the
/// light of that source alone. The brightest sources have one each, what else shines has one together. Errors of
/// sources are taken to be independent of one another, until the sum is measured at places; then all are made again, if
/// need be. O(sources x regions), beside what a discontinuity mesh takes.
LightLayers make_light_layers(const Stage& stage, const DiscontinuityOptions& options, LayersReport& report,
                              const StopRequest& stop);

/// The same as the engine asks for it.
LayeredLight make_layered_light(const Stage& stage, const DiscontinuityOptions& options, const StopRequest& stop);

/// What a mesh takes with winged edges, bytes, with one value a node.
std::size_t winged_edge_bytes(const SixNodeMesh& mesh);

}  // namespace exitance
