#include "exitance/gather/bright_places.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "exitance/base/parallel.hpp"
#include "exitance/gather/gather.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_cells = 12;  ///< Rectangles in the planes of bright surfaces, in a room.
constexpr std::size_t max_boxes = 16;  ///< Boxes around bright surfaces, in a room.

/// A leaf that is bright for its room, in the plane coordinates of its region.
struct BrightLeaf {
    std::array<Vec2, 4> corners;
    int corner_count;
    Vec2 centre;
    double area, light;  ///< Area, m^2, and b relative to the mean of the room.
};

/// A rectangle around some bright leaves.
struct Cover {
    std::vector<BrightLeaf> leaves;
    Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};
    double filled = 0;  ///< Area of the leaves, m^2.
    double flux = 0;    ///< Sum of area times light of the leaves.
    double square = 0;  ///< Sum of area times the square of light.

    void add(const BrightLeaf& leaf) {
        for (int i = 0; i < leaf.corner_count; ++i) {
            const Vec2 p = leaf.corners[static_cast<std::size_t>(i)];
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)}, hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
        }
        filled += leaf.area, flux += leaf.area * leaf.light, square += leaf.area * leaf.light * leaf.light;
        leaves.push_back(leaf);
    }
    double area() const { return (hi.x - lo.x) * (hi.y - lo.y); }
    /// Rays that miss the leaves, times the light for which they are aimed; long rectangles count as if they were
    /// square, since rays are not aimed at a rectangle that is nearer than its length.
    double waste() const {
        const double longer = std::max(hi.x - lo.x, hi.y - lo.y);
        return leaves.size() > 1 ? (longer * longer - filled) * flux / filled : 0;
    }
    /// Two halves of the leaves, divided across the longer side.
    std::array<Cover, 2> halves() const {
        const bool along_x = hi.x - lo.x >= hi.y - lo.y;
        const double middle = along_x ? 0.5 * (lo.x + hi.x) : 0.5 * (lo.y + hi.y);
        std::array<Cover, 2> out;
        for (const BrightLeaf& leaf : leaves) out[(along_x ? leaf.centre.x : leaf.centre.y) > middle].add(leaf);
        return out;
    }
};

/// A cover in the 2D coordinates of a plane, with this plane.
struct PlacedCover {
    Cover cover;
    Point origin;
    Frame frame{Normal{0, 0, 1}};

    PortalCell cell() const {
        const auto in_space = [&](Vec2 p) { return p.x * frame.u + p.y * frame.v; };
        const Vec2 size = cover.hi - cover.lo;
        return {origin + in_space(cover.lo), size.x * frame.u, size.y * frame.v, frame.n, cover.area(),
                cover.flux / cover.area()};
    }
};

/// Light of the leaves of one room.
struct RoomLight {
    double area = 0, flux = 0, square = 0;              ///< Sums of area, area b and area b^2.
    double bright_square = 0;                           ///< The last one over bright leaves.
    std::map<RegionId, std::vector<ElementId>> bright;  ///< Listed by region, in the order of regions.
};

/// Frame of a region along an edge of an element, so that elements that follow walls are covered without waste.
Frame frame_along(const ElementTree& tree, ElementId e, const Normal& n) {
    const Patch& patch = tree.patch(e);
    const Vec3 edge = normalized(patch.corner(1) - patch.corner(0));
    Frame out(n);
    out.u = edge, out.v = cross(n, edge);
    return out;
}

PlacedCover cover_region(const Stage& stage, const ElementTree& tree, RegionId region,
                         std::span<const ElementId> leaves, const Field<ElementId, double>& light) {
    const ElementId first = leaves.front();
    PlacedCover out{{}, tree.patch(first).corner(0), frame_along(tree, first, stage.scene.regions()[region].plane.n)};
    const auto in_plane = [&](const Point& p) {
        return Vec2{dot(p - out.origin, out.frame.u), dot(p - out.origin, out.frame.v)};
    };
    for (ElementId e : leaves) {
        const Patch& patch = tree.patch(e);
        BrightLeaf leaf{{}, patch.corner_count(), in_plane(patch.at(tree.centre(e))), tree.area(e), light[e]};
        for (int i = 0; i < leaf.corner_count; ++i)
            leaf.corners[static_cast<std::size_t>(i)] = in_plane(patch.corner(i));
        out.cover.add(leaf);
    }
    return out;
}

