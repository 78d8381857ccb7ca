#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A luminaire in a scene: its photometric file, position, orientation and output.
struct PlacedLuminaire {
    std::string path;   ///< Path of the photometric file.
    std::string group;  ///< Name of the luminaire's group; empty: none.
    Point position;     ///< Centre of the luminaire's opening, metres.
    /// Axes of the luminaire (see Photometry), of length 1; it emits downwards along -z.
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    double dimming = 1, maintenance = 1;
    std::optional<double> lumens;  ///< Replaces the file's lamp flux (luminaire flux in absolute photometry), lm.
    std::string file;              ///< File that places the luminaire, for messages.
    int line = 0;                  ///< Line in that file.
};

/// Orients a luminaire: first rotates it by `rotation` degrees about the vertical, from +x towards +y, then by the
/// shortest rotation that takes its axis (-z) to the unit vector `direction`.
void aim(PlacedLuminaire& luminaire, const Normal& direction, double rotation);

/// Reads a table of luminaires: CSV with the columns file, x, y, z (metres) and, optionally, aim_x, aim_y, aim_z
/// (direction of the axis; default 0,0,-1), rotation (degrees; 0), dimming (0 to 1; 1), lumens, maintenance_factor (0
/// to 1; 1), group. Paths of files are relative to the table. Fields may be in double quotes; # begins a comment.
Result<std::vector<PlacedLuminaire>> load_luminaire_table(const std::string& path);

struct Photometry;

/// Adds a luminaire with `photometry` in place of its file, in the scene's unit of light.
void add_luminaire(const Photometry& photometry, const PlacedLuminaire& luminaire, SceneDescription& scene);

/// True if a face or a light without extent emits light. Files may define emitting materials that no face has.
bool emits_light(const SceneDescription& scene);

/// Adds luminaires to a scene, with their openings as emitting faces. Each becomes a group "GROUP #3" or "luminaire
/// #3". They are added last, so that they are on top of coplanar faces: an opening may be in the plane of a ceiling.
/// photometric  true if the scene's light is in lumens; empty: true unless something already emits in watts. In a scene
/// in watts, 179 lm count as 1 W.
/// findings     receives errors and warnings
void add_luminaires(const std::vector<PlacedLuminaire>& luminaires, std::optional<bool> photometric,
                    SceneDescription& scene, std::vector<Finding>& findings);

}  // namespace exitance
