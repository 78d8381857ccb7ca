#include "exitance/transport/link_sites.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/basis/small_system.hpp"
#include "exitance/core/parallel.hpp"

namespace exitance {

LinkSites::LinkSites(const Stage& stage, const ElementTree& tree, const NodalBasis& basis)
    : stage_(&stage),
      tree_(&tree),
      basis_(&basis),
      n_(basis.count()),
      stride_(basis.count() == 1 ? 1 : (basis.count() + 3) / 4 * 4) {
    update();
}

/// The parallelogram with the domain's area, middle and second moments: with C their matrix about the middle, and C = L
/// L^T, its half sides are sqrt 3 times the columns of L (a square of half side h has the second moment h^2 / 3).
Patch LinkSites::inertia_parallelogram(ElementId e) const {
    const std::vector<Vec2> domain = tree_->domain(e);
    const Vec2 c = tree_->centre(e);
    double area = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < domain.size(); ++i) {
        const Vec2 a = domain[i] - c, b = domain[(i + 1) % domain.size()] - c;
        const double twice = cross(a, b);
        area += 0.5 * twice;
        xx += twice * (a.x * a.x + a.x * b.x + b.x * b.x) / 12;
        yy += twice * (a.y * a.y + a.y * b.y + b.y * b.y) / 12;
        xy += twice * (2 * a.x * a.y + a.x * b.y + b.x * a.y + 2 * b.x * b.y) / 24;
    }
    xx /= area, xy /= area, yy /= area;
    const double l = std::sqrt(std::max(xx, 1e-30)), m = xy / l;
    const double k = std::sqrt(std::max(yy - m * m, 1e-30));
    const Patch& frame = tree_->patch(e);
    const Vec3 s = std::sqrt(3.0) * (l * frame.a + m * frame.b), t = std::sqrt(3.0) * k * frame.b;
    return {frame.at(c) - s - t, 2 * s, 2 * t, Patch::Shape::parallelogram};
}

Patch LinkSites::frame(ElementId e) const {
    return cell_frame_[e] == regular ? tree_->patch(e) : cell_frames_[cell_frame_[e]];
}

void LinkSites::add_depth(ElementId e) {
    cell_frame_.add(regular);
    if (tree_->is_cell(e)) {
        cell_frame_[e] = static_cast<std::uint32_t>(cell_frames_.size());
        cell_frames_.emplace_back();
    }
    const ElementId parent = tree_->parent(e);
    depth_.add(parent.is_none() ? 0 : depth_[parent] + 1);
    if (parent.is_none() || e != tree_->children(parent).front()) return;
    if (inner_.size() < depth_[e]) inner_.resize(depth_[e]);
    inner_[depth_[parent]].push_back(parent);
}

void LinkSites::set_nodes(ElementId e) {
    if (tree_->is_cell(e)) cell_frames_[cell_frame_[e]] = inertia_parallelogram(e);
    const Patch patch = frame(e);
    const Point middle = patch.centre();
    const auto nodes = basis_->nodes(patch.shape);
    for (std::size_t k = 0; k < stride_; ++k) {
        const Point p = k < n_ ? patch.at(nodes[k].at) : middle;
        for (std::size_t axis = 0; axis < 3; ++axis) position_[axis][e.value * stride_ + k] = p[axis];
    }
    centre_[e] = middle;
    double radius = 0;
    for (int i = 0; i < patch.corner_count(); ++i) radius = std::max(radius, norm(patch.corner(i) - middle));
    radius_[e] = radius;
}

