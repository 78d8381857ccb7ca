#pragma once

namespace exitance {

/// What a discontinuity mesh may leave out, as shares of what is asked of it.
namespace mesh_limits {

/// Of all area: where the largest error may be missed, and in so small regions there are no curves but contacts.
constexpr double unfindable_area = 1e-5;  // given by tables of 20,000 places: one in five would have a place there
/// The same where emitters and regions are so many that WeakLight pays. What hovers a millimetre over hundreds of desks
/// has half-shadows as narrow, and to follow all of them to 1e-5 takes most of the triangles.
constexpr double unfindable_area_among_many = 1e-3;  // given by one place of a thousand, by which errors are told

/// Where light G falls to 0 across w, elements of size h have cubic errors of about G (h/w)^3 / 10, so that the error T
/// leaves h/w = (10 T/G)^(1/3); a bend 2 G/w^2 within one is off by G (h/w)^2 / 8. That is below T where G is below 5
/// T: there, D2 lines do no good. Bends bisected once, G (h/w)^2 / 32, and kinks G/w bisected twice, G h/(64 w), are
/// below T where G is below 300 T and 160 T. In buildings, where blockers' edges are countless and every line makes
/// faces of its own, the mean square has these triangles bisected in any case, and there are no lines for less.
constexpr int least_bend = 5, least_kink_among_many = 160, least_bend_among_many = 300;  // of the largest error T
/// Of T, elsewhere: light so weak that what is left out of ten sources is T at most.
constexpr double least_kink = 0.1;  // given by a tenth each

/// Of the errors asked for: sources that are left out change nothing that can be seen.
constexpr double unseen_light = 0.02;  // given by what it adds to an error at most, 2%
/// Of them, too: noise of half of one adds an eighth to it, where it is as large as it may be.
constexpr double ray_noise = 0.5;

/// Of all area: larger triangles, of which there are a thousand at most, are tried however flat they seem, since six
/// nodes see nothing of a shadow between them.
constexpr double tried_area = 1e-3;  // given by the places at which the mesh is held against exact light, a thousand

/// Of the scene's size: triangles are not bisected below it, and borders are seen from as far within.
constexpr double shortest_edge = 1e-6;  // given by what counts as one plane
/// Of the scene's size: places nearer than this are one to trees of lines.
constexpr double one_place = 1e-7;  // given by a tenth of that

}  // namespace mesh_limits
}  // namespace exitance
