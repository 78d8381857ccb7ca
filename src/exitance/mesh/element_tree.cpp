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

/// Returns the part of cut() that contains (u, v), and the coordinates in it.
std::pair<std::size_t, Vec2> descend(Vec2 uv, Patch::Shape shape, Cut kind, double ratio) {
    const auto [u, v] = uv;
    if (shape == Patch::Shape::triangle) {
        if (u >= 0.5) return {1, {2 * u - 1, 2 * v}};
        if (v >= 0.5) return {2, {2 * u, 2 * v - 1}};
        if (u + v <= 0.5) return {0, {2 * u, 2 * v}};
        return {3, {1 - 2 * u, 1 - 2 * v}};
    }
    const auto half = [](double t, double r) { return t < r ? t / r : (t - r) / (1 - r); };
    if (kind == Cut::u) return {u < ratio ? 0u : 1u, {half(u, ratio), v}};
    if (kind == Cut::v) return {v < ratio ? 0u : 1u, {u, half(v, ratio)}};
    return {(u < 0.5 ? 0u : 1u) + (v < 0.5 ? 0u : 2u), {half(u, 0.5), half(v, 0.5)}};
}

double polygon_area(std::span<const Vec2> p) {
    double sum = 0;
    for (std::size_t i = 2; i < p.size(); ++i) sum += cross(p[i - 1] - p[0], p[i] - p[0]);
    return 0.5 * sum;
}

/// The part of a convex polygon on one side of a line (side -1: the first, 1: the second).
std::vector<Vec2> side_of_line(const std::vector<Vec2>& polygon, const CutLine& line, int side) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double dp = side * line.distance(p), dq = side * line.distance(q);
        if (dp >= 0) out.push_back(p);
        if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) out.push_back(p + (dp / (dp - dq)) * (q - p));
    }
    return out;
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

Vec2 uniform_in_shape(Patch::Shape shape, double s, double t) {
    if (shape == Patch::Shape::parallelogram) return {s, t};
    const double root = std::sqrt(s);
    return {1 - root, t * root};
}

std::vector<Patch> cut(const Patch& p, Cut kind, double ratio) {
    if (p.is_triangle()) {
        const Vec3 a = 0.5 * p.a, b = 0.5 * p.b;
        const auto piece = [](const Point& o, const Vec3& s, const Vec3& t) {
            return Patch{o, s, t, Patch::Shape::triangle};
        };
        return {piece(p.origin, a, b), piece(p.origin + a, a, b), piece(p.origin + b, a, b),
                piece(p.origin + a + b, -a, -b)};
    }
    switch (kind) {
        case Cut::none:
            return {p};
        case Cut::u:
            return {Patch{p.origin, ratio * p.a, p.b}, Patch{p.origin + ratio * p.a, (1 - ratio) * p.a, p.b}};
        case Cut::v:
            return {Patch{p.origin, p.a, ratio * p.b}, Patch{p.origin + ratio * p.b, p.a, (1 - ratio) * p.b}};
        case Cut::line:  // not supported for patches: see ElementTree::split_by_line, split_fan
        case Cut::fan:
        case Cut::both:
            break;
    }
    const Vec3 a = 0.5 * p.a, b = 0.5 * p.b;
    return {Patch{p.origin, a, b}, Patch{p.origin + a, a, b}, Patch{p.origin + b, a, b}, Patch{p.origin + a + b, a, b}};
}

void ElementTree::Content::add(RegionId in, ElementId above, const Patch& shape, double of_domain) {
    patch.add(shape);
    parent.add(above);
    region.add(in);
    area.add(of_domain);
    cell.add(none);
}

void ElementTree::add(RegionId region, ElementId parent, const Patch& shape, double area) {
    content_.change().add(region, parent, shape, area);
    cuts_.change().nodes.add({.children = {}, .shape = shape.shape});
}

Patch ElementTree::fan_triangle(ElementId e) const {
    const ElementId above = fanned(e);
    const Patch& parent = content_->patch[above];
    const FanView fan = this->fan(above);
    const std::size_t i = e.value - cuts_->nodes[above].children.front().value;
    const Point apex = parent.at(fan.apex);
    return {apex, parent.at(fan.border[i]) - apex, parent.at(fan.border[i + 1]) - apex, Patch::Shape::triangle};
}

void ElementTree::store_triangles() {
    const std::size_t first = stored(), last = size();
    if (first == last) return;
    std::vector<std::pair<ElementId, Patch>> triangles;
    for (std::size_t i = first; i < last; ++i) triangles.emplace_back(fanned(ElementId(i)), fan_triangle(ElementId(i)));
    cuts_.change().fan_of = {};
    for (const auto& [parent, patch] : triangles) add(RegionId(content_->region[parent]), parent, patch, patch.area());
}

ElementId ElementTree::add_root(RegionId region, const Patch& shape) {
    store_triangles();
    add(region, ElementId(), shape, shape.area());
    content_.change().roots.push_back(ElementId(stored() - 1));
    return content_->roots.back();
}

