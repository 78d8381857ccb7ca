#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/io/scenes/textures/texture_area.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// The pictures of a material; none where it has none, or they cannot be read.
struct MtlPictures {
    std::shared_ptr<const TextureArea> reflectance, exitance;  ///< map_Kd, map_Ke
};

/// What else an MTL text says, by the names of materials.
struct MtlExtras {
    /// Materials that let light through, with the transmissivity of their panes (Pane): `d` below 1, or `Tf` with an
    /// `illum` for glass (4, 6, 7, 9). Of light that meets a pane at right angles (1 - d) Tf passes, more than a half;
    /// else the material is opaque.
    struct Glass {
        Spectrum transmissivity;
        std::string where;  ///< File and line of the material.
    };
    std::map<std::string, Glass> glass;
    std::map<std::string, MtlPictures> pictures;
    std::map<std::string, std::shared_ptr<const TextureArea>> read;  ///< By file: pictures are read once.
};

/// The materials of an MTL text in its order, appended to `materials`; what is wrong goes to `findings`, with the line,
/// and leaves the value at 0. `Kd` is the reflectance in [0, 1), `Ke` the emitted radiance in W/(m^2 sr): one number
/// for all bands, three, or one a band. `map_Kd` and `map_Ke` multiply them (1 if there is no Kd) by the means of
/// pictures beside the file (PNG or JPEG, sRGB). A name that is there already keeps its first meaning. Other keys are
/// ignored.
void parse_mtl(std::string_view text, const std::string& file, std::vector<Material>& materials,
               std::vector<Finding>& findings, MtlExtras& extras);

}  // namespace exitance
