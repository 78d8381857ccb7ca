#include "exitance/transport/crowd_rays.hpp"

#include <algorithm>

#include "exitance/base/error_share.hpp"

namespace exitance {

double fewer_rays_in_crowd(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                           std::span<const Spectrum> reflected) {
    // Mean square of light over its squared mean, below which light counts as even. Derived from surfaces of which a
    // quarter is lit.
    constexpr double even = 4;
    const std::size_t leaves = numbering.leaves.size();
    if (!stage.is_crowd(leaves)) return 1;
    const auto in_one_room = static_cast<std::size_t>(static_cast<double>(leaves) / stage.rooms.multiplicity());
    double area = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < leaves; ++i) {
        const double own = tree.area(numbering.leaves[i]), b = mean(reflected[i]);
        area += own, sum += own * b, squares += own * b * b;
    }
    const double uneven = sum > 0 ? area * squares / (sum * sum) : 1;
    return std::min(1.0, fewer_rays_in_crowd(in_one_room) * std::max(1.0, uneven / even));
}

}  // namespace exitance
