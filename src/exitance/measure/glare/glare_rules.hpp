#pragma once

#include "exitance/base/vec.hpp"

namespace exitance {

/// Projected area of a source without extent, m^2: a source of less than that glares by its intensity alone [CIE147].
inline constexpr double small_source_area = 0.005;

/// A direction d as an observer sees it: its parts along the line of sight (R), to the side (T, 0 or more) and above
/// the line of sight (H, negative below it), in the unit of d. "Above" is where the plane of the line of sight and the
/// vertical says; of a vertical line of sight it is towards +y.
struct SightOffsets {
    double ahead = 0, aside = 0, above = 0;
};
SightOffsets sight_offsets(const Normal& view, const Vec3& d);

/// Guth's position index of a source in a direction d (any length, in front of the observer): 1 on the line of sight,
/// more the farther from it. Above the line of sight, sigma the angle to it and tau that of the plane of both from the
/// vertical, degrees,
///
///     p = exp((35.2 - 0.31889 tau - 1.22 exp(-2 tau / 9)) 1e-3 sigma
///           + (21 + 0.26667 tau - 0.002963 tau^2) 1e-5 sigma^2),
///
/// below it p = 1 + 0.8 r for r = tan sigma < 0.6, else 1 + 1.2 r. Source: [CIE117], [Iwata97].
double guth_position(const Normal& view, const Vec3& d);

/// Why a luminaire does not count in UGR. CIE 117 rates luminaires in the field of view, for which Guth measured
/// position indices.
enum class GlareLimit {
    none,      ///< It counts.
    aside,     ///< T / R is above 3: it is too far to the side.
    overhead,  ///< H / R is above the end of Guth's table: the brow hides it.
    level,     ///< It is seen from above 85 degrees from the nadir: its light goes nearly along the ceiling.
};

/// The limit of CIE 117 that leaves out a luminaire whose middle is at `d` from the eye, in front of the observer.
/// `hangs_above` says that all of the luminaire is above the height of the eye: `level` is for these alone.
GlareLimit glare_limit(const Normal& view, const Vec3& d, bool hangs_above);

/// The limit in words: "aside (T/R above 3)".
const char* name_of(GlareLimit limit);

}  // namespace exitance
