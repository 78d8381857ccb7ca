#pragma once

namespace exitance {

/// Lower limit of a divisor that may be 0. Derived from the smallest normal double, 2e-308: quotients of numbers up to
/// 1e8 stay finite.
inline constexpr double min_divisor = 1e-300;

/// Lower limit of the length of a cross product before a division by it. Derived from the smallest normal double,
/// 2e-308: far below any length that is not 0, so that the quotient of a product of length 0 is 0.
inline constexpr double min_length_of_product = 1e-200;

// Sines of angles that rounding may cause. A rounding is the spacing of double precision, 2.2e-16.

/// Sine that one or two operations may cause: 45 roundings.
inline constexpr double rounded_sine = 1e-14;
/// Sine of an angle at which an edge or a pane counts as seen edge-on: 450 roundings.
inline constexpr double edge_on_sine = 1e-13;
/// Sine of an angle that counts as zero in tests of alignment, of three points or of a plane and a point: 4,500
/// roundings, since scenes have many aligned edges.
inline constexpr double zero_sine = 1e-12;

}  // namespace exitance
