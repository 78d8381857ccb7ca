#include "exitance/mesh/solve_mesh.hpp"

#include "exitance/base/bvh.hpp"
#include "exitance/base/error_share.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/mesh/contact_lines.hpp"

namespace exitance {
namespace {

/// Returns whether a length exceeds a limit by more than the rounding of coordinates in files. Scenes whose lengths are
/// multiples of the mesh size are then split the same way in every orientation.
bool exceeds(double length, double limit) {
    constexpr double rounding = 1e-6;  // allowed excess, as a share of the limit; derived from files with six digits
    return length > (1 + rounding) * limit;
}

/// Splits every leaf below `root` that a line crosses. The line is given in the root's coordinates.
void cut_leaves(ElementTree& tree, ElementId root, const CutLine& line) {
    const Patch frame = tree.patch(root);
    std::vector<ElementId> open = {root};
    while (!open.empty()) {
        const ElementId e = open.back();
        open.pop_back();
        for (ElementId child : tree.children(e)) open.push_back(child);
        if (!tree.is_leaf(e)) continue;
        // Frames of cells are parallel to their root's: (u, v) of the root = o + (s u', t v').
        const Patch& patch = tree.patch(e);
        const Vec2 o = frame.coordinates(patch.origin);
        const Vec2 corner = frame.coordinates(patch.origin + patch.a + patch.b) - o;
        const CutLine own{{line.normal.x * corner.x, line.normal.y * corner.y}, line.offset - dot(line.normal, o)};
        // Chosen: half of it and twice it give the same mesh, measured by `exitance solve complex2.obj --error 0.03`
        // (complex m=2).
        constexpr double min_share = 1e-4;
        tree.split_by_line(e, own, min_share);
    }
}

/// Splits one piece and its parts until the size is met.
class Cutter {
  public:
    Cutter(ElementTree& tree, MeshSize size) : tree_(tree), size_(size) {}

    /// `concave`: concave borders of the piece.
    void refine(ElementId e, const ConcaveBorders& concave) {
        std::array<bool, 4> touches{};
        for (std::size_t i = 0; i < concave.size(); ++i) {
            strip_[i] = strip_width(concave[i]);
            touches[i] = concave[i] == 1 || strip_[i] < size_.edge;
        }
        if (!tree_.patch(e).is_triangle()) {
            std::array<bool, 4> open;
            for (std::size_t i = 0; i < 4; ++i) open[i] = !touches[i] && size_.longest_end > 0;
            return refine_parallelogram(e, touches, open);
        }
        if (touches[0] || touches[1] || touches[2])
            grade_triangle(e, touches);
        else
            refine_triangle(e);
    }

  private:
    /// Width of the narrowest elements along a border, metres. The error that a strip of width w leaves is proportional
    /// to rise w^1.2 (see `knobs_for_error`), and is the same along all borders.
    double strip_width(double rise) const {
        constexpr double exponent = 1.2;  // derived from the singularity of the light, as above
        return size_.edge / std::pow(2.0, size_.grading_levels) / std::pow(rise, 1 / exponent);
    }

    /// `open`: which borders of the element are on other borders of its piece, whose ends are graded, too.
    void refine_parallelogram(ElementId e, std::array<bool, 4> touches, std::array<bool, 4> open) {
        const double a = norm(tree_.patch(e).a), b = norm(tree_.patch(e).b);
        const auto strip_at = [&](std::size_t i, std::size_t j) {
            return std::min(touches[i] ? strip_[i] : HUGE_VAL, touches[j] ? strip_[j] : HUGE_VAL);
        };
        const double along_u = strip_at(0, 2), along_v = strip_at(1, 3);
        const bool end_of_u = open[1] || open[3], end_of_v = open[0] || open[2];
        const bool cut_u = exceeds(a, std::min(size_.edge, along_v)) ||
                           (end_of_u && exceeds(a, size_.longest_end * std::max(b, along_u)));
        const bool cut_v = exceeds(b, std::min(size_.edge, along_u)) ||
                           (end_of_v && exceeds(b, size_.longest_end * std::max(a, along_v)));
        if (!cut_u && !cut_v) return;
        const Cut kind = cut_u && cut_v ? Cut::both : cut_u ? Cut::u : Cut::v;
        tree_.split(e, kind);
        const IdRange<ElementId> children = tree_.children(e);
        for (std::size_t i = 0; i < children.size(); ++i) {
            const bool right = kind == Cut::both ? i % 2 == 1 : kind == Cut::u && i == 1;
            const bool top = kind == Cut::both ? i >= 2 : kind == Cut::v && i == 1;
            std::array<bool, 4> t = touches, o = open;  // borders: bottom v = 0, right u = 1, top v = 1, left u = 0
            const std::size_t inner_u = right ? 3 : 1, inner_v = top ? 0 : 2;
            if (kind != Cut::v) t[inner_u] = o[inner_u] = false;
            if (kind != Cut::u) t[inner_v] = o[inner_v] = false;
            refine_parallelogram(children[i], t, o);
        }
    }

