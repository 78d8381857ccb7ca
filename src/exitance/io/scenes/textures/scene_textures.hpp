#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/io/scenes/textures/texture_mean.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Textures of a scene, as in its file.
struct SceneTextures {
    struct Picture {
        std::vector<std::uint8_t> file;  ///< PNG or JPEG.
        std::string kind;                ///< "image/png" or "image/jpeg"
        TexturePixels pixels;
    };
    /// Base colour texture of a material.
    struct Coat {
        int picture = -1;                    ///< Index into `pictures`; -1: none.
        int set = 0;                         ///< Set of texture coordinates, 0 or 1.
        int wrap_s = 10497, wrap_t = 10497;  ///< glTF's wrap modes beyond the picture's borders.
        MaterialId whole;                    ///< Material with the mean reflectance of the whole picture.
    };
    std::vector<Picture> pictures;
    Field<MaterialId, Coat> coats;
    /// Two sets of texture coordinates, for every corner of every face (from Surface::first_corner on). (0, 0) is the
    /// upper left of a picture. The second set is empty if the file has none.
    std::vector<Vec2> places[2];

    bool has_second_set() const { return !places[1].empty(); }
};

/// Reads textures and texture coordinates from a scene's glTF file and matches its triangles with the scene's faces by
/// position. Empty if the file is not glTF, does not exist, or has no texture coordinates. O(n log n).
/// path  path of the file, see find_scene_file()
std::optional<SceneTextures> load_scene_textures(const Scene& scene, const std::string& path);

/// Returns the path of a scene's file: where it was when the scene was read, or in the folder of `beside` (such as the
/// solution file). Empty if neither exists.
std::string find_scene_file(const Scene& scene, const std::string& beside);

}  // namespace exitance
