#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/io/scenes/textures/texture_mean.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Pictures on a scene's surfaces, as its file has them.
struct SceneTextures {
    struct Picture {
        std::vector<std::uint8_t> file;  ///< PNG or JPEG.
        std::string kind;                ///< "image/png" or "image/jpeg"
        TexturePixels pixels;
    };
    /// The base colour of a material.
    struct Coat {
        int picture = -1;                    ///< Index into `pictures`; -1: none.
        int set = 0;                         ///< Which of the places.
        int wrap_s = 10497, wrap_t = 10497;  ///< How places go beyond the picture's borders: glTF's numbers.
        MaterialId whole;                    ///< The material that reflects like the mean of all of the picture.
    };
    std::vector<Picture> pictures;
    Field<MaterialId, Coat> coats;
    /// Two sets of places in pictures, of every corner of every face (Surface::first_corner on); (0, 0) is the upper
    /// left of a picture. The second one is empty where the file has none.
    std::vector<Vec2> places[2];

    bool has_second_set() const { return !places[1].empty(); }
};

/// Reads textures and texture coordinates out of the file that a scene came from, if that is glTF and still there; its
/// triangles are found among the scene's faces by where they lie. None where there are no texture coordinates. O(n log
/// n).
/// path  of the file, see find_scene_file
std::optional<SceneTextures> load_scene_textures(const Scene& scene, const std::string& path);

/// Where a scene's file is now: where it was when the scene was read, or beside another file (such as the solution);
/// empty where it is neither there nor here.
std::string find_scene_file(const Scene& scene, const std::string& beside);

}  // namespace exitance
