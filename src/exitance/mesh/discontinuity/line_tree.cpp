#include "exitance/mesh/discontinuity/line_tree.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// The part of a convex outline with normal . p <= offset (side 1) or >= offset (side -1).
std::vector<Vec2> half(std::span<const Vec2> outline, Vec2 normal, double offset, double side) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        const double da = side * (dot(normal, a) - offset), db = side * (dot(normal, b) - offset);
        if (da <= 0) out.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + da / (da - db) * (b - a));
    }
    return out;
}

double area_of(std::span<const Vec2> outline) {
    double twice = 0;
    for (std::size_t i = 2; i < outline.size(); ++i)
        twice += cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    return 0.5 * twice;
}

struct Extent {
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    double size() const { return hi - lo; }
};

Extent extent(std::span<const Vec2> outline, Vec2 along) {
    Extent out;
    for (const Vec2 p : outline) out.lo = std::min(out.lo, dot(along, p)), out.hi = std::max(out.hi, dot(along, p));
    return out;
}

/// Clips a curve to a convex outline. Returns false if the rest is shorter than the tolerance or on the border.
bool cut_to(std::span<const Vec2> outline, double tolerance, FlatCurve& curve) {
    double first = 0, last = 1;
    const Vec2 d = curve.b - curve.a;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2 e = outline[(i + 1) % outline.size()] - outline[i];
        const double size = std::sqrt(dot(e, e));
        if (!(size > 0)) continue;
        const double at = cross(e, curve.a - outline[i]) / size, rise = cross(e, d) / size;
        if (rise > 0)
            first = std::max(first, -at / rise);
        else if (rise < 0)
            last = std::min(last, -at / rise);
        if (std::max(at, at + rise) <= tolerance) return false;
    }
    if (!((last - first) * std::sqrt(dot(d, d)) > tolerance)) return false;
    curve.b = curve.a + last * d;
    curve.a = curve.a + first * d;
    return true;
}

}  // namespace

Vec2 FanTriangle::centre() const {
    return (1.0 / 3) * (a + b + c);
}

std::vector<FanTriangle> fan_of(std::span<const Vec2> outline) {
    std::vector<FanTriangle> out;
    for (std::size_t i = 2; i < outline.size(); ++i)
        out.push_back({outline[0], outline[i - 1], outline[i],
                       0.5 * cross(outline[i - 1] - outline[0], outline[i] - outline[0])});
    return out;
}

void LineTree::add_node(Node node, std::span<const FlatCurve> curves) {
    node.area = area_of(node.outline);
    for (const FanTriangle& t : fan_of(node.outline)) node.centre = node.centre + t.area / node.area * t.centre();
    for (FlatCurve curve : curves)
        if (cut_to(node.outline, tolerance_, curve)) node.curves.push_back(curve);
    nodes_.push_back(std::move(node));
}

std::uint32_t LineTree::add_root(RegionId region, std::vector<Vec2> outline, std::span<const FlatCurve> curves) {
    Node node;
    node.region = region, node.outline = std::move(outline), node.root = static_cast<std::uint32_t>(nodes_.size());
    add_node(std::move(node), curves);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

bool LineTree::find_cut(const Node& node, Line& cut) const {
    const auto evenness = [&](const Line& line) {
        const std::vector<Vec2> below = half(node.outline, line.normal, line.offset, 1);
        const Extent across = extent(node.outline, line.normal);
        if (std::min(line.offset - across.lo, across.hi - line.offset) <= tolerance_) return -1.0;
        const double part = area_of(below) / node.area;
        return std::min(part, 1 - part);
    };
    double best = -1;
    CurveOrder order = CurveOrder::none;
    for (const FlatCurve& curve : node.curves) {
        if (curve.order > order) continue;
        const Vec2 d = curve.b - curve.a;
        const Vec2 normal = 1 / std::sqrt(dot(d, d)) * Vec2{d.y, -d.x};
        const Line line{normal, dot(normal, curve.a), true};
        const double even = evenness(line);
        if (even < 0 || (curve.order == order && even <= best)) continue;
        best = even, order = curve.order, cut = line;
    }
    if (best >= 0) return true;
    Vec2 longest;
    for (std::size_t i = 0; i < node.outline.size(); ++i) {
        const Vec2 e = node.outline[(i + 1) % node.outline.size()] - node.outline[i];
        if (dot(e, e) > dot(longest, longest)) longest = e;
    }
    Vec2 along = 1 / std::sqrt(dot(longest, longest)) * longest;
    const Vec2 across{-along.y, along.x};
    if (extent(node.outline, across).size() > extent(node.outline, along).size()) along = across;
    const Extent range = extent(node.outline, along);
    cut = {along, 0.5 * (range.lo + range.hi), false};
    return evenness(cut) > 0;
}

bool LineTree::split(std::uint32_t number) {
    Line cut;
    if (!nodes_[number].is_leaf() || !(nodes_[number].area > 0) || !find_cut(nodes_[number], cut)) return false;
    const std::vector<FlatCurve> curves = std::move(nodes_[number].curves);
    nodes_[number].curves.clear();
    nodes_[number].normal = cut.normal, nodes_[number].offset = cut.offset, nodes_[number].by_curve = cut.by_curve;
    nodes_[number].first_child = static_cast<std::uint32_t>(nodes_.size());
    for (const double side : {1.0, -1.0}) {
        Node child;
        child.region = nodes_[number].region, child.parent = number, child.root = nodes_[number].root;
        child.outline = half(nodes_[number].outline, cut.normal, cut.offset, side);
        add_node(std::move(child), curves);
    }
    return true;
}

std::uint32_t LineTree::leaf_under(std::uint32_t root, Vec2 p) const {
    std::uint32_t at = root;
    while (!nodes_[at].is_leaf()) {
        const Node& n = nodes_[at];
        at = n.first_child + (dot(n.normal, p) > n.offset ? 1 : 0);
    }
    return at;
}

}  // namespace exitance
