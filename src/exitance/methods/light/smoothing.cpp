#include "exitance/methods/light/smoothing.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

/// A slope in the plane of a leaf: the value at x is that at the centre plus s (x - centre) . a + t (x - centre) . b.
struct Slope {
    Spectrum s, t;

    Spectrum at(Vec2 d) const { return d.x * s + d.y * t; }
    double steepness() const { return squared(s) + squared(t); }
};

/// A leaf and its neighbours.
class Surroundings {
  public:
    Surroundings(const GlobalLight& light, const ElementLocator& locator, std::size_t leaf)
        : light_(light), tree_(light.tree), element_(light.numbering.leaves[leaf]), value_(light.indirect[leaf]) {
        const Patch& patch = tree_.patch(element_);
        middle_ = patch.at(tree_.centre(element_));
        a_ = normalized(patch.a);
        b_ = normalized(patch.b - dot(patch.b, a_) * a_);
        outline_ = tree_.outline(element_);
        for (std::size_t i = 0; i < outline_.size(); ++i) {
            const Point border = 0.5 * (outline_[i] + outline_[(i + 1) % outline_.size()]);
            add_neighbour(locator, border);
        }
    }

    Slope slope() const {
        Slope best;
        double least = HUGE_VAL;
        const std::size_t n = neighbours_.size();
        if (n == 1) return along(neighbours_[0]);
        for (std::size_t i = 0; i < n; ++i) {
            const Neighbour &p = neighbours_[i], &q = neighbours_[(i + 1) % n];
            const double det = cross(p.offset, q.offset);
            // derived from rounding: neighbours in nearly the same direction do not determine a slope
            if (det * det < 0.01 * dot(p.offset, p.offset) * dot(q.offset, q.offset)) continue;
            const Spectrum dp = p.value - value_, dq = q.value - value_;
            const Slope plane{(q.offset.y / det) * dp - (p.offset.y / det) * dq,
                              (p.offset.x / det) * dq - (q.offset.x / det) * dp};
            if (plane.steepness() < least) least = plane.steepness(), best = plane;
        }
        if (least == HUGE_VAL && n > 0) best = along(neighbours_[0]);
        return limited(best);
    }

    Vec2 offset(const Point& x) const { return {dot(x - middle_, a_), dot(x - middle_, b_)}; }

  private:
    struct Neighbour {
        Vec2 offset;
        Spectrum value;
    };

    void add_neighbour(const ElementLocator& locator, const Point& border) {
        const Point across =
            middle_ +
            1.25 * (border - middle_);  // derived from neighbours of half the size: a point inside any of them
        const ElementTree::Place place = locator.find(tree_.region(element_), across);
        const double tolerance = 1e-6 * norm(border - middle_);  // derived from the rounding of positions
        if (place.element == element_ || norm(tree_.patch(place.element).at(place.uv) - across) > tolerance) {
            walls_.push_back(2.0 * offset(border));
            return;
        }
        const Point centre = tree_.patch(place.element).at(tree_.centre(place.element));
        neighbours_.push_back({offset(centre), light_.indirect[light_.numbering.number[place.element]]});
    }

    Slope along(const Neighbour& n) const {
        const Spectrum step = (1 / dot(n.offset, n.offset)) * (n.value - value_);
        return {n.offset.x * step, n.offset.y * step};
    }

    /// Limits a slope so that values at the corners stay between those of the neighbours. Beyond a wall, the slope's
    /// own extrapolation counts as a neighbour.
    Slope limited(Slope slope) const {
        Spectrum least = value_, largest = value_;
        const auto include = [&](const Spectrum& v) {
            for (std::size_t k = 0; k < bands; ++k)
                least[k] = std::min(least[k], std::max(0.0, v[k])), largest[k] = std::max(largest[k], v[k]);
        };
        for (const Neighbour& n : neighbours_) include(n.value);
        for (const Vec2 wall : walls_) include(value_ + slope.at(wall));
        Spectrum share(1.0);
        for (const Point& corner : outline_) {
            const Spectrum step = slope.at(offset(corner));
            for (std::size_t k = 0; k < bands; ++k) {
                const double room = step[k] > 0 ? largest[k] - value_[k] : least[k] - value_[k];
                if (std::abs(step[k]) > std::abs(room)) share[k] = std::min(share[k], room / step[k]);
            }
        }
        return {share * slope.s, share * slope.t};
    }

    const GlobalLight& light_;
    const ElementTree& tree_;
    ElementId element_;
    Spectrum value_;
    Point middle_;
    Vec3 a_, b_;
    std::vector<Point> outline_;
    std::vector<Neighbour> neighbours_;  ///< Neighbours across the edges, in the order of the edges.
    std::vector<Vec2> walls_;            ///< Per edge without a neighbour: where a neighbour's centre would be.
};

}  // namespace

ElementFunction smoothed_on_leaves(const GlobalLight& light, std::size_t region_count) {
    const std::vector<ElementId>& leaves = light.numbering.leaves;
    const ElementLocator locator(light.tree, region_count);
    std::vector<std::array<Spectrum, 4>> corners(leaves.size());
    parallel_for(leaves.size(), 64, [&](std::size_t i) {
        const Surroundings around(light, locator, i);
        const Slope slope = around.slope();
        const Patch& patch = light.tree.patch(leaves[i]);
        for (int k = 0; k < patch.corner_count(); ++k)
            corners[i][static_cast<std::size_t>(k)] = light.indirect[i] + slope.at(around.offset(patch.corner(k)));
    });
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        out.first_value[leaves[i]] = static_cast<std::uint32_t>(out.values.size());
        for (int k = 0; k < out.tree.patch(leaves[i]).corner_count(); ++k)
            out.add_value(corners[i][static_cast<std::size_t>(k)]);
    }
    return out;
}

}  // namespace exitance