ElementId ElementTree::split(ElementId leaf, Cut kind, double ratio) {
    EXI_CHECK(is_leaf(leaf) && !is_cell(leaf) && kind != Cut::none && kind != Cut::line && kind != Cut::fan);
    store_triangles();
    const std::size_t first = stored();
    const RegionId region = content_->region[leaf];
    const Patch whole = content_->patch[leaf];
    for (const Patch& piece : cut(whole, kind, ratio)) add(region, leaf, piece, piece.area());
    Node& made = cuts_.change().nodes[leaf];
    made.children = {first, stored()};
    made.cut = whole.is_triangle() ? Cut::both : kind;
    made.ratio = ratio;
    return ElementId(first);
}

ElementId ElementTree::split_by_line(ElementId leaf, CutLine line, double least) {
    EXI_CHECK(is_leaf(leaf));
    const std::vector<Vec2> whole = domain(leaf);
    const double whole_area = std::abs(polygon_area(whole));
    const std::array<std::vector<Vec2>, 2> side = {side_of_line(whole, line, -1), side_of_line(whole, line, +1)};
    for (const std::vector<Vec2>& polygon : side)
        if (polygon.size() < 3 || std::abs(polygon_area(polygon)) < least * whole_area) return ElementId();
    store_triangles();
    Content& c = content_.change();
    const std::size_t first = stored();
    const Patch parent = c.patch[leaf];
    LineCut record{line, {}, {}};
    for (std::size_t i = 0; i < 2; ++i) {
        std::vector<Vec2> polygon = side[i];
        Vec2 lo = polygon[0], hi = polygon[0];
        for (const Vec2 p : polygon) {
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
        }
        const Patch frame{parent.at(lo), (hi.x - lo.x) * parent.a, (hi.y - lo.y) * parent.b,
                          Patch::Shape::parallelogram};
        for (Vec2& p : polygon) p = {(p.x - lo.x) / (hi.x - lo.x), (p.y - lo.y) / (hi.y - lo.y)};
        add(RegionId(c.region[leaf]), leaf, frame, frame.area() * std::abs(polygon_area(polygon)));
        record.origin[i] = lo;
        record.size[i] = hi - lo;
        c.cell[ElementId(c.patch.size() - 1)] = static_cast<std::uint32_t>(c.first_corner.size() - 1);
        c.corners.insert(c.corners.end(), polygon.begin(), polygon.end());
        c.first_corner.push_back(static_cast<std::uint32_t>(c.corners.size()));
    }
    Node& made = cuts_.change().nodes[leaf];
    made.children = {first, stored()};
    made.cut = Cut::line;
    made.line = static_cast<std::uint32_t>(c.lines.size());
    c.lines.push_back(record);
    return ElementId(first);
}

ElementId ElementTree::split_fan(ElementId leaf, const Fan& fan) {
    EXI_CHECK(is_leaf(leaf) && fan.border.size() >= 2);
    // Smallest area of a triangle of the fan, as a share of the element's; derived from double precision.
    constexpr double min_area = 1e-12;
    for (std::size_t i = 1; i < fan.border.size(); ++i)
        if (!(cross(fan.border[i - 1] - fan.apex, fan.border[i] - fan.apex) > min_area)) return ElementId();
    if (!is_stored(leaf)) store_triangles();
    Cuts& c = cuts_.change();
    const std::size_t first = size(), triangles = fan.border.size() - 1;
    const auto number = static_cast<std::uint32_t>(c.fans.size());
    c.fan_of.insert(c.fan_of.end(), triangles, number);
    c.fans.push_back({leaf, static_cast<std::uint32_t>(c.places.size())});
    c.places.push_back(fan.apex);
    c.places.insert(c.places.end(), fan.border.begin(), fan.border.end());
    Node& made = c.nodes[leaf];
    made.children = {first, first + triangles};
    made.cut = Cut::fan;
    made.line = number;
    return ElementId(first);
}

/// The triangle of a fan that contains a point, by the largest distance to its sides.
ElementTree::Place ElementTree::in_fan(ElementId e, Vec2 uv) const {
    const FanView fan = this->fan(e);
    Place out;
    double deepest = -HUGE_VAL;
    for (std::size_t i = 1; i < fan.border.size(); ++i) {
        const Vec2 a = fan.border[i - 1] - fan.apex, b = fan.border[i] - fan.apex, at = uv - fan.apex;
        const double area = cross(a, b), u = cross(at, b) / area, v = cross(a, at) / area;
        const double depth = std::min({u, v, 1 - u - v});
        if (depth > deepest) deepest = depth, out = {children(e)[i - 1], {u, v}};
    }
    return out;
}

std::vector<Vec2> ElementTree::domain(ElementId e) const {
    if (is_cell(e)) {
        const std::span<const Vec2> corners = cell_domain(e);
        return {corners.begin(), corners.end()};
    }
    const Patch shape = patch(e);
    std::vector<Vec2> out;
    for (int i = 0; i < shape.corner_count(); ++i) out.push_back(shape.corner_uv(i));
    return out;
}

