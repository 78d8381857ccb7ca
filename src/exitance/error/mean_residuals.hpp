#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/solve_mesh.hpp"

namespace exitance {

/// A residual measured on one leaf of a mesh.
struct LeafResidual {
    std::uint32_t leaf = 0;   ///< Its number.
    std::uint32_t group = 0;  ///< What the leaf belongs to: its region, and its room.
    double weight = 0;        ///< The area that the sample stands for, by that of one of as many spread evenly.
    Spectrum residual;
};

/// Mean residuals of the leaves of a mesh, as far as samples tell them. A mean of few samples is mostly noise, and most
/// leaves have none; but what they have in common with their surroundings is told by the samples of those. So means are
/// found from the whole down: of every group, drawn towards zero as if it had a few more samples without residual; then
/// of the roots, of their children, and so on, each drawn towards the mean of what it is a part of, as far as samples
/// of one element agree in what they have beyond that, all elements of a level together. Beside a concave edge and in a
/// gap they do, and there faces reflect to each other what a mean over the whole face does not show.
///
/// groups     their number; each leaf and each sample belongs to one
/// Returns    the mean of every leaf, by number. O(elements + samples x depth).
std::vector<Spectrum> mean_residuals(const ElementTree& tree, const LeafNumbering& numbering,
                                     std::span<const std::uint32_t> group_of_leaf, std::size_t groups,
                                     std::span<const LeafResidual> samples);

}  // namespace exitance
