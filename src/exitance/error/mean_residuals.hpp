#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/solve_mesh.hpp"

namespace exitance {

/// A residual measured on one leaf of a mesh.
struct LeafResidual {
    std::uint32_t leaf = 0;   ///< Leaf number.
    std::uint32_t group = 0;  ///< Group of the leaf: its region and room.
    double weight = 0;        ///< Area that the sample represents, relative to the mean area per sample.
    Spectrum residual;
};

/// Estimates the mean residual of every leaf of a mesh from samples. Most leaves have no sample, and a mean of few
/// samples is mostly noise. Means are therefore estimated from coarse to fine: first of every group, shrunk towards
/// zero as if it had a few more samples without residual; then of the roots, of their children, and so on. Each is
/// shrunk towards the mean of its parent, the more the less the samples of one element agree in their deviation from
/// it. The agreement is that of all elements of a level together. Samples agree next to concave edges and in gaps,
/// where faces reflect to each other a residual that the mean over a whole face does not show.
///
/// groups   number of groups; each leaf and each sample belongs to one
/// Returns  one mean per leaf, by leaf number. O(elements + samples x depth).
std::vector<Spectrum> mean_residuals(const ElementTree& tree, const LeafNumbering& numbering,
                                     std::span<const std::uint32_t> group_of_leaf, std::size_t groups,
                                     std::span<const LeafResidual> samples);

}  // namespace exitance
