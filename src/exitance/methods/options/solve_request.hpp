#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// The light that a solution file delivers.
enum class OutputLight : std::uint8_t { gathered, elements, smoothed_elements };

inline constexpr std::array<std::pair<OutputLight, std::string_view>, 3> output_light_names{{
    {OutputLight::gathered, "gathered"},
    {OutputLight::elements, "elements"},
    {OutputLight::smoothed_elements, "smoothed-elements"},
}};

/// Everything that the options in `solve_option_table()` set.
struct SolveRequest {
    SolveOptions options = {};
    std::optional<OutputLight> output_light = {};
    std::string recipe = {};               ///< Name of the recipe whose presets are included; empty: none.
    std::string importance = {};           ///< File with the points of options.importance; empty: none.
    std::string sky = {}, epw = {};        ///< Description of a sky, and a weather file for it; empty: none.
    std::optional<bool> photometric = {};  ///< Unit of the scene's light; empty: as the file says.
    bool light_groups = false;  ///< True if each group of emitters is also solved separately, and its light kept.
    std::optional<double> checkpoint_every = {};  ///< Seconds between checkpoints.
    bool resume = false;                          ///< Continue from the checkpoint of the same output.
    bool dry_run = false;                         ///< Print a forecast only.
    bool vtkhdf = true;                           ///< Write the mesh for ParaView into the solution, too.
    std::string trace = {};                       ///< File for the trace of parallel loops; empty: none.
    std::vector<std::string> warnings = {};       ///< Warnings about old names of options.
};

}  // namespace exitance
