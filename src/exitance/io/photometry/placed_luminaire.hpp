#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A luminaire in a scene: which, where, and how bright.
struct PlacedLuminaire {
    std::string path;                         ///< Of its photometric file.
    std::string group;                        ///< What it belongs to; empty: nothing.
    Point position;                           ///< Of the middle of its opening, metres.
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< Its axes (see Photometry), of length 1: it shines down along -z.
    double dimming = 1, maintenance = 1;
    std::optional<double> lumens;  ///< Of its lamps (of the luminaire, in absolute photometry) in place of the file's.
    std::string file;              ///< Where it is said,
    int line = 0;                  ///< for messages.
};

/// Turns a luminaire's axes: first by `rotation` degrees about the vertical, from +x towards +y, then by the shortest
/// way that brings its axis (-z) to `aim`, of length 1.
void aim(PlacedLuminaire& luminaire, const Normal& direction, double rotation);

/// Reads a table of luminaires: CSV with a header. Columns file, x, y, z (metres), and where wanted aim_x, aim_y,
/// aim_z (direction of the axis; default 0,0,-1), rotation (degrees, 0), dimming (0 to 1; 1), lumens,
/// maintenance_factor (0 to 1; 1), group. Files stand beside the table. Fields may stand in double quotes; # begins a
/// comment.
Result<std::vector<PlacedLuminaire>> load_luminaire_table(const std::string& path);

struct Photometry;

/// Adds one luminaire of photometry that is no file's, in the scene's own unit.
void add_luminaire(const Photometry& photometry, const PlacedLuminaire& luminaire, SceneDescription& scene);

/// Adds luminaires to a scene, their openings as faces that shine; each is a group of its own, "GROUP #3" or
/// "luminaire #3". They come last, so that of faces in one plane they are on top: an opening may lie in a ceiling.
/// photometric: whether the scene's light is in lumens; none: it is, unless something shines there in watts. In a scene
/// in watts 179 lm are a watt. What is wrong goes to `findings`.
void add_luminaires(const std::vector<PlacedLuminaire>& luminaires, std::optional<bool> photometric,
                    SceneDescription& scene, std::vector<Finding>& findings);

}  // namespace exitance
