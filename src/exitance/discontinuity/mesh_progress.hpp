#pragma once

#include <vector>

#include "exitance/base/archive.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/discontinuity/curve_arrangement.hpp"

namespace exitance {

/// The curves of one receiver, and whether they have been found.
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

/// Expensive intermediate results of a discontinuity mesh, for checkpoints. Everything else is recomputed: node values
/// determine the order of bisections, so a resumed run requests them in the order of their numbers again.
struct MeshProgress {
    std::vector<FoundCurves> receivers;  ///< Per region.
    std::vector<Spectrum> values;        ///< Values at the nodes, in the order of evaluation, W/m^2.
};

template <class Archive>
void archive(Archive& a, MeshProgress& progress) {
    auto& [receivers, values] = progress;
    a(receivers, values);
}

}  // namespace exitance
