#pragma once

#include <functional>
#include <optional>

#include "exitance/discontinuity/receiver_curves.hpp"
#include "exitance/mesh/planar_subdivision.hpp"

namespace exitance {

/// The triangles between a receiver's curves, and the memory of the line tree that they were made from.
struct ReceiverTriangles {
    LabelledTriangles triangles;
    std::size_t tree_bytes = 0;
};

/// Cuts a receiver into triangles along its curves in a way of its own. Points nearer to each other than `tolerance`
/// (metres) are one. Returns nothing where it cannot cut the receiver.
using FaceCutter = std::function<std::optional<ReceiverTriangles>(const ReceiverCurves& receiver, double tolerance)>;

/// Delaunay's triangulation with the curves as constraints; without them where they cannot be inserted. `refined`: with
/// points added for the shape of the triangles.
ReceiverTriangles receiver_triangles(const ReceiverCurves& receiver, bool refined);

}  // namespace exitance
