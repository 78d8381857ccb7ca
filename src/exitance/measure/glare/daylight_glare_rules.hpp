#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Position index of daylight glare for a source in direction d (any length, in front of the observer), at most 16. It
/// is Guth's index above the line of sight. Below it, the index of a source equals that of a source to the side of the
/// line of sight at the angle beta:
///
///     tan beta = tan sigma sqrt(1 + 0.3225 cos^2 tau)
///
/// with sigma and tau as for guth_position(). Both agree on the horizontal through the line of sight.
/// Source: [Iwata10], as in evalglare since version 3.02 [Wienold24].
double daylight_position(const Normal& view, const Vec3& d);

/// Luminance above which parts of the field of view belong to glare sources.
struct GlareThreshold {
    double value = 2000;       ///< cd/m^2, or a multiple of the mean luminance of the field of view.
    bool is_multiple = false;  ///< True for a multiple.

    double luminance(double mean) const { return is_multiple ? value * mean : value; }
};

/// A small part of the field of view with one luminance.
struct GlarePart {
    Normal towards;            ///< Direction from the eye to the middle of the part.
    double luminance = 0;      ///< cd/m^2
    double solid_angle = 0;    ///< sr
    std::uint32_t origin = 0;  ///< Number of the object that shines there; it gives sources their names.
};

/// A source of daylight glare: parts of the field of view above the threshold that belong together.
struct DaylightGlareSource {
    Normal towards;  ///< Direction from the eye to the source's centre: the mean of its parts, weighted by their light.
    double luminance = 0;      ///< Mean luminance, cd/m^2.
    double solid_angle = 0;    ///< sr
    double position = 1;       ///< daylight_position() of the source's centre.
    std::uint32_t origin = 0;  ///< The origin (see GlarePart) that contributes most of the light.
    double term() const { return luminance * luminance * solid_angle / (position * position); }
};

/// Luminance above which parts are a source of their own, such as the sun in a bright sky, cd/m^2 [Wienold24].
inline constexpr double peak_luminance = 50'000;

/// Solid angle of the sun's disc of 0.533 degrees, sr; derived from 2 pi (1 - cos 0.2665 degrees).
inline constexpr double sun_disc_solid_angle = 6.797e-5;

/// Largest step between parts of one source, radians [Wienold24].
inline constexpr double glare_joining_angle = 0.1;

/// Joins parts above the threshold to sources, in descending order of their term. Two parts belong to one source if a
/// chain of parts with steps of at most 0.1 rad connects them, as in evalglare (where the option -r is twice this
/// angle) [Wienold24]. Parts above `peak_luminance` form sources of their own. The result does not depend on the order
/// of the parts, except for rounding. O(parts x parts within a step).
std::vector<DaylightGlareSource> join_glare_parts(const Normal& view, std::span<const GlarePart> parts);

/// Factor for eyes with little light: below 1000 lx e^x / (1 + e^x), x = 0.024 E_v - 4; else 1. Source: [Wienold24].
double low_light_factor(double vertical_illuminance);

/// Daylight glare probability,
///
///     DGP = 5.87e-5 E_v + 0.0918 log10(1 + sum L^2 omega / (E_v^1.87 P^2)) + 0.16,
///
/// times low_light_factor(), at most 1; 0 in the dark. `terms`: the sum of L^2 omega / P^2 over the sources.
/// Source: [Wienold06], and the standard EN 17037. evalglare's 0.092 and 0.159 differ by less than 0.001.
double daylight_glare_probability(double vertical_illuminance, double terms);

/// Limits of DGP: glare is imperceptible below the first, perceptible, disturbing, and intolerable from the last on.
inline constexpr std::array<double, 3> glare_limits{0.35, 0.40, 0.45};

/// Describes a probability, e.g. "disturbing".
const char* glare_class(double probability);

}  // namespace exitance
