#include "exitance/mesh/element_tree.hpp"

#include <utility>

namespace exitance {
Vec2 into_shape(Vec2 uv, Patch::Shape shape) {
    uv = {std::clamp(uv.x, 0.0, 1.0), std::clamp(uv.y, 0.0, 1.0)};
    if (shape == Patch::Shape::triangle && uv.x + uv.y > 1) {
        const double sum = uv.x + uv.y;
        uv = {uv.x / sum, uv.y / sum};
    }
    return uv;
}

namespace {

/// Which piece of cut() holds (u, v), and the coordinates there.
std::pair<std::size_t, Vec2> descend(Vec2 uv, Patch::Shape shape, Cut way, double ratio) {
    const auto [u, v] = uv;
    if (shape == Patch::Shape::triangle) {
        if (u >= 0.5) return {1, {2 * u - 1, 2 * v}};
        if (v >= 0.5) return {2, {2 * u, 2 * v - 1}};
        if (u + v <= 0.5) return {0, {2 * u, 2 * v}};
        return {3, {1 - 2 * u, 1 - 2 * v}};
    }
    const auto half = [](double t, double r) { return t < r ? t / r : (t - r) / (1 - r); };
    if (way == Cut::u) return {u < ratio ? 0u : 1u, {half(u, ratio), v}};
    if (way == Cut::v) return {v < ratio ? 0u : 1u, {u, half(v, ratio)}};
    return {(u < 0.5 ? 0u : 1u) + (v < 0.5 ? 0u : 2u), {half(u, 0.5), half(v, 0.5)}};
}

}  // namespace

Vec2 Patch::corner_uv(int i) const {
    static constexpr Vec2 square[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static constexpr Vec2 triangle[3] = {{0, 0}, {1, 0}, {0, 1}};
    return is_triangle() ? triangle[i] : square[i];
}

Vec2 Patch::coordinates(const Point& p) const {
    const Vec3 n = cross(a, b), w = p - origin;
    const double scale = 1 / squared_norm(n);
    return {dot(cross(w, b), n) * scale, dot(cross(a, w), n) * scale};
}

std::vector<Patch> cut(const Patch& p, Cut way, double ratio) {
    if (p.is_triangle()) {
        const Vec3 a = 0.5 * p.a, b = 0.5 * p.b;
        const auto piece = [](const Point& o, const Vec3& s, const Vec3& t) {
            return Patch{o, s, t, Patch::Shape::triangle};
        };
        return {piece(p.origin, a, b), piece(p.origin + a, a, b), piece(p.origin + b, a, b),
                piece(p.origin + a + b, -a, -b)};
    }
    switch (way) {
        case Cut::none: return {p};
        case Cut::u: return {Patch{p.origin, ratio * p.a, p.b}, Patch{p.origin + ratio * p.a, (1 - ratio) * p.a, p.b}};
        case Cut::v: return {Patch{p.origin, p.a, ratio * p.b}, Patch{p.origin + ratio * p.b, p.a, (1 - ratio) * p.b}};
        case Cut::both: break;
    }
    const Vec3 a = 0.5 * p.a, b = 0.5 * p.b;
    return {Patch{p.origin, a, b}, Patch{p.origin + a, a, b}, Patch{p.origin + b, a, b}, Patch{p.origin + a + b, a, b}};
}

ElementId ElementTree::add_root(RegionId region, const Patch& shape) {
    const ElementId e = patch_.add(shape);
    children_.add({});
    parent_.add(ElementId());
    region_.add(region);
    area_.add(shape.area());
    way_.add(Cut::none);
    ratio_.add(0.5);
    roots_.push_back(e);
    return e;
}

ElementId ElementTree::split(ElementId leaf, Cut way, double ratio) {
    EXI_CHECK(is_leaf(leaf) && way != Cut::none);
    const std::vector<Patch> pieces = cut(patch_[leaf], way, ratio);
    const std::size_t first = patch_.size();
    for (const Patch& piece : pieces) {
        patch_.add(piece);
        children_.add({});
        parent_.add(leaf);
        region_.add(RegionId(region_[leaf]));
        area_.add(piece.area());
        way_.add(Cut::none);
        ratio_.add(0.5);
    }
    way_[leaf] = patch_[leaf].is_triangle() ? Cut::both : way;
    ratio_[leaf] = ratio;
    children_[leaf] = {first, patch_.size()};
    return ElementId(first);
}

std::vector<ElementId> ElementTree::leaves() const {
    std::vector<ElementId> out;
    for (ElementId e : ids())
        if (is_leaf(e)) out.push_back(e);
    return out;
}

ElementTree::Place ElementTree::leaf_at(ElementId e, Vec2 uv) const {
    const Patch::Shape shape = patch_[e].shape;
    uv = into_shape(uv, shape);
    while (!is_leaf(e)) {
        const auto [child, inside] = descend(uv, shape, way_[e], ratio_[e]);
        e = children_[e][child];
        uv = inside;
    }
    return {e, into_shape(uv, shape)};
}

std::size_t ElementTree::memory_bytes() const {
    return patch_.size() * (sizeof(Patch) + sizeof(IdRange<ElementId>) + 2 * sizeof(ElementId) + 2 * sizeof(double) + sizeof(Cut));
}

}  // namespace exitance
