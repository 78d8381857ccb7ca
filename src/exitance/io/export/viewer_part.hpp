#pragma once

#include <cstdint>
#include <string>

#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// What the viewer's page draws: elements with irradiance at their corners.
enum class ViewerLayer : std::uint8_t {
    exported,  ///< The elements that `export` writes, with all light.
    method,    ///< The method's own, with reflected light.
    raw,       ///< The method's own as it knows them: reflected light in its own basis, direct light at their centres.
};

/// How many leaves one part of a layer holds at most: a page can draw the first before the last has come.
constexpr std::size_t viewer_part_leaves = 65536;

/// The layer of a name (exported, method, raw); false where there is none.
bool find_viewer_layer(const std::string& name, ViewerLayer& layer);

/// How many parts a layer has; at least one.
std::size_t viewer_part_count(const Solution& solution, ViewerLayer layer);

/// One part of a layer, little-endian: the letters EXV2, then the counts v of vertices and f of faces (uint32), then
/// positions (3 v float32, metres), irradiance (3 v float32, W/m^2; red, green, blue) and five uint32 a face:
///
///     shape     how many corners, which come one after the other among the vertices; 256 + 6: a quadratic triangle's
///               three corners and the middles of its edges 0-1, 1-2, 2-0
///     material  number, as of the facts
///     element   number
///     group     number, as of the facts; 2^32 - 1: none
///     labels    shadow class (0 lit, 1 penumbra, 2 umbra, 255 none) + 256 o0 + 256^2 o1 + 256^3 o2, the orders of
///               discontinuity (CurveOrder) along the first three edges; 255 none
///
/// Raw elements of a constant basis have one value each. There E = E_ind + (1 - c) E_dir with E_dir at the element's
/// centre; of another basis E_dir is taken at the corners, a thousandth of the way to the centre inside them.
/// `light` is needed for raw elements alone. O(leaves of the solution); raw: and exact direct light at each.
std::string viewer_part(const Solution& solution, ViewerLayer layer, std::size_t part,
                        const RadiosityFunction* light = nullptr);

/// The same without what does not change with the light: the letters EXL1, the count v, irradiance (3 v float32).
std::string viewer_part_light(const Solution& solution, ViewerLayer layer, std::size_t part,
                              const RadiosityFunction* light = nullptr);

/// Irradiance of raw elements at points; 0 off the surfaces.
std::vector<Spectrum> viewer_raw_at(const RadiosityFunction& light, std::span<const ProbePoint> points);

}  // namespace exitance
