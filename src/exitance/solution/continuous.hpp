#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/mesh/contact_lines.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Returns the least-squares approximation of `f` by functions that are continuous except at discontinuities of the
/// light, on a mesh made conforming. In every plane, and in every part of it that such discontinuities enclose, it has
/// the same flux as f. Where the exact light is continuous, its error is at most that of f, except where triangles
/// replace cells and parallelograms. Elements keep their ids; new ones are children of former leaves. If `stop` is
/// requested while nodes are computed, returns f itself. Same bits on any number of threads. O(n log n).
ElementFunction nearest_continuous(const ElementFunction& f, const Scene& scene, const ContactLines& contacts,
                                   const StopRequest* stop = nullptr);

/// Number of elements of a continuous function: its leaves, where the leaves of a fan count as the one element that was
/// split.
std::size_t elements_of_continuous(const ElementTree& tree);

}  // namespace exitance
