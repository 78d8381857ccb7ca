#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Thresholds of a discontinuity mesh, as shares of the requested error, of the total area or of the scene's size.
namespace mesh_limits {

/// Share of the total area on which the largest error may be exceeded. Smaller regions get contact curves only.
/// Derived from tables with 20,000 sample points: one in five has a point on so small an area.
constexpr double unfindable_area = 1e-5;
/// Limit in place of `unfindable_area` where there are so many emitters and regions that WeakLight pays off. Objects a
/// millimetre above hundreds of desks have penumbras about a millimetre wide; following all of them to 1e-5 would take
/// most of the triangles. Derived from the 1,000 sample points that measure the error: the area of one.
constexpr double unfindable_area_among_many = 1e-3;

/// Least light that gets curves, as a multiple of the largest permitted error T. Where light G falls to 0 across a
/// width w, elements of size h have cubic errors of about G (h/w)^3 / 10, so that an error of T is reached at h/w = (10
/// T/G)^(1/3). A bend 2 G/w^2 inside such an element causes an error of G (h/w)^2 / 8. That is below T if G is below 5
/// T: D2 curves are then useless. A bend bisected once, G (h/w)^2 / 32, is below T if G is below 300 T. A kink G/w
/// bisected twice, G h/(64 w), is below T if G is below 160 T. In buildings, blockers have countless edges and every
/// curve adds faces. These triangles are bisected because of their mean square error, even without curves, so weaker
/// light gets no curves there.
constexpr int min_bend = 5, min_kink_among_many = 160, min_bend_among_many = 300;  // see above
/// Least light that gets kink curves in other scenes, as a share of T: ten omitted sources cause an error of T at most.
constexpr double min_kink = 0.1;  // derived from ten sources, each with a tenth of T

/// Light of all omitted sources together, as a share of the requested errors.
constexpr double unseen_light = 0.02;  // derived from the error that omitting this light adds: at most 2%
/// RMS noise of light that is sampled by rays, as a share of the requested errors: independent noise of half an error
/// raises it by an eighth at most.
constexpr double ray_noise = 0.5;

/// Share of the total area. Larger triangles (at most 1,000) are tested at extra nodes even if they seem flat, since
/// their six nodes may miss a shadow between them.
constexpr double tried_area = 1e-3;  // derived from the 1,000 sample points that measure the error, one per triangle

/// Share of the scene's size. Triangles without a longer edge are not bisected, and light at nodes on borders is
/// evaluated this far inside the region.
constexpr double shortest_edge = coplanar_share;
/// Share of the scene's size. Line trees merge points that are closer together than this.
constexpr double one_place = 1e-7;  // derived from shortest_edge: a tenth of it

}  // namespace mesh_limits
}  // namespace exitance
