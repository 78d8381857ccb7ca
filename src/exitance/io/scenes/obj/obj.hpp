#pragma once

#include <string>
#include <vector>

#include "exitance/io/photometry/placed_luminaire.hpp"
#include "exitance/io/scenes/scene_lines.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// What a scene file says, and what is wrong with how it says it. Faces that cannot be read are not in it.
struct ReadScene {
    SceneDescription description;
    std::vector<Finding> findings;
    std::vector<PlacedLuminaire> luminaires = {};
    SceneLines lines = {};  ///< Empty: all faces stand in the description's file.
    /// Repairs after which the scene has less light than its files mean; errors if nothing in the scene emits.
    std::vector<Finding> darkening = {};
    /// By material: the RMS deviation of reflectance over faces that show pictures (`TexturedFaces`); may be shorter.
    std::vector<Spectrum> reflectance_deviation = {};
    std::vector<std::string> glazed_by = {};  ///< What made faces panes: "material 'water' (glass.mtl:4)".
};

/// Reads Wavefront OBJ with its MTL files: faces with any number of corners, 'g' and 'o' names, 'usemtl', several
/// 'mtllib' (relative to the file), relative indices, indices of texture and normal (ignored), comments, continued
/// lines. Faces before any 'usemtl' get a grey material named 'default', with a warning. Every error is reported, with
/// file and line, not just the first. O(size of the file).
ReadScene read_obj(const std::string& path);

/// The same for a caller who needs it whole: the first error, or the description.
Result<SceneDescription> load_obj(const std::string& path);

}  // namespace exitance
