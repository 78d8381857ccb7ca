#pragma once

#include "exitance/solution/solution.hpp"

namespace exitance {

/// Direct and reflected irradiance on plain elements, for a solution that holds its direct light in layers: the sum of
/// the layers, less the share of it that `indirect` contains, plus `indirect`. The elements are those of `indirect`
/// without fans. They are split while their total misfit exceeds the relative error of the layers, those with the
/// largest shares first. Their polynomials are least-squares fits, so they are not continuous.
///
/// The result depends on nothing else than `layers`, `indirect`, `direct_share`, the scene and the estimated error of
/// the exported mesh. Files therefore omit it. Same bits on any number of threads. O(elements x points x layers).
ElementFunction elements_of_layers(const Solution& solution);

}  // namespace exitance
