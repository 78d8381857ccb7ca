#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/mesh/contact_lines.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// The function nearest to `f` in the mean square among those that are continuous but where light jumps, on a mesh made
/// conforming: of every plane, and of every part of it that such lines enclose, it holds as much light. Where the
/// light that f stands for is continuous, it is no further from it than f, but for what triangles lack of cells and of
/// the parallelograms that they are cut from. Elements keep their ids; new ones are children of what were leaves.
/// O(n log n); the same bits on any number of threads.
/// Where `stop` is requested while nodes are found, f itself is returned.
ElementFunction nearest_continuous(const ElementFunction& f, const Scene& scene, const ContactLines& contacts,
                                   const StopRequest* stop = nullptr);

/// How many elements a continuous function is made of: its leaves, those of a fan counted as the one they were.
std::size_t elements_of_continuous(const ElementTree& tree);

}  // namespace exitance
