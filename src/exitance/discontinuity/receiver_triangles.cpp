#include "exitance/discontinuity/receiver_triangles.hpp"

namespace exitance {

ReceiverTriangles receiver_triangles(const ReceiverCurves& receiver, bool refined) {
    std::vector<LabelledSegment> segments;
    for (const FlatCurve& c : receiver.curves) segments.push_back({c.a, c.b, static_cast<std::uint8_t>(c.order)});
    LabelledTriangles out = labelled_triangles(receiver.loops, segments);
    if (out.corners.empty() && !segments.empty()) out = labelled_triangles(receiver.loops, {});
    if (refined) out = refined_triangles(out);
    return {std::move(out), 0};
}

}  // namespace exitance