    void refine_triangle(ElementId e) {
        const Patch& p = tree_.patch(e);
        if (!exceeds(std::max({norm(p.a), norm(p.b), norm(p.b - p.a)}), size_.edge)) return;
        tree_.split(e, Cut::both);
        for (ElementId child : tree_.children(e)) refine_triangle(child);
    }

    /// Cuts strips along the concave borders, each twice as wide as the previous one; then splits all cells to size.
    void grade_triangle(ElementId e, std::array<bool, 4> touches) {
        const Patch p = tree_.patch(e);
        const double edge[3] = {norm(p.a), norm(p.b - p.a), norm(p.b)};
        for (std::size_t border = 0; border < 3; ++border) {
            if (!touches[border]) continue;
            const double height = 2 * p.area() / edge[border];
            // Widest strip, as a share of the height. Chosen: half of it makes 1% fewer elements and twice it the
            // same number, measured by `exitance solve complex2.obj --error 0.03` (complex m=2).
            constexpr double widest = 0.4;
            for (double d = strip_[border]; d <= std::min(0.5 * size_.edge, widest * height); d *= 2) {
                const double t = d / height;  // the coordinate that is 0 on the border and 1 at the opposite corner
                const CutLine lines[3] = {{{0, 1}, t}, {{-1, -1}, t - 1}, {{1, 0}, t}};
                cut_leaves(tree_, e, lines[border]);
            }
        }
        shorten(e);
    }

    void shorten(ElementId e) {
        for (ElementId child : tree_.children(e)) shorten(child);
        if (!tree_.is_leaf(e)) return;
        const std::vector<Point> outline = tree_.outline(e);
        double longest = 0;
        for (const Point& a : outline)
            for (const Point& b : outline) longest = std::max(longest, norm(a - b));
        // Chosen: half of it makes 45% more elements for 10% more rays and twice it 10% fewer elements, measured by
        // `exitance solve complex2.obj --error 0.03` (complex m=2).
        constexpr double longer = 1.3;
        if (!exceeds(longest, longer * size_.edge)) return;
        for (ElementId child : refine_element(tree_, e)) shorten(child);
    }

    ElementTree& tree_;
    MeshSize size_;
    std::array<double, 4> strip_{};  ///< Width of the narrowest elements along each border of the piece, metres.
};

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Vec3 d = b - a;
    const double t = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
    return norm(p - (a + t * d));
}

/// Returns how far a surface rises (ConcaveBorders) if it contains `p` or touches it within `tolerance` (metres),
/// extends in front of `plane`, and faces the point `inside`; else 0.
double rise_at(const Scene& scene, SurfaceId s, const Point& p, const Plane& plane, const Point& inside,
               double tolerance) {
    const Surface& surface = scene.surfaces()[s];
    const std::span<const Point> outline = scene.outline(s);
    if (std::abs(dot(surface.normal, p - outline[0])) > tolerance) return 0;
    constexpr double rounding = 1e-6;  // derived from files with six digits: normals at right angles
    const double rise = std::min(1.0, (1 + rounding) * (1 - dot(surface.normal, plane.n)));
    const bool in_front = std::any_of(outline.begin(), outline.end(),
                                      [&](const Point& q) { return plane.signed_distance(q) > 4 * tolerance; });
    const bool faces_inside = dot(surface.normal, inside - outline[0]) > 4 * tolerance;
    if (!in_front || !faces_inside) return 0;
    if (contains(outline, surface.normal, p)) return rise;
    for (std::size_t i = 0; i < outline.size(); ++i)
        if (distance_to_segment(p, outline[i], outline[(i + 1) % outline.size()]) <= tolerance) return rise;
    return 0;
}

}  // namespace

