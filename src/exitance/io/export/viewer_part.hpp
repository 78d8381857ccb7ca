#pragma once

#include <cstdint>
#include <string>

#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Layers that the viewer's page can draw: elements with irradiance at their corners.
enum class ViewerLayer : std::uint8_t {
    exported,  ///< The elements that `export` writes, with all light.
    method,    ///< The method's elements, with reflected light.
    raw,       ///< The method's elements without post-processing: reflected light in the method's basis, and direct
               ///< light at their centres.
};

/// Limit on the leaves per part of a layer, so that a page can draw the first part before it has the last.
constexpr std::size_t viewer_part_leaves = 65536;

/// Finds a layer by name (exported, method, raw); false if there is none.
bool find_viewer_layer(const std::string& name, ViewerLayer& layer);

/// Number of parts of a layer, at least 1.
std::size_t viewer_part_count(const Solution& solution, ViewerLayer layer);

/// Encodes one part of a layer, little-endian: the letters EXV2, the counts v of vertices and f of faces (uint32),
/// positions (3 v float32, metres), irradiance (3 v float32, W/m^2; red, green, blue), and five uint32 per face:
///
///     shape     number of corners, which are consecutive vertices; 256 + 6: the three corners of a quadratic triangle
///               and the middles of its edges 0-1, 1-2, 2-0
///     material  index into the materials of viewer_scene_json()
///     element   number
///     group     index into the groups of viewer_scene_json(); 2^32 - 1: none
///     labels    shadow class (0 lit, 1 penumbra, 2 umbra, 255 none) + 256 o0 + 256^2 o1 + 256^3 o2, the orders of
///               discontinuity (CurveOrder) along the first three edges; 255 none
///
/// Raw elements of a constant basis have one value each, E = E_ind + (1 - c) E_dir, where E_dir is evaluated at the
/// element's centre. For other bases, E_dir is evaluated near the corners, a thousandth of the way to the centre.
/// `light` is only needed for raw elements. O(leaves of the solution); for raw elements also exact direct light at each
/// point.
std::string viewer_part(const Solution& solution, ViewerLayer layer, std::size_t part,
                        const RadiosityFunction* light = nullptr);

/// Encodes only the irradiance of a part, which changes with the light: the letters EXL1, the count v, irradiance (3 v
/// float32).
std::string viewer_part_light(const Solution& solution, ViewerLayer layer, std::size_t part,
                              const RadiosityFunction* light = nullptr);

/// Irradiance of raw elements at points; 0 for points off the surfaces.
std::vector<Spectrum> viewer_raw_at(const RadiosityFunction& light, std::span<const ProbePoint> points);

}  // namespace exitance
