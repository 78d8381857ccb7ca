#pragma once

#include <optional>
#include <span>
#include <string>

#include "exitance/progress.hpp"
#include "exitance/scene.hpp"

namespace exitance::api {

/// Options for reading scene files.
struct LoadOptions {
    bool strict = false;                     ///< Repairs and unknown materials are errors.
    std::optional<double> length_unit = {};  ///< Metres per unit of .obj, .stl, .ply and .vs3 files; none: 1.
    std::optional<bool> y_is_up = {};        ///< Upright axis of these files is Y; none: Z.
    std::string lod = {};                    ///< Level of detail to read from CityJSON files; empty: the highest.
    bool turn_bodies = false;                ///< Reverses the faces of closed bodies that are inside out.
    /// Limit on the parts into which textured faces are cut; none: 500 and one more for each four faces, 0: no face is
    /// cut.
    std::optional<std::size_t> texture_parts = {};
    std::string luminaires = {};           ///< Table (CSV) of luminaires to add; empty: none.
    std::string sky = {};                  ///< Light from outside, such as "overcast" or "perez,lat=47,lon=8,...".
    std::string epw = {};                  ///< Weather file with place and irradiances for `sky`; empty: none.
    std::optional<bool> photometric = {};  ///< Emission is in lumens; none: as the file says.
    /// Keeps the emitters of each group apart; solve() then also solves each group, for Solution::mix. It takes the
    /// time of all these solves.
    bool light_groups = false;
};

/// Reads the files of one scene (.obj, .gltf, .glb, .rad, .stl, .ply, .vs3, .hbjson and .json: Honeybee
/// models and CityJSON), checks and repairs it.
/// Errors: cannot_read, bad_input with file and line, usage for a wrong sky.
Result<Scene> load(std::span<const std::string> files, const LoadOptions& options = {}, const Control& control = {});

/// Reads one scene file, as above.
Result<Scene> load(const std::string& file, const LoadOptions& options = {}, const Control& control = {});

}  // namespace exitance::api
