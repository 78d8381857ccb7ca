#include "exitance/mesh/element_locator.hpp"

#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/shared_results.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_searched_roots = 8;
/// Distance from a border within which a point may be on either side of it, as a share of the extent of all roots.
/// Derived from double precision.
constexpr double rounding = 1e-9;

/// Index of the cell of a coordinate along an axis with `count` cells; coordinates outside are clamped.
std::uint32_t cell_of(double x, double origin, double scale, std::uint32_t count) {
    const double i = (x - origin) * scale;
    return i > 0 ? static_cast<std::uint32_t>(std::min(i, static_cast<double>(count - 1))) : 0;  // also 0 for NaN
}

}  // namespace

/// The root that contains a point, or otherwise the nearest one.
struct ElementLocator::Nearest {
    const Root* root = nullptr;
    Vec2 uv;
    double distance = HUGE_VAL;  ///< Squared, m^2.

    void look_at(std::span<const Root> roots, const Point& p) {
        if (!std::isfinite(p.x + p.y + p.z)) return;  // no root; such points come from rays in damaged scenes
        for (const Root& r : roots) {
            const Vec2 at = r.coordinates(p);
            if (!r.holds(at)) continue;
            root = &r, uv = at, distance = 0;
            return;
        }
        for (const Root& r : roots) {  // rounding: no root contains p, so take the nearest one
            const Vec2 at = r.coordinates(p), held = into_shape(at, r.shape);
            const auto [a, b] = sides(r);
            const double d = squared_norm((at - held).x * a + (at - held).y * b);
            if (root && !(d < distance)) continue;
            const bool has_area = d >= 0;  // false if d is NaN, since the root has no coordinates
            root = &r, uv = has_area ? held : Vec2{}, distance = has_area ? d : HUGE_VAL;
        }
    }

    /// The sides of a root: the dual basis of its gradients du and dv. The cross product is accurate even for a root
    /// that is a billionth as wide as long, unlike the determinant of the inner products. Not finite if the root has no
    /// area.
    static std::pair<Vec3, Vec3> sides(const Root& r) {
        const Vec3 n = cross(r.du, r.dv);
        const double scale = 1 / squared_norm(n);
        return {scale * cross(r.dv, n), scale * cross(n, r.du)};
    }
};

std::uint32_t ElementLocator::Grid::column(double x) const {
    return cell_of(x, s0, s_scale, columns);
}
std::uint32_t ElementLocator::Grid::row(double y) const {
    return cell_of(y, t0, t_scale, rows);
}

ElementLocator::ElementLocator(const ElementTree& tree, std::size_t region_count)
    : leaves_(tree), first_root_(region_count + 1, 0), roots_(tree.roots().size()), grid_of_(region_count, -1) {
    for (ElementId e : tree.roots()) {
        EXI_CHECK(tree.region(e).value < region_count);
        ++first_root_[tree.region(e).value + 1];
    }
    for (std::size_t r = 0; r < region_count; ++r) first_root_[r + 1] += first_root_[r];
    std::vector<std::uint32_t> next(first_root_.begin(), first_root_.end() - 1);
    for (std::uint32_t i = 0; i < tree.roots().size(); ++i) {
        const ElementId e = tree.roots()[i];
        const auto& [origin, a, b, shape] = tree.patch(e);
        const Vec3 n = cross(a, b);
        const double scale = 1 / squared_norm(n);
        roots_[next[tree.region(e).value]++] = {origin, scale * cross(b, n), scale * cross(n, a), i, shape};
    }
    std::vector<RegionId> searched;
    for (std::size_t r = 0; r < region_count; ++r) {
        if (roots(RegionId(r)).size() <= max_searched_roots) continue;
        grid_of_[r] = static_cast<std::int32_t>(searched.size());
        searched.emplace_back(r);
    }
    grids_.resize(searched.size());
    parallel_for(searched.size(), 1, [&](std::size_t i) { grids_[i] = make_grid(roots(searched[i])); });
    share_on_node(std::span(roots_)), share_on_node(std::span(first_root_)), share_on_node(std::span(grid_of_));
}

