#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/io/photometry/placed_luminaire.hpp"
#include "exitance/io/scenes/scene_lines.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Names by which the panes of a scene file are chosen.
struct PaneLabel {
    std::string material, object;
};

/// Content of a scene file and the faults found in it. Unreadable faces are not included.
struct ReadScene {
    SceneDescription description;
    std::vector<Finding> findings;
    std::vector<PlacedLuminaire> luminaires = {};
    SceneLines lines = {};  ///< Files and lines of the faces; empty: all are in the description's file.
    /// Repairs that remove light from the scene; errors if nothing in the scene emits.
    std::vector<Finding> darkening = {};
    /// Per material: RMS deviation of reflectance over textured faces (see `TexturedFaces`); may be shorter.
    std::vector<Spectrum> reflectance_deviation = {};
    Point origin = {};                        ///< Subtracted from the file's coordinates, metres.
    std::vector<std::string> glazed_by = {};  ///< Materials that became panes: "material 'water' (glass.mtl:4)".
    std::vector<PaneLabel> pane_labels = {};  ///< Labels of the panes of the description.
};

/// Returns an empty scene whose only finding is that its file cannot be read.
inline ReadScene unreadable_scene(const std::string& path, std::string message, std::string hint = "") {
    ReadScene out;
    out.description.file = path;
    out.findings.push_back({Finding::Kind::error, path, 0, std::move(message), std::move(hint)});
    return out;
}

/// Reads Wavefront OBJ with its MTL files: faces with any number of corners, 'g' and 'o' names, 'usemtl', several
/// 'mtllib' (relative to the file), relative indices, texture coordinates, comments and continued lines; normal indices
/// are ignored. Faces before the first 'usemtl' get a grey material named 'default', with a warning. All errors are
/// reported, with file and line. O(size of the file).
/// texture_parts  see `TexturedFaces`
ReadScene read_obj(const std::string& path, std::optional<std::size_t> texture_parts = {});

/// A face of an OBJ file with its texture coordinates and normals.
struct ObjPlaces {
    int line = 0;
    std::vector<Point> corners;  ///< Corners in the file's coordinates.
    std::vector<Vec2> places;    ///< One per corner, (0, 0) at the picture's upper left; empty if there are none.
    std::vector<Vec3> normals;   ///< Normal of each corner, of any length; empty if there are none.
};

/// Reads the readable faces of an OBJ file with their texture coordinates and normals, in the order of the file. Error
/// (cannot_read): the file cannot be read.
Result<std::vector<ObjPlaces>> read_obj_places(const std::string& path);

}  // namespace exitance
