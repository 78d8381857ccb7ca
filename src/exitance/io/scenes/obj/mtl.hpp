#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/io/scenes/textures/texture_area.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Pictures of a material; null if it has none or they cannot be read.
struct MtlPictures {
    std::shared_ptr<const TextureArea> reflectance, exitance;  ///< map_Kd, map_Ke
    std::shared_ptr<const TextureArea> coverage;               ///< map_d
};

/// Data of an MTL file beyond reflectance and exitance, by material name.
struct MtlExtras {
    /// Materials that become panes, with their transmissivity (see Pane): `d` below 1, or `Tf` with an `illum` for
    /// glass (4, 6, 7, 9). Such a material transmits (1 - d) Tf at normal incidence. If that is at most 0.5, the
    /// material is opaque instead.
    struct Glass {
        Spectrum transmissivity;
        std::string where;  ///< File and line of the material.
    };
    std::map<std::string, Glass> glass;
    std::map<std::string, MtlPictures> pictures;
    /// Keyed by path, so that each picture is read once.
    std::map<std::string, std::shared_ptr<const TextureArea>> read, read_coverage;
};

/// Reads the materials of an MTL text and appends them to `materials` in order. `Kd` is the reflectance in [0, 1), `Ke`
/// the emitted radiance in W/(m^2 sr): one number for all bands, three, or one per band. `map_Kd` and `map_Ke` multiply
/// them (1 if there is no Kd) by the means of pictures, whose paths are relative to the file (PNG or JPEG, sRGB);
/// `map_d` makes holes where it is below 0.5. If a name occurs again, its first definition is used. Other keys are
/// ignored. Errors are added to `findings` with their line; the value concerned is 0.
void parse_mtl(std::string_view text, const std::string& file, std::vector<Material>& materials,
               std::vector<Finding>& findings, MtlExtras& extras);

}  // namespace exitance
