#include "exitance/solution/continuous.hpp"

#include <algorithm>

#include "exitance/base/limits.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/quadrature.hpp"
#include "exitance/mesh/conforming.hpp"
#include "exitance/mesh/planes.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Integrals of products of an element's nodal functions (1 at one corner, 0 at the others) over its area: linear ones
/// on a triangle, bilinear ones on a parallelogram.
constexpr double triangle_mass[3][3] = {
    {2. / 24, 1. / 24, 1. / 24}, {1. / 24, 2. / 24, 1. / 24}, {1. / 24, 1. / 24, 2. / 24}};
constexpr double square_mass[4][4] = {{4. / 36, 2. / 36, 1. / 36, 2. / 36},
                                      {2. / 36, 4. / 36, 2. / 36, 1. / 36},
                                      {1. / 36, 2. / 36, 4. / 36, 2. / 36},
                                      {2. / 36, 1. / 36, 2. / 36, 4. / 36}};

Spectrum at_corner(const ElementFunction& f, ElementId e, std::size_t i) {
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = static_cast<double>(f.values[f.first_value[e] + i][b]);
    return out;
}

double quotient(double a, double b) {
    return b > 0 ? a / b : 0;
}

Spectrum quotient(const Spectrum& a, const Spectrum& b) {
    Spectrum out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = quotient(a[k], b[k]);
    return out;
}

/// Least-squares projection on one plane: solves M x = int phi f, where M contains the integrals of products of the
/// nodal functions phi.
class Projection {
  public:
    Projection(const ElementFunction& f, const ElementTree& tree, const SharedNodes& nodes, std::size_t plane,
               std::span<const ElementId> leaves)
        : f_(f), tree_(tree), nodes_(nodes), leaves_(leaves), first_(nodes.first_node[plane]) {
        const std::size_t count = nodes.first_node[plane + 1] - first_;
        right_.resize(count), diagonal_.resize(count);
        for (ElementId e : leaves) area_.push_back(tree.area(e)), add_right_side(e, area_.back());
    }

    /// Solves by conjugate gradients with diagonal preconditioning, starting from the nodes' means. The condition of M
    /// depends neither on sizes nor on the number of elements [Wathen87], so that a dozen steps give single precision.
    std::vector<Spectrum> solve() const {
        constexpr int max_steps = 60;
        // ratio of squared residuals at which to stop; derived from the rounding of single precision
        constexpr double precision = 1e-14;
        const std::size_t count = right_.size();
        std::vector<Spectrum> x(count), r(count), p(count), Mp(count);
        for (std::size_t i = 0; i < count; ++i) x[i] = right_[i] / std::max(mass_of(i), min_divisor);
        multiply(x, Mp);
        Spectrum rz, start;
        for (std::size_t i = 0; i < count; ++i) {
            r[i] = right_[i] - Mp[i];
            p[i] = by_diagonal(i, r[i]);
            rz += r[i] * p[i];
            start += right_[i] * by_diagonal(i, right_[i]);
        }
        for (int step = 0; step < max_steps && max(quotient(rz, start)) > precision; ++step) {
            multiply(p, Mp);
            Spectrum pMp;
            for (std::size_t i = 0; i < count; ++i) pMp += p[i] * Mp[i];
            const Spectrum alpha = quotient(rz, pMp);
            Spectrum next;
            for (std::size_t i = 0; i < count; ++i) {
                x[i] += alpha * p[i];
                r[i] -= alpha * Mp[i];
                next += r[i] * by_diagonal(i, r[i]);
            }
            const Spectrum beta = quotient(next, rz);
            for (std::size_t i = 0; i < count; ++i) p[i] = by_diagonal(i, r[i]) + beta * p[i];
            rz = next;
        }
        return x;
    }

  private:
    std::span<const std::uint32_t> of(ElementId leaf) const { return nodes_.of(leaf, tree_); }

    /// Divides a node's value by its diagonal entry. Returns 0 for a node without elements: such nodes remain if a fan
    /// was not made because it would have triangles without area (`make_conforming`).
    Spectrum by_diagonal(std::size_t i, const Spectrum& value) const {
        return diagonal_[i] > 0 ? value / diagonal_[i] : Spectrum();
    }

    /// int phi dA of a node; proportional to its diagonal entry.
    double mass_of(std::size_t i) const { return lumped_[i]; }

    void add_right_side(ElementId e, double area) {
        const std::span<const std::uint32_t> node = of(e);
        const std::size_t corners = node.size();
        if (lumped_.size() != right_.size()) lumped_.resize(right_.size());
        for (std::size_t i = 0; i < corners; ++i) {
            diagonal_[node[i] - first_] += area * (corners == 3 ? 2 * triangle_mass[0][0] : square_mass[0][0]);
            lumped_[node[i] - first_] += area / static_cast<double>(corners);
        }
        const ElementId parent = tree_.parent(e);
        if (parent.is_none() || tree_.cut_of(parent) != Cut::fan) {
            std::array<Spectrum, 4> value;
            for (std::size_t i = 0; i < corners; ++i) value[i] = at_corner(f_, e, i);
            add_products(e, area, std::span(value).first(corners), right_);
            return;
        }
        // f is at most bilinear on the parent; its product with a linear function has degree 3.
        const Patch &patch = tree_.patch(e), &whole = tree_.patch(parent);
        for (const PlanarNode& place : triangle_rule(3)) {
            const Spectrum value = (area * place.weight) * f_.at({parent, whole.coordinates(patch.at(place.at))});
            const double phi[3] = {1 - place.at.x - place.at.y, place.at.x, place.at.y};
            for (std::size_t i = 0; i < 3; ++i) right_[node[i] - first_] += phi[i] * value;
        }
    }

