#pragma once

#include <vector>

#include "exitance/base/archive.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/discontinuity/curve_arrangement.hpp"

namespace exitance {

/// The curves of one receiver, once they are found.
struct FoundCurves {
    bool is_done = false;
    std::vector<std::vector<Vec2>> loops;
    std::vector<FlatCurve> curves;
    std::uint64_t wedges = 0, left_out = 0;
};

template <class Archive>
void archive(Archive& a, FoundCurves& found) {
    auto& [is_done, loops, curves, wedges, left_out] = found;
    a(is_done, loops, curves, wedges, left_out);
}

/// What has cost much of a discontinuity mesh so far, for checkpoints. Everything else follows from it: which triangle
/// is bisected when follows from the values at nodes, so that these come back in the order of their numbers.
struct MeshProgress {
    std::vector<FoundCurves> receivers;  ///< By region.
    std::vector<Spectrum> values;        ///< Of nodes.
};

template <class Archive>
void archive(Archive& a, MeshProgress& progress) {
    auto& [receivers, values] = progress;
    a(receivers, values);
}

}  // namespace exitance