/// Divides the cover with the largest waste until there are enough.
void divide(std::vector<PlacedCover>& covers) {
    while (!covers.empty() && covers.size() < max_cells) {
        const auto worst = std::max_element(covers.begin(), covers.end(), [](const auto& a, const auto& b) {
            return a.cover.waste() < b.cover.waste();
        });
        // Stop splitting at a rectangle as good as one of two squares that its leaves fill.
        if (worst->cover.waste() <= 3 * worst->cover.flux) break;
        auto [one, other] = worst->cover.halves();
        if (one.leaves.empty() || other.leaves.empty()) break;
        PlacedCover second{std::move(other), worst->origin, worst->frame};
        worst->cover = std::move(one);
        covers.push_back(std::move(second));
    }
}

/// A box around bright leaves of many planes, like the inside of a lamp's reflector: every ray to them passes through
/// its sides.
struct BrightBox {
    std::vector<ElementId> leaves;
    Box box;
    double flux = 0, square = 0;  ///< Sums of area times light and of area times its square.

    void add(const ElementTree& tree, ElementId e, double light) {
        const Patch& patch = tree.patch(e);
        for (int i = 0; i < patch.corner_count(); ++i) box.add(patch.corner(i));
        const double area = tree.area(e);
        flux += area * light, square += area * light * light;
        leaves.push_back(e);
    }
    /// Sides of the box, or one rectangle if it is flat.
    std::vector<PortalCell> sides() const {
        constexpr double flat = 1e-3;  // share of the longest edge; derived from sides that no ray would be aimed at
        const Vec3 size = box.hi - box.lo;
        const double longest = std::max({size.x, size.y, size.z});
        const double largest = std::max({size.x * size.y, size.y * size.z, size.z * size.x});
        std::vector<PortalCell> out;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            if (std::min(size[i], size[j]) < flat * longest && size[i] * size[j] < largest) continue;
            PortalCell side{box.lo, {}, {}, Normal{0, 0, 0}, size[i] * size[j], 0};
            side.u[i] = size[i], side.v[j] = size[j], side.n[k] = 1;
            out.push_back(side);
            if (size[k] < flat * longest) continue;
            side.corner[k] = box.hi[k];
            out.push_back(side);
        }
        for (PortalCell& side : out) side.light = flux / shown();
        return out;
    }
    /// Twice the mean area of the box as seen from all around, m^2.
    double shown() const {
        const Vec3 size = box.hi - box.lo;
        return size.x * size.y + size.y * size.z + size.z * size.x;
    }
    /// Measure of the noise. Every ray passes through two sides, unless the box is flat.
    double noise() const { return leaves.empty() ? 0 : (sides().size() > 1 ? 2 : 1) * std::sqrt(shown() * square); }
    std::array<BrightBox, 2> halves(const ElementTree& tree, const Field<ElementId, double>& light) const {
        const Vec3 size = box.hi - box.lo;
        const std::size_t k = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
        const double middle = 0.5 * (box.lo[k] + box.hi[k]);
        std::array<BrightBox, 2> out;
        for (ElementId e : leaves) out[tree.patch(e).at(tree.centre(e))[k] > middle].add(tree, e, light[e]);
        return out;
    }
};

/// Surrounds the bright leaves of a room by boxes, which are divided while that lowers the noise of aimed rays.
std::vector<BrightBox> boxes_around(const ElementTree& tree, const RoomLight& room,
                                    const Field<ElementId, double>& light) {
    std::vector<BrightBox> open(1), out;
    for (const auto& [region, leaves] : room.bright)
        for (ElementId e : leaves) open[0].add(tree, e, light[e]);
    while (!open.empty()) {
        const auto worst = std::max_element(
            open.begin(), open.end(), [](const BrightBox& a, const BrightBox& b) { return a.noise() < b.noise(); });
        BrightBox box = std::move(*worst);
        open.erase(worst);
        if (open.size() + out.size() + 2 <= max_boxes) {
            std::array<BrightBox, 2> halves = box.halves(tree, light);
            // Boxes that are much smaller than the space between them are worth the comparisons with each ray.
            constexpr double worth = 0.7;  // derived from halves of a box that its leaves fill evenly, which have more
            const bool are_two = !halves[0].leaves.empty() && !halves[1].leaves.empty();
            if (are_two && halves[0].noise() + halves[1].noise() < worth * box.noise()) {
                for (BrightBox& half : halves) open.push_back(std::move(half));
                continue;
            }
        }
        out.push_back(std::move(box));
    }
    return out;
}