    /// Adds the integrals of an element's nodal functions times the function with the given corner values.
    void add_products(ElementId e, double area, std::span<const Spectrum> value, std::vector<Spectrum>& out) const {
        const std::span<const std::uint32_t> node = of(e);
        for (std::size_t i = 0; i < node.size(); ++i) {
            Spectrum sum;
            for (std::size_t j = 0; j < node.size(); ++j)
                sum += (node.size() == 3 ? 2 * triangle_mass[i][j] : square_mass[i][j]) * value[j];
            out[node[i] - first_] += area * sum;
        }
    }

    void multiply(const std::vector<Spectrum>& x, std::vector<Spectrum>& out) const {
        std::fill(out.begin(), out.end(), Spectrum());
        std::array<Spectrum, 4> value;
        for (std::size_t k = 0; k < leaves_.size(); ++k) {
            const std::span<const std::uint32_t> node = of(leaves_[k]);
            for (std::size_t i = 0; i < node.size(); ++i) value[i] = x[node[i] - first_];
            add_products(leaves_[k], area_[k], std::span(value).first(node.size()), out);
        }
    }

    const ElementFunction& f_;
    const ElementTree& tree_;
    const SharedNodes& nodes_;
    std::span<const ElementId> leaves_;
    std::vector<double> area_;  ///< Area of each leaf, m^2.
    std::uint32_t first_;
    std::vector<Spectrum> right_;   ///< int phi f dA of every node, W.
    std::vector<double> diagonal_;  ///< int phi^2 dA, m^2.
    std::vector<double> lumped_;    ///< int phi dA, m^2.
};

/// Projects f on all planes and writes the value of every node.
void project(const ElementFunction& f, const ElementTree& tree, const Field<RegionId, std::uint32_t>& plane,
             const SharedNodes& nodes, std::vector<Spectrum>& value) {
    const std::vector<std::vector<ElementId>> leaves = leaves_of_planes(tree, plane);
    shared_parts(value, nodes.first_node, 1,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t p = begin; p < end; ++p) {
                         const std::vector<Spectrum> solved = Projection(f, tree, nodes, p, leaves[p]).solve();
                         std::copy(solved.begin(), solved.end(), value.begin() + nodes.first_node[p]);
                     }
                 },
                 {"continuous"});
}

std::array<float, bands> in_single(const Spectrum& value) {
    std::array<float, bands> out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = static_cast<float>(value[k]);
    return out;
}

}  // namespace

ElementFunction nearest_continuous(const ElementFunction& f, const Scene& scene, const ContactLines& contacts,
                                   const StopRequest* stop) {
    ElementFunction out;
    out.tree = f.tree;
    const Field<RegionId, std::uint32_t> plane = plane_of_regions(scene);
    const SharedNodes nodes = make_conforming(out.tree, plane, contacts, stop);
    if (nodes.first_node.empty()) return f;
    share_on_node(out.tree);
    share_on_node(std::span(nodes.node_of)), share_on_node(nodes.first_corner.span());
    std::vector<Spectrum> value;  // value of every node
    project(f, out.tree, plane, nodes, value);
    constexpr std::size_t together = 4096;
    std::vector<std::uint32_t> first;  // index of the first value of every `together` elements
    std::uint32_t corners = 0;
    out.first_value.resize(out.tree.size());
    for (ElementId e : out.tree.ids()) {
        if (e.value % together == 0) first.push_back(corners);
        if (!out.tree.is_leaf(e)) continue;
        out.first_value[e] = corners;
        corners += static_cast<std::uint32_t>(nodes.of(e, out.tree).size());
    }
    first.push_back(corners);
    shared_parts(
        out.values, first, 1,
        [&](std::size_t begin, std::size_t end) {
            for (ElementId e : IdRange<ElementId>(begin * together, std::min(end * together, out.tree.size()))) {
                if (!out.tree.is_leaf(e)) continue;
                std::size_t corner = out.first_value[e];
                for (const std::uint32_t node : nodes.of(e, out.tree)) out.values[corner++] = in_single(value[node]);
            }
        },
        {"continuous"});
    return out;
}

std::size_t elements_of_continuous(const ElementTree& tree) {
    std::size_t count = 0;
    for (ElementId e : tree.ids()) {
        const ElementId parent = tree.parent(e);
        const bool in_fan = !parent.is_none() && tree.cut_of(parent) == Cut::fan;
        count += tree.cut_of(e) == Cut::fan || (tree.is_leaf(e) && !in_fan);
    }
    return count;
}

}  // namespace exitance
