#include "exitance/mesh/element_tree.hpp"

namespace exitance {
namespace {

/// Where a point of the pushed-in reference shape lies at most outside by rounding: moved onto the shape.
Vec2 into_shape(Vec2 uv, Patch::Shape shape) {
    uv = {std::clamp(uv.x, 0.0, 1.0), std::clamp(uv.y, 0.0, 1.0)};
    if (shape == Patch::Shape::triangle && uv.x + uv.y > 1) {
        const double sum = uv.x + uv.y;
        uv = {uv.x / sum, uv.y / sum};
    }
    return uv;
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
    }
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
    Point p = patch_[e].at(uv);
    while (!is_leaf(e)) {
        // The child that holds the point, or by rounding comes nearest to holding it.
        ElementId best = children_[e].front();
        double depth = -HUGE_VAL;
        for (ElementId child : children_[e]) {
            const Vec2 c = patch_[child].coordinates(p);
            const double inside = patch_[child].is_triangle()
                                      ? std::min({c.x, c.y, 1 - c.x - c.y})
                                      : std::min({c.x, c.y, 1 - c.x, 1 - c.y});
            if (inside > depth) depth = inside, best = child;
            if (inside >= 0) break;
        }
        e = best;
    }
    return {e, into_shape(patch_[e].coordinates(p), patch_[e].shape)};
}

std::size_t ElementTree::memory_bytes() const {
    return patch_.size() * (sizeof(Patch) + sizeof(IdRange<ElementId>) + 2 * sizeof(ElementId) + sizeof(double));
}

}  // namespace exitance