std::vector<Point> ElementTree::outline(ElementId e) const {
    std::vector<Point> out;
    const Patch whole = patch(e);
    for (const Vec2 p : domain(e)) out.push_back(whole.at(p));
    return out;
}

Vec2 ElementTree::centre(ElementId e) const {
    if (!is_cell(e)) return node(e).shape == Patch::Shape::triangle ? Vec2{1.0 / 3, 1.0 / 3} : Vec2{0.5, 0.5};
    const std::span<const Vec2> p = cell_domain(e);
    Vec2 moment;
    for (std::size_t i = 2; i < p.size(); ++i)
        moment = moment + (cross(p[i - 1] - p[0], p[i] - p[0]) / 6) * ((p[i - 1] - p[0]) + (p[i] - p[0]));
    return p[0] + (1 / polygon_area(p)) * moment;
}

double ElementTree::reach(ElementId e, Vec2 uv) const {
    const Vec2 c = centre(e);
    const std::vector<Vec2> p = domain(e);
    double reach = 1;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2 a = p[i], side = p[(i + 1) % p.size()] - a;
        const double here = cross(side, c - a), there = cross(side, uv - a);
        if (there < 0) reach = std::min(reach, here / (here - there));
    }
    return std::max(0.0, reach);
}

Vec2 ElementTree::uniform(ElementId e, double s, double t) const {
    if (!is_cell(e)) return uniform_in_shape(node(e).shape, s, t);
    // Choose a triangle of the fan around the first corner, with probability proportional to area, by the first number;
    // then reuse the rest of that number inside the triangle.
    const std::span<const Vec2> p = cell_domain(e);
    double rest = s * polygon_area(p);
    for (std::size_t i = 2;; ++i) {
        const double area = 0.5 * cross(p[i - 1] - p[0], p[i] - p[0]);
        if (rest >= area && i + 1 < p.size()) {
            rest -= area;
            continue;
        }
        const Vec2 uv = uniform_in_shape(Patch::Shape::triangle, std::clamp(rest / area, 0.0, 1.0), t);
        return p[0] + uv.x * (p[i - 1] - p[0]) + uv.y * (p[i] - p[0]);
    }
}

std::vector<ElementId> ElementTree::leaves() const {
    std::vector<ElementId> out;
    for (ElementId e : ids())
        if (is_leaf(e)) out.push_back(e);
    return out;
}

ElementTree::Place ElementTree::leaf_at(ElementId e, Vec2 uv) const {
    uv = into_shape(uv, patch(e).shape);
    for (const Node* at = &node(e); !at->children.empty(); at = &node(e)) {
        if (at->cut == Cut::line) {
            const LineCut& cut = content_->lines[at->line];
            const std::size_t side = cut.line.distance(uv) <= 0 ? 0 : 1;
            const Vec2 from = uv - cut.origin[side];
            uv = {from.x / cut.size[side].x, from.y / cut.size[side].y};
            e = at->children[side];
        } else if (at->cut == Cut::fan) {
            const Place place = in_fan(e, uv);
            uv = place.uv;
            e = place.element;
        } else {
            const auto [child, inside] = descend(uv, at->shape, at->cut, at->ratio);
            uv = inside;
            e = at->children[child];
        }
    }
    return {e, into_shape(uv, node(e).shape)};
}

void ElementTree::reserve(std::size_t elements) {
    Content& c = content_.change();
    c.patch.reserve(elements), c.parent.reserve(elements), c.region.reserve(elements), c.area.reserve(elements);
    c.cell.reserve(elements), cuts_.change().nodes.reserve(elements);
}

void ElementTree::reserve_fans(std::size_t fans, std::size_t triangles) {
    Cuts& c = cuts_.change();
    const std::size_t more = c.fans.size() + fans;
    c.fans.reserve(more), c.places.reserve(c.places.size() + triangles + 2 * fans);
    c.fan_of.reserve(c.fan_of.size() + triangles);
}

void ElementTree::shrink_to_fit() {
    Content& c = content_.change();
    c.patch.shrink_to_fit(), c.parent.shrink_to_fit(), c.region.shrink_to_fit(), c.area.shrink_to_fit();
    c.cell.shrink_to_fit(), c.first_corner.shrink_to_fit(), c.corners.shrink_to_fit(), c.lines.shrink_to_fit();
    Cuts& cuts = cuts_.change();
    cuts.nodes.shrink_to_fit(), cuts.fans.shrink_to_fit(), cuts.places.shrink_to_fit(), cuts.fan_of.shrink_to_fit();
}

std::size_t ElementTree::memory_bytes() const {
    const Content& c = *content_;
    return stored() * (sizeof(Patch) + sizeof(Node) + 3 * sizeof(ElementId) + sizeof(double)) +
           c.lines.size() * sizeof(LineCut) + 4 * c.first_corner.size() + c.corners.size() * sizeof(Vec2) +
           cuts_->fans.size() * sizeof(FanCut) + cuts_->places.size() * sizeof(Vec2) + 4 * cuts_->fan_of.size();
}

}  // namespace exitance
