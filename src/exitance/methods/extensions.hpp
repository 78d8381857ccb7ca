#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/discontinuity/discontinuity_mesh.hpp"
#include "exitance/methods/method_entry.hpp"

namespace exitance {

/// Direct light as the sum of one mesh per source.
struct LayeredLight {
    LightFormPointer form;
    DiscontinuityReport report = {};             ///< Error of the sum; sums of numbers and times over the meshes.
    std::map<std::string, double> figures = {};  ///< Numbers for the statistics, by their JSON keys.
};

/// Receives the layers of the sources so far, after each source.
using ShowLayers = std::function<void(const LightFormPointer& layers)>;

/// Ways of discontinuity meshing beyond the engine's own.
struct DiscontinuityExtension {
    /// Sets the cutter and the blocker search that the options select.
    void (*choose)(const DiscontinuityChoice& choice, DiscontinuityOptions& options);
    /// Makes the layers. They record the options of the single mesh (`solve`). `show` may be empty.
    LayeredLight (*make_layers)(const Stage& stage, const DiscontinuityOptions& options, const SolveOptions& solve,
                                const ShowLayers& show, const StopRequest& stop);
    /// Numbers for the statistics of the same light as a single mesh, by their JSON keys.
    std::map<std::string, double> (*figures)(const SixNodeMesh& mesh);
};

/// Methods and functions that a program adds to the engine. The engine includes none of them; the program, which links
/// both, fills in this struct.
struct Extensions {
    std::vector<MethodEntry> methods;
    const DiscontinuityExtension* discontinuity = nullptr;
};

/// The extensions of this program. To be filled in before the first solve.
Extensions& extensions();

/// An Error of usage where options select something that neither the engine nor the extensions have.
Result<void> check_extensions(const SolveOptions& options);

}  // namespace exitance