ElementLocator::Grid ElementLocator::make_grid(std::span<const Root> roots) {
    Grid grid;
    Vec3 n = {};  // sum of the roots' normals, weighted by area, so that a thin root does not decide
    for (const Root& r : roots) {
        const auto [a, b] = Nearest::sides(r);
        const Vec3 one = cross(a, b);
        if (std::isfinite(squared_norm(one))) n += one;
    }
    const Vec3 size = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const std::uint8_t drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    grid.s = (drop + 1) % 3, grid.t = (drop + 2) % 3;

    const auto box_of = [](const Root& r) {
        const std::pair<Vec3, Vec3> sides = Nearest::sides(r);
        Box box;
        for (const Point& p : {r.origin, r.origin + sides.first, r.origin + sides.second}) box.add(p);
        if (r.shape == Patch::Shape::parallelogram) box.add(r.origin + sides.first + sides.second);
        return box;
    };
    const auto has_area = [](const Root& r) {
        const auto is_finite = [](const Vec3& v) { return std::isfinite(squared_norm(v)); };
        const std::pair<Vec3, Vec3> sides = Nearest::sides(r);
        return is_finite(sides.first) && is_finite(sides.second);
    };
    Box all;
    for (const Root& r : roots) {
        all.add(r.origin);
        if (has_area(r)) all.add(box_of(r));
    }
    // About one cell per root, as square as the region allows.
    const double width = all.size()[grid.s], height = all.size()[grid.t], count = static_cast<double>(roots.size());
    const double side = std::sqrt(width * height / count);
    const auto cells = [&](double length) {
        return static_cast<std::uint32_t>(side > 0 ? std::clamp(std::ceil(length / side), 1.0, 4 * count) : 1);
    };
    grid.columns = cells(width), grid.rows = cells(height);
    if (static_cast<double>(grid.columns) * grid.rows > 8 * count) grid.columns = grid.rows = 1;
    grid.s0 = all.lo[grid.s], grid.t0 = all.lo[grid.t];
    grid.s_scale = width > 0 ? grid.columns / width : 0, grid.t_scale = height > 0 ? grid.rows / height : 0;

    // Count, then fill. Boxes are enlarged slightly, so that points on borders find the roots of both sides.
    const double margin = rounding * all.diagonal();
    const auto for_cells = [&](const Root& root, const auto& body) {
        if (!has_area(root)) return;  // no point is in it
        const Box box = box_of(root);
        const std::uint32_t c0 = grid.column(box.lo[grid.s] - margin), c1 = grid.column(box.hi[grid.s] + margin);
        const std::uint32_t r0 = grid.row(box.lo[grid.t] - margin), r1 = grid.row(box.hi[grid.t] + margin);
        for (std::uint32_t r = r0; r <= r1; ++r)
            for (std::uint32_t c = c0; c <= c1; ++c) body(r * grid.columns + c);
    };
    grid.first.assign(static_cast<std::size_t>(grid.columns) * grid.rows + 1, 0);
    for (const Root& r : roots) for_cells(r, [&](std::uint32_t i) { ++grid.first[i + 1]; });
    for (std::size_t i = 1; i < grid.first.size(); ++i) grid.first[i] += grid.first[i - 1];
    grid.roots.resize(grid.first.back());
    std::vector<std::uint32_t> next(grid.first.begin(), grid.first.end() - 1);
    for (const Root& r : roots) for_cells(r, [&](std::uint32_t i) { grid.roots[next[i]++] = r; });
    return grid;
}

ElementLocator::Nearest ElementLocator::nearest_root(RegionId region, const Point& p) const {
    Nearest nearest;
    const std::int32_t g = grid_of_[region.value];
    if (g >= 0) {
        const Grid& grid = grids_[static_cast<std::size_t>(g)];
        nearest.look_at(grid.cell(grid.row(p[grid.t]) * grid.columns + grid.column(p[grid.s])), p);
        const double margin =
            rounding * (1 / std::max(grid.s_scale, min_divisor) + 1 / std::max(grid.t_scale, min_divisor));
        // The point is outside all roots of its cell by more than rounding. This is rare, and any root may be the
        // nearest.
        if (!nearest.root || !(nearest.distance <= margin * margin)) nearest.look_at(roots(region), p);
    } else {
        nearest.look_at(roots(region), p);
    }
    return nearest;
}

void ElementLocator::find_root(RegionId region, const Point& p, LeafFinder::Query& out) const {
    const std::span<const Root> mine = roots(region);
    if (mine.size() == 1) {
        out.root = mine[0].number, out.uv = mine[0].held(mine[0].coordinates(p));
        return;
    }
    const Nearest nearest = nearest_root(region, p);
    EXI_ASSERT(nearest.root != nullptr);
    out.root = nearest.root->number, out.uv = nearest.uv;
}

LeafFinder::Found ElementLocator::find_leaf(RegionId region, const Point& p) const {
    const Nearest nearest = nearest_root(region, p);
    if (!nearest.root) return {no_leaf, {}};
    return leaves_.find(nearest.root->number, nearest.uv);
}

ElementTree::Place ElementLocator::find(RegionId region, const Point& p) const {
    const auto [leaf, uv] = find_leaf(region, p);
    if (leaf == no_leaf) return {ElementId(), {}};
    return {leaves_.id(leaf), uv};
}

}  // namespace exitance
