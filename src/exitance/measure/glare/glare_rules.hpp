#pragma once

#include "exitance/base/vec.hpp"

namespace exitance {

/// Projected area of a source without extent, m^2: the glare of smaller sources depends only on their intensity
/// [CIE147].
inline constexpr double small_source_area = 0.005;

/// A direction d in the observer's coordinates: its components along the line of sight (R), to the side (T, 0 or more)
/// and above the line of sight (H, negative below it), in the unit of d. "Above" is in the plane of the line of sight
/// and the vertical; for a vertical line of sight it is towards +y.
struct SightOffsets {
    double ahead = 0, aside = 0, above = 0;
};
SightOffsets sight_offsets(const Normal& view, const Vec3& d);

/// Guth's position index of a source in direction d (any length, in front of the observer): 1 on the line of sight,
/// increasing with the distance from it. Above the line of sight it is
///
///     p = exp((35.2 - 0.31889 tau - 1.22 exp(-2 tau / 9)) 1e-3 sigma
///           + (21 + 0.26667 tau - 0.002963 tau^2) 1e-5 sigma^2),
///
/// where sigma is the angle to the line of sight and tau the angle of the plane of both to the vertical, degrees. Below
/// it, p = 1 + 0.8 r for r = tan sigma < 0.6, else 1 + 1.2 r. Source: [CIE117], [Iwata97].
double guth_position(const Normal& view, const Vec3& d);

/// Reason why a luminaire does not count in UGR. CIE 117 rates luminaires in the field of view for which Guth measured
/// position indices.
enum class GlareLimit {
    none,      ///< No reason: the luminaire counts.
    aside,     ///< Too far to the side: T / R (see SightOffsets) is above 3.
    overhead,  ///< H / R is beyond the end of Guth's table: hidden by the brow.
    level,     ///< The luminaire is seen at more than 85 degrees from its nadir: its light is nearly horizontal.
};

/// The limit of CIE 117 that excludes a luminaire with centre at `d` from the eye, in front of the observer.
/// `hangs_above`: true if the whole luminaire is above the height of the eye; only then does `level` apply.
GlareLimit glare_limit(const Normal& view, const Vec3& d, bool hangs_above);

/// Describes a limit, e.g. "aside: T/R is above 3".
const char* name_of(GlareLimit limit);

}  // namespace exitance