void LinkSites::add_matrices(ElementId child) {
    own_matrix_.add(regular);
    const ElementId parent = tree_->parent(child);
    if (parent.is_none()) return;
    const bool is_regular = !tree_->is_cell(parent) && !tree_->is_cell(child) &&
                            (tree_->way(parent) == Cut::both || tree_->ratio(parent) == 0.5);
    if (is_regular) return;
    own_matrix_[child] = static_cast<std::uint32_t>(push_.size());
    const Patch outer = frame(parent);
    std::vector<Vec2> places;
    for (std::size_t k = 0; k < n_; ++k) places.push_back(outer.coordinates(node(child, k)));
    push_.resize(push_.size() + n_ * n_);
    const auto push = std::span(push_).subspan(own_matrix_[child], n_ * n_);
    basis_->push_to(outer.shape, places, push);
    pull_.resize(push_.size());
    if (child == tree_->children(parent)[tree_->children(parent).size() - 1]) add_pull(parent);
}

/// The function of the parent nearest to what its children hold: (sum a P^T W P) parent = sum a P^T W child, with P
/// their push and a their shares of the area. Numbers without weight (a triangle's last one) stay zero.
void LinkSites::add_pull(ElementId parent) {
    const auto nodes = basis_->nodes(frame(parent).shape);
    std::vector<double> gram(n_ * n_, 0.0);
    for (std::size_t j = 0; j < n_; ++j)
        if (nodes[j].weight == 0) gram[j * n_ + j] = 1;
    for (ElementId child : tree_->children(parent)) {
        const double share = tree_->area(child) / tree_->area(parent);
        const auto own = basis_->nodes(frame(child).shape);
        const double* const push = &push_[own_matrix_[child]];
        double* const pull = &pull_[own_matrix_[child]];
        for (std::size_t k = 0; k < n_; ++k)
            for (std::size_t i = 0; i < n_; ++i) {
                pull[i * n_ + k] = share * own[k].weight * push[k * n_ + i];
                for (std::size_t j = 0; j < n_; ++j) gram[i * n_ + j] += pull[i * n_ + k] * push[k * n_ + j];
            }
    }
    for (std::size_t j = 0; j < n_; ++j) gram[j * n_ + j] *= 1 + 1e-12;  // slivers say little of some functions
    for (ElementId child : tree_->children(parent)) {
        std::vector<double> matrix = gram, pull(&pull_[own_matrix_[child]], &pull_[own_matrix_[child]] + n_ * n_);
        solve_in_place(matrix, pull, n_, n_);
        std::copy(pull.begin(), pull.end(), &pull_[own_matrix_[child]]);
    }
}

void LinkSites::update() {
    const std::size_t before = radius_.size(), count = tree_->size();
    for (std::vector<double>& axis : position_) axis.resize(count * stride_);
    centre_.resize(count), radius_.resize(count);
    for (std::size_t e = before; e < count; ++e) add_depth(ElementId(e));
    parallel_for(count - before, 256, [&](std::size_t i) { set_nodes(ElementId(before + i)); });
    for (std::size_t e = before; e < count; ++e) add_matrices(ElementId(e));
}

ElementPart LinkSites::part_with(Field<ElementId, std::uint8_t> marked) const {
    // Whatever has a marked element below it is cut.
    for (std::size_t e = marked.size(); e-- > 0;)
        if (marked[ElementId(e)] && !tree_->parent(ElementId(e)).is_none()) marked[tree_->parent(ElementId(e))] = 2;
    ElementPart part;
    for (ElementId e : marked.ids()) {
        const ElementId parent = tree_->parent(e);
        if (!parent.is_none() && marked[parent] != 2) continue;
        if (marked[e] != 2) {
            part.ends.push_back(e);
            continue;
        }
        if (part.inner.size() <= depth_[e]) part.inner.resize(depth_[e] + 1);
        part.inner[depth_[e]].push_back(e);
    }
    return part;
}

std::span<const double> LinkSites::matrix(const std::vector<double>& own, ElementId child, bool pull) const {
    if (own_matrix_[child] != regular) return std::span(own).subspan(own_matrix_[child], n_ * n_);
    const ElementId parent = tree_->parent(child);
    const std::size_t i = child.value - tree_->children(parent).front().value;
    const Patch::Shape shape = tree_->patch(parent).shape;
    return pull ? basis_->pull(shape, tree_->way(parent), i) : basis_->push(shape, tree_->way(parent), i);
}

