#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// The materials of an MTL text in its order, appended to `materials`; what is wrong goes to `findings`, with the line,
/// and leaves the value at 0. `Kd` is the reflectance in [0, 1), `Ke` the emitted radiance in W/(m^2 sr): one number
/// for all bands, three, or one a band. `map_Kd` multiplies Kd (1 if there is none) by the mean of a picture beside the
/// file (PNG or JPEG, sRGB). A name that is there already keeps its first meaning.
/// glass  by the name of a material that lets light through, the transmissivity of its panes (Pane): `d` below 1, or
///        `Tf` with an `illum` for glass (4, 6, 7, 9). Of light that meets a pane at right angles (1 - d) Tf passes,
///        more than a half; else the material is opaque.
/// Other keys are ignored.
void parse_mtl(std::string_view text, const std::string& file, std::vector<Material>& materials,
               std::vector<Finding>& findings, std::map<std::string, Spectrum>* glass = nullptr);

}  // namespace exitance