std::vector<ConcaveBorders> find_concave_borders(const Scene& scene, const std::vector<Piece>& pieces,
                                                 double multiplicity) {
    std::vector<Box> boxes(scene.surfaces().size());
    for (SurfaceId s : scene.surfaces().ids())
        for (const Point& corner : scene.outline(s)) boxes[s.value].add(corner);
    const Bvh bvh(boxes);
    // Derived from scenes: with the middle, two places at which regular objects rarely end.
    constexpr std::array places_on_border{0.5, 0.18, 0.83};
    const double tolerance = contact_share * scene.size();
    const auto rise_beside = [&](const Piece& piece, int border) {
        const Patch& patch = piece.patch;
        const Plane& plane = scene.regions()[piece.region].plane;
        const Point inside = patch.centre();
        const Point a = patch.corner(border), b = patch.corner((border + 1) % patch.corner_count());
        double rise = 0;
        for (double t : places_on_border) {
            const Point p = a + t * (b - a);
            Box box;
            box.add(p - Vec3{tolerance, tolerance, tolerance});
            box.add(p + Vec3{tolerance, tolerance, tolerance});
            bvh.visit_box(box, [&](std::uint32_t i) {
                const SurfaceId s(i);
                if (rise < 1 && scene.surfaces()[s].region != piece.region)
                    rise = std::max(rise, rise_at(scene, s, p, plane, inside, tolerance));
            });
            if (rise > 0) break;
        }
        return rise;
    };
    double area = 0;
    for (const Piece& piece : pieces) area += piece.patch.area();
    // Small pieces among thousands are narrower than the strips along concave borders, and stay whole.
    const bool is_crowd = ErrorShare::is_crowd(pieces.size(), pieces.size(), multiplicity);
    const double small = is_crowd ? ErrorShare::small_area(area, pieces.size(), multiplicity) : 0;
    std::vector<ConcaveBorders> out(pieces.size());
    parallel_for(pieces.size(), 64, [&](std::size_t k) {
        if (pieces[k].patch.area() < small) return;
        for (int border = 0; border < pieces[k].patch.corner_count(); ++border)
            out[k].push_back(rise_beside(pieces[k], border));
    });
    return out;
}

ElementTree make_mesh(const std::vector<Piece>& pieces, const std::vector<ConcaveBorders>& concave, MeshSize size,
                      const Field<RegionId, std::uint8_t>& whole, const std::vector<double>& finer) {
    ElementTree tree;
    for (const auto& [region, patch] : pieces) tree.add_root(region, patch);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (whole.size() > 0 && whole[pieces[k].region]) continue;
        MeshSize own = size;
        if (!finer.empty()) own.edge /= finer[k];
        Cutter(tree, own).refine(tree.roots()[k], concave[k]);
    }
    return tree;
}

std::size_t predict_elements(const std::vector<Piece>& pieces, double edge) {
    double count = 0;
    const auto parts = [&](double length) {
        double n = 1;
        while (exceeds(length, n * edge)) n *= 2;
        return n;
    };
    for (const auto& [region, patch] : pieces) {
        const double a = parts(norm(patch.a)), b = parts(norm(patch.b));
        count += patch.is_triangle() ? std::max(a, b) * std::max(a, b) : a * b;
    }
    return static_cast<std::size_t>(count);
}

double edge_for_elements(const std::vector<Piece>& pieces, std::size_t count) {
    double longest = 0;
    for (const auto& [region, patch] : pieces) longest = std::max({longest, norm(patch.a), norm(patch.b)});
    // The first edge is a little longer than the longest extent; derived from rounding. Each step makes about sqrt(2)
    // times as many elements.
    constexpr double above_one = 1.0001, step = 0.84;
    double edge = above_one * longest;
    while (predict_elements(pieces, edge) < count) edge *= step;
    return edge;
}

LeafNumbering::LeafNumbering(const ElementTree& tree) : leaves(tree.leaves()), number(tree.size()) {
    for (std::size_t i = 0; i < leaves.size(); ++i) number[leaves[i]] = static_cast<std::uint32_t>(i);
}

std::vector<double> leaf_areas(const ElementTree& tree, const LeafNumbering& numbering) {
    std::vector<double> area;
    area.reserve(numbering.leaves.size());
    for (ElementId e : numbering.leaves) area.push_back(tree.area(e));
    return area;
}

}  // namespace exitance