std::size_t LinkSites::memory_bytes() const {
    return 8 * (3 * position_[0].size() + push_.size() + pull_.size()) + radius_.size() * (8 + 24 + 12 + 4);
}

Spectrum NodalField::node(ElementId e, std::size_t k) const {
    Spectrum out;
    for (std::size_t band = 0; band < bands; ++band) out[band] = at(e, band)[k];
    return out;
}

void NodalField::set_node(ElementId e, std::size_t k, const Spectrum& value) {
    for (std::size_t band = 0; band < bands; ++band) at(e, band)[k] = value[band];
}

namespace {

/// Elements a task, that have so many nodes each and four children.
std::size_t grain(std::size_t nodes) {
    return nodes == 1 ? 128 : 32;
}

/// out += matrix in, n numbers of every band.
void add_product(std::span<const double> matrix, std::size_t n, const double* in, double* out) {
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += matrix[i * n + j] * in[j];
        out[i] += sum;
    }
}

}  // namespace

void NodalField::clear() {
    parallel_ranges(values_.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        std::fill(values_.begin() + static_cast<std::ptrdiff_t>(begin),
                  values_.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    });
}

void NodalField::clear(const ElementPart& part) {
    const std::size_t size = bands * sites_->stride();
    const auto clear_one = [&](ElementId e) { std::fill_n(at(e, 0), size, 0.0); };
    for (const std::vector<ElementId>& level : part.inner)
        for (ElementId e : level) clear_one(e);
    parallel_for(part.ends.size(), 4096, [&](std::size_t i) { clear_one(part.ends[i]); });
}

void NodalField::pull(const Levels& inner) {
    const ElementTree& tree = sites_->tree();
    const std::size_t n = sites_->nodes();
    for (std::size_t level = inner.size(); level-- > 0;) {
        const std::vector<ElementId>& elements = inner[level];
        parallel_for(elements.size(), grain(n), [&](std::size_t i) {
            const ElementId e = elements[i];
            for (std::size_t band = 0; band < bands; ++band) std::fill_n(at(e, band), n, 0.0);
            for (ElementId child : tree.children(e)) {
                const auto matrix = sites_->pull(child);
                for (std::size_t band = 0; band < bands; ++band) add_product(matrix, n, at(child, band), at(e, band));
            }
        });
    }
}

Field<ElementId, double> NodalField::roughness() const {
    const ElementTree& tree = sites_->tree();
    const std::size_t n = sites_->nodes();
    Field<ElementId, double> squared(tree.size(), 0.0);
    for (std::size_t level = sites_->inner().size(); level-- > 0;) {
        const std::vector<ElementId>& elements = sites_->inner()[level];
        parallel_for(elements.size(), grain(n), [&](std::size_t i) {
            const ElementId e = elements[i];
            for (ElementId child : tree.children(e)) {
                const auto matrix = sites_->push(child);
                double sum = squared[child];
                for (std::size_t k = 0; k < n; ++k) {
                    double departure = mean(node(child, k));
                    for (std::size_t j = 0; j < n; ++j) departure -= matrix[k * n + j] * mean(node(e, j));
                    sum += sites_->weight(child, k) * departure * departure;
                }
                squared[e] += tree.area(child) / tree.area(e) * sum;
            }
        });
    }
    for (double& v : squared) v = std::sqrt(v);
    return squared;
}

void NodalField::push(const Levels& inner) {
    const ElementTree& tree = sites_->tree();
    const std::size_t n = sites_->nodes();
    for (const std::vector<ElementId>& elements : inner)
        parallel_for(elements.size(), grain(n), [&](std::size_t i) {
            const ElementId parent = elements[i];
            for (ElementId e : tree.children(parent)) {
                const auto matrix = sites_->push(e);
                for (std::size_t band = 0; band < bands; ++band) add_product(matrix, n, at(parent, band), at(e, band));
            }
        });
}

}  // namespace exitance