/// Returns the parallelograms that cover the bright leaves of a room. Noise is compared by its standard deviation if
/// rays are shared out best: the sum over parallelograms of the root of area times sum of squares.
std::vector<PortalCell> cells_of_room(const Stage& stage, const ElementTree& tree, const RoomLight& room,
                                      const Field<ElementId, double>& light) {
    std::vector<PlacedCover> covers;
    for (const auto& [region, of_region] : room.bright)
        covers.push_back(cover_region(stage, tree, region, of_region, light));
    std::stable_sort(covers.begin(), covers.end(), [](const PlacedCover& a, const PlacedCover& c) {
        return a.cover.flux * a.cover.flux / a.cover.filled > c.cover.flux * c.cover.flux / c.cover.filled;
    });
    double missed = 0, noise = 0;
    for (std::size_t i = max_cells; i < covers.size(); ++i) missed += covers[i].cover.square;
    if (covers.size() > max_cells) covers.resize(max_cells);
    divide(covers);
    std::vector<PortalCell> out;
    for (const PlacedCover& cover : covers) {
        out.push_back(cover.cell());
        noise += std::sqrt(cover.cover.area() * cover.cover.square);
    }
    noise += std::sqrt(room.area * missed);
    const std::vector<BrightBox> boxes = boxes_around(tree, room, light);
    double noise_of_boxes = 0;
    for (const BrightBox& box : boxes) noise_of_boxes += box.noise();
    if (noise_of_boxes >= noise) return out;
    out.clear();
    for (const BrightBox& box : boxes)
        for (const PortalCell& side : box.sides()) out.push_back(side);
    return out;
}

/// b on one leaf, W/m^2, mean over the bands.
struct LeafLight {
    double mean = 0, largest = 0;
};

/// Reads b near the corners and at the centre of every leaf, so that leaves at the border of a bright place are known.
std::vector<LeafLight> light_of_leaves(const ElementTree& tree, std::span<const ElementId> leaves,
                                       const ReflectedLight& b) {
    constexpr double inside = 0.1;  // distance from the border; derived from samples, which are slightly inside it
    constexpr std::array<Vec2, 5> places{
        {{0.5, 0.5}, {inside, inside}, {1 - inside, inside}, {inside, 1 - inside}, {1 - inside, 1 - inside}}};
    std::vector<LeafLight> out(leaves.size());
    parallel_ranges(leaves.size(), 1024, [&](std::size_t first, std::size_t last) {
        std::vector<RayEnd> points;
        for (std::size_t i = first; i < last; ++i)
            for (const Vec2& p : places)
                points.push_back({tree.patch(leaves[i]).at(tree.uniform(leaves[i], p.x, p.y)), tree.region(leaves[i])});
        std::vector<Spectrum> values(points.size());
        b.read(points, values);
        for (std::size_t k = 0; k < values.size(); ++k) {
            LeafLight& leaf = out[first + k / places.size()];
            const double value = mean(values[k]);
            leaf.mean += value / static_cast<double>(places.size()), leaf.largest = std::max(leaf.largest, value);
        }
    });
    return out;
}

}  // namespace

BrightPlaces find_bright_places(const Stage& stage, const ElementTree& tree, const ReflectedLight& b) {
    constexpr double bright = 4;  // multiple of the room's mean light; from there on aiming saves most rays
    const std::vector<ElementId> leaves = tree.leaves();
    const std::vector<LeafLight> values = light_of_leaves(tree, leaves, b);
    std::vector<RoomLight> rooms(std::max<std::size_t>(1, stage.rooms.count()));
    std::vector<std::size_t> room_of;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        RoomLight& room = rooms[room_of.emplace_back(stage.rooms.of(tree, leaves[i]))];
        const double area = tree.area(leaves[i]), value = values[i].mean;
        room.area += area, room.flux += area * value, room.square += area * value * value;
    }
    Field<ElementId, double> light(tree.size(), 0);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        RoomLight& room = rooms[room_of[i]];
        const double usual = room.flux / room.area, value = values[i].mean;
        if (!(usual > 0) || values[i].largest < bright * usual || stage.is_unlit(tree.region(leaves[i]))) continue;
        light[leaves[i]] = value / usual;
        room.bright[tree.region(leaves[i])].push_back(leaves[i]);
        room.bright_square += tree.area(leaves[i]) * value * value;
    }
    std::vector<std::vector<PortalCell>> out(rooms.size());
    for (std::size_t r = 0; r < rooms.size(); ++r) {
        if (const LightPortals* portals = stage.rooms.portals()) {
            const std::span<const PortalCell> cells = portals->of_room(r);
            out[r].assign(cells.begin(), cells.end());
        }
        if (rooms[r].bright_square <= 0.5 * rooms[r].square) continue;
        for (const PortalCell& cell : cells_of_room(stage, tree, rooms[r], light)) out[r].push_back(cell);
    }
    return BrightPlaces(std::move(out));
}

}  // namespace exitance
