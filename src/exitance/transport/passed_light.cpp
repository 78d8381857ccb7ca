#include "exitance/transport/passed_light.hpp"

#include <algorithm>

#include "exitance/base/bvh.hpp"
#include "exitance/base/quadrature.hpp"
#include "exitance/basis/small_system.hpp"

namespace exitance {

/// Makes the rows of all panes of a scene.
class PassedLight::Maker {
  public:
    Maker(PassedLight& out, const Scene& scene, const ElementTree& tree, std::span<const ElementId> elements,
          int degree, const Interpolate& interpolate)
        : out_(out),
          scene_(scene),
          tree_(tree),
          elements_(elements),
          interpolate_(interpolate),
          rule_(triangle_rule(4 * degree)) {}

    void run() {
        Field<RegionId, std::vector<std::uint32_t>> of_region(scene_.regions().size());
        for (std::uint32_t i = 0; i < elements_.size(); ++i)
            if (const RegionId r = tree_.region(elements_[i]); !scene_.behind(r).is_none()) of_region[r].push_back(i);
        for (const RegionId r : scene_.regions().ids()) {
            if (of_region[r].empty()) continue;
            const RegionId behind = scene_.behind(r);
            outlines_.clear();
            std::vector<Box> boxes;
            for (const std::uint32_t i : of_region[behind]) {
                outlines_.push_back(tree_.outline(elements_[i]));
                Box& box = boxes.emplace_back();
                for (const Point& p : outlines_.back()) box.add(p);
            }
            const Bvh index(boxes);
            for (const std::uint32_t i : of_region[r]) add_row(i, r, behind, of_region[behind], index);
        }
        std::sort(out_.rows_.begin(), out_.rows_.end(),
                  [](const Row& a, const Row& b) { return a.element < b.element; });
        out_.row_of_.assign(elements_.size(), none);
        for (std::uint32_t k = 0; k < out_.rows_.size(); ++k) out_.row_of_[out_.rows_[k].element] = k;
    }

  private:
    /// Sets part_ to the intersection of an element and one behind it.
    void meet(std::span<const Point> outline, std::span<const Point> other, const Normal& n) {
        part_.assign(outline.begin(), outline.end());
        for (std::size_t k = 0; k < other.size() && !part_.empty(); ++k) {
            const Vec3 edge = other[(k + 1) % other.size()] - other[k], inward = cross(n, edge);
            if (norm(inward) == 0) continue;
            const Normal side = normalized(inward);
            clip(part_, {side, dot(side, other[k])}, buffer_);
            std::swap(part_, buffer_);
        }
        if (part_.size() < 3) part_.clear();
    }

    void add_row(std::uint32_t i, RegionId own, RegionId behind, const std::vector<std::uint32_t>& others,
                 const Bvh& index) {
        // Share of an element's area, and of its extent. Derived from double precision, with a margin for cut points.
        constexpr double rounding = 1e-9;
        const ElementId e = elements_[i];
        const std::vector<Point> outline = tree_.outline(e);
        Box box;
        for (const Point& p : outline) box.add(p);
        const Vec3 slack = Vec3{1, 1, 1} * (rounding * box.diagonal());
        std::vector<std::uint32_t> near;
        index.visit_box({box.lo - slack, box.hi + slack}, [&](std::uint32_t k) { near.push_back(k); });
        std::sort(near.begin(), near.end());
        Row row{i, scene_.material(own).through, static_cast<std::uint32_t>(out_.terms_.size()), 0};
        const std::size_t n = out_.nodes_, first_weight = out_.weights_.size();
        gram_.assign(n * n, 0.0);
        for (const std::uint32_t k : near) {
            meet(outline, outlines_[k], scene_.regions()[behind].plane.n);
            if (part_.empty() || norm(area_vector(part_)) < rounding * tree_.area(e)) continue;
            out_.terms_.push_back({others[k], out_.weights_.size()});
            out_.weights_.resize(out_.weights_.size() + n * n, 0.0);
            integrate(e, elements_[others[k]], &out_.weights_[out_.terms_.back().weights]);
        }
        row.last = static_cast<std::uint32_t>(out_.terms_.size());
        if (row.first == row.last) return;
        for (std::size_t k = 0; k < n; ++k)
            if (gram_[k * n + k] > 0)
                // Regularizes functions that slivers hardly determine; derived from rounding.
                gram_[k * n + k] *= n > 1 ? 1 + 1e-12 : 1;
            else
                gram_[k * n + k] = 1;  // diagonal entry for values that an element does not use
        std::vector<double> weights(out_.weights_.begin() + static_cast<std::ptrdiff_t>(first_weight),
                                    out_.weights_.end());
        for (std::size_t t = 0; t < weights.size(); t += n * n) {
            std::vector<double> gram = gram_, of_term(weights.begin() + static_cast<std::ptrdiff_t>(t),
                                                      weights.begin() + static_cast<std::ptrdiff_t>(t + n * n));
            solve_in_place(gram, of_term, n, n);
            std::copy(of_term.begin(), of_term.end(),
                      out_.weights_.begin() + static_cast<std::ptrdiff_t>(first_weight + t));
        }
        out_.rows_.push_back(row);
    }

    /// Integrates over part_: adds the products of the element's own functions to gram_, and sets `products` to those
    /// of its functions with the functions behind.
    void integrate(ElementId e, ElementId other, double* products) {
        const std::size_t n = out_.nodes_;
        std::vector<double> own(n, 1.0), behind(n, 1.0);
        for (std::size_t c = 2; c < part_.size(); ++c) {
            const Vec3 a = part_[c - 1] - part_[0], b = part_[c] - part_[0];
            const double area = 0.5 * norm(cross(a, b));
            for (const PlanarNode& node : rule_) {
                if (interpolate_) {
                    const Point x = part_[0] + node.at.x * a + node.at.y * b;
                    interpolate_(e, x, own), interpolate_(other, x, behind);
                }
                for (std::size_t k = 0; k < n; ++k)
                    for (std::size_t l = 0; l < n; ++l) {
                        gram_[k * n + l] += node.weight * area * own[k] * own[l];
                        products[k * n + l] += node.weight * area * own[k] * behind[l];
                    }
            }
        }
    }

    PassedLight& out_;
    const Scene& scene_;
    const ElementTree& tree_;
    std::span<const ElementId> elements_;
    const Interpolate& interpolate_;
    std::span<const PlanarNode> rule_;
    std::vector<std::vector<Point>> outlines_;  ///< Outlines of the elements of the side behind.
    std::vector<Point> part_, buffer_;
    std::vector<double> gram_;
};

PassedLight::PassedLight(const Scene& scene, const ElementTree& tree, std::span<const ElementId> elements)
    : PassedLight(scene, tree, elements, 1, 0, {}) {}

PassedLight::PassedLight(const Scene& scene, const ElementTree& tree, std::span<const ElementId> elements,
                         std::size_t nodes, int degree, const Interpolate& interpolate)
    : nodes_(nodes) {
    if (scene.has_diffusing_panes()) Maker(*this, scene, tree, elements, degree, interpolate).run();
}

}  // namespace exitance
