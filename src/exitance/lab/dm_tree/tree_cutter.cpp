#include "exitance/lab/dm_tree/tree_cutter.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/lab/dm_tree/dm_tree.hpp"

namespace exitance {
namespace {

bool is_convex_outline(const ReceiverCurves& receiver) {
    if (receiver.loops.size() != 1) return false;
    const auto& loop = receiver.loops.front();
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2 a = loop[(i + 1) % loop.size()] - loop[i],
                   b = loop[(i + 2) % loop.size()] - loop[(i + 1) % loop.size()];
        constexpr double straight = 1e-9;  // sine of an angle that may be due to rounding of coordinates
        if (cross(a, b) < -straight * std::sqrt(dot(a, a) * dot(b, b))) return false;
    }
    return true;
}

double area_of(std::span<const Vec2> loop) {
    double twice = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) twice += cross(loop[i], loop[(i + 1) % loop.size()]);
    return 0.5 * twice;
}

double area_of(const LabelledTriangles& t) {
    double twice = 0;
    for (const auto& c : t.corners) twice += cross(t.points[c[1]] - t.points[c[0]], t.points[c[2]] - t.points[c[0]]);
    return 0.5 * twice;
}

ReceiverTriangles by_tree(const ReceiverCurves& receiver, const TreeCut& cut, double tolerance) {
    constexpr std::size_t cells = 4;  // number of grid cells along each side
    DmTree tree(receiver.loops.front(), tolerance);
    if (cut.grid) tree.insert_grid(cells);
    std::vector<const FlatCurve*> curves;
    for (const FlatCurve& c : receiver.curves) curves.push_back(&c);
    if (cut.penumbra_first)
        std::stable_sort(curves.begin(), curves.end(), [](const FlatCurve* p, const FlatCurve* q) {
            return std::pair(p->order, -p->length()) < std::pair(q->order, -q->length());
        });
    std::vector<std::uint8_t> labels;
    for (const FlatCurve* c : curves) {
        tree.insert(c->a, c->b, static_cast<std::uint32_t>(labels.size()));
        labels.push_back(static_cast<std::uint8_t>(c->order));
    }
    return {triangulated(tree, cut.scheme, labels), tree.memory_bytes()};
}

}  // namespace

std::optional<ReceiverTriangles> cut_by_tree(const ReceiverCurves& receiver, const TreeCut& cut, double tolerance) {
    if (!is_convex_outline(receiver)) return std::nullopt;
    ReceiverTriangles out = by_tree(receiver, cut, tolerance);
    // Line trees merge nearby points, which may lose area.
    constexpr double lost = 1e-10;  // share of the area; below the 1e-9 that no mesh may lose
    const double area = area_of(receiver.loops.front());
    if (std::abs(area_of(out.triangles) - area) > lost * area) return std::nullopt;
    return out;
}

}  // namespace exitance
