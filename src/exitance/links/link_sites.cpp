#include "exitance/links/link_sites.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/basis/small_system.hpp"

namespace exitance {

LinkSites::LinkSites(const Stage& stage, const ElementTree& tree, const NodalBasis& basis, Held held)
    : stage_(&stage), tree_(&tree), basis_(&basis), n_(basis.count()) {
    if (held == Held::all) {
        std::vector<ElementId> all;
        for (ElementId e : tree.ids()) all.push_back(e);
        hold(all);
    } else {
        hold(tree.roots());
    }
}

/// The parallelogram with the domain's area, centroid and second moments. Let C be the matrix of second moments about
/// the centroid, and C = L L^T. The half sides are sqrt 3 times the columns of L (a square of half side h has the
/// second moment h^2 / 3).
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
    const double l = std::sqrt(std::max(xx, 1e-30)), m = xy / l;  // derived from rounding: no division by zero
    const double k = std::sqrt(std::max(yy - m * m, 1e-30));      // derived from rounding: no division by zero
    const Patch& frame = tree_->patch(e);
    // A parallelogram with the same second moments.
    const double root3 = std::sqrt(3.0);  // derived from the spread of an even distribution
    const Vec3 s = root3 * (l * frame.a + m * frame.b), t = root3 * k * frame.b;
    return {frame.at(c) - s - t, 2 * s, 2 * t, Patch::Shape::parallelogram};
}

Patch LinkSites::frame(ElementId e) const {
    if (!tree_->is_cell(e)) return tree_->patch(e);
    return holds(e) ? cell_frames_[cell_frame_[place_[e]]] : inertia_parallelogram(e);
}

Point LinkSites::within(ElementId e, const Point& x) const {
    constexpr double share_of_reach = 0.999;  // derived from rounding: a little inside of the cell
    if (!tree_->is_cell(e)) return x;
    const double reach = tree_->reach(e, tree_->patch(e).coordinates(x));
    if (reach == 1) return x;
    const Point middle = centre(e);
    return middle + share_of_reach * reach * (x - middle);
}

ElementId LinkSites::held_above(ElementId e) const {
    while (!holds(e)) e = tree_->parent(e);
    return e;
}

std::vector<ElementId> LinkSites::ends() const {
    std::vector<ElementId> out;
    for (ElementId e : held_)
        if (!is_open(e)) out.push_back(e);
    std::sort(out.begin(), out.end());
    return out;
}

/// True if NodalBasis provides the filters of the element's split.
bool LinkSites::is_regular(ElementId parent) const {
    return !tree_->is_cell(parent) &&
           (tree_->cut_of(parent) == Cut::both || (tree_->cut_of(parent) != Cut::line && tree_->ratio(parent) == 0.5));
}

/// The pull gives the parent's function that is nearest to those of its children: (sum a P^T W P) parent = sum a P^T W
/// child, where P is a child's push and a its share of the area. Values without weight (a triangle's last one) stay
/// zero.
LinkSites::ChildMatrices LinkSites::matrices(ElementId parent) const {
    ChildMatrices out;
    const Patch outer = frame(parent);
    const std::size_t children = tree_->children(parent).size();
    if (is_regular(parent)) {
        for (std::size_t i = 0; i < children; ++i) {
            out.push.push_back(basis_->push(outer.shape, tree_->cut_of(parent), i));
            out.pull.push_back(basis_->pull(outer.shape, tree_->cut_of(parent), i));
        }
        return out;
    }
    out.own.resize(2 * children * n_ * n_);
    const auto nodes = basis_->nodes(outer.shape);
    std::vector<double> gram(n_ * n_, 0.0);
    for (std::size_t j = 0; j < n_; ++j)
        if (nodes[j].weight == 0) gram[j * n_ + j] = 1;
    std::vector<Vec2> places(n_);
    for (ElementId child : tree_->children(parent)) {
        const Patch inner = frame(child);
        for (std::size_t k = 0; k < n_; ++k) places[k] = outer.coordinates(node(inner, k));
        double* const push = &out.own[2 * out.push.size() * n_ * n_];
        double* const pull = push + n_ * n_;
        out.push.emplace_back(push, n_ * n_), out.pull.emplace_back(pull, n_ * n_);
        basis_->push_to(outer.shape, places, {push, n_ * n_});
        const double share = tree_->area(child) / tree_->area(parent);
        const auto own = basis_->nodes(inner.shape);
        for (std::size_t k = 0; k < n_; ++k)
            for (std::size_t i = 0; i < n_; ++i) {
                pull[i * n_ + k] = share * own[k].weight * push[k * n_ + i];
                for (std::size_t j = 0; j < n_; ++j) gram[i * n_ + j] += pull[i * n_ + k] * push[k * n_ + j];
            }
    }
    for (std::size_t j = 0; j < n_; ++j)
        gram[j * n_ + j] *= 1 + 1e-12;  // slivers hardly determine some functions (derived from rounding)
    out.gram = std::move(gram);
    return out;
}

void LinkSites::add(ElementId e) {
    const ElementId parent = tree_->parent(e);
    place_[e] = static_cast<std::uint32_t>(held_.size());
    held_.push_back(e);
    const bool is_cell = tree_->is_cell(e);
    cell_frame_.push_back(is_cell ? static_cast<std::uint32_t>(cell_frames_.size()) : none);
    if (is_cell) cell_frames_.push_back(inertia_parallelogram(e));
    const Patch patch = frame(e);
    const Point middle = patch.centre();
    double radius = 0;
    for (int i = 0; i < patch.corner_count(); ++i) radius = std::max(radius, norm(patch.corner(i) - middle));
    radius_.push_back(radius);
    depth_.push_back(parent.is_none() ? 0 : depth_[place_[parent]] + 1);
    matrix_.push_back(none);
    if (parent.is_none() || e != tree_->children(parent).front()) return;
    if (inner_.size() < depth_.back()) inner_.resize(depth_.back());
    inner_[depth_.back() - 1].push_back(parent);
}

/// Adds elements whose parents are held already or come earlier in the list.
void LinkSites::hold(std::span<const ElementId> elements) {
    place_.resize(tree_->size(), none);
    const std::size_t before = held_.size();
    for (ElementId e : elements) add(e);
    // Compute matrices once all children are added.
    for (std::size_t i = before; i < held_.size(); ++i) {
        const ElementId parent = tree_->parent(held_[i]);
        if (parent.is_none() || held_[i] != tree_->children(parent).front()) continue;
        std::uint32_t at = matrices_below(parent);
        for (ElementId child : tree_->children(parent)) {
            matrix_[place_[child]] = at;
            at += static_cast<std::uint32_t>(n_ * n_);
        }
    }
}

std::uint32_t LinkSites::matrices_below(ElementId parent) {
    if (!is_regular(parent)) return add_matrices(parent);
    const auto [at, is_new] = regular_.try_emplace({tree_->patch(parent).shape, tree_->cut_of(parent)}, 0);
    if (is_new) at->second = add_matrices(parent);
    return at->second;
}

std::uint32_t LinkSites::add_matrices(ElementId parent) {
    const auto at = static_cast<std::uint32_t>(push_.size());
    const ChildMatrices of = matrices(parent);
    for (std::span<const double> push : of.push)
        for (double v : push) push_.push_back(static_cast<float>(v));
    for (std::span<const double> pull : of.pull) {
        std::vector<double> gram = of.gram, solved(pull.begin(), pull.end());
        if (!gram.empty()) solve_in_place(gram, solved, n_, n_);
        for (double v : solved) pull_.push_back(static_cast<float>(v));
    }
    return at;
}

void LinkSites::hold_anew(std::span<const ElementId> elements) {
    place_ = {};
    held_.clear(), radius_.clear(), matrix_.clear(), push_.clear(), pull_.clear(), regular_.clear();
    inner_.clear(), depth_.clear(), cell_frame_.clear(), cell_frames_.clear();
    hold(elements);
}

void LinkSites::open(std::span<const ElementId> parents) {
    std::vector<ElementId> children;
    for (ElementId e : parents)
        if (!is_open(e))
            for (ElementId child : tree_->children(e)) children.push_back(child);
    hold(children);
}

ElementPart LinkSites::part_with(Field<ElementId, std::uint8_t> marked) const {
    // Elements with a marked element below them become inner elements.
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
        if (part.inner.size() <= depth_[place_[e]]) part.inner.resize(depth_[place_[e]] + 1);
        part.inner[depth_[place_[e]]].push_back(e);
    }
    return part;
}

std::vector<std::size_t> LinkSites::count_by_level() const {
    std::vector<std::size_t> count;
    for (std::uint32_t depth : depth_) {
        if (depth >= count.size()) count.resize(depth + 1);
        ++count[depth];
    }
    return count;
}

std::size_t LinkSites::memory_bytes() const {
    return 4 * place_.size() + held_.size() * (4 + 8 + 4 + 4 + 4 + 4) + sizeof(float) * (push_.size() + pull_.size()) +
           cell_frames_.size() * sizeof(Patch);
}

Spectrum NodalField::node(ElementId e, std::size_t k) const {
    Spectrum out;
    for (std::size_t band = 0; band < bands; ++band) out[band] = static_cast<double>(at(e, band)[k]);
    return out;
}

Spectrum NodalField::mean(ElementId e) const {
    Spectrum out;
    for (std::size_t k = 0; k < sites_->nodes(); ++k) out += sites_->weight(e, k) * node(e, k);
    return out;
}

void NodalField::set_node(ElementId e, std::size_t k, const Spectrum& value) {
    for (std::size_t band = 0; band < bands; ++band) at(e, band)[k] = static_cast<float>(value[band]);
}

void NodalField::set(ElementId e, const NodalValues& values) {
    for (std::size_t k = 0; k < sites_->nodes(); ++k) set_node(e, k, values[k]);
}

void NodalField::add(ElementId e, const NodalValues& values) {
    for (std::size_t k = 0; k < sites_->nodes(); ++k) set_node(e, k, node(e, k) + values[k]);
}

NodalValues NodalField::values(ElementId e) const {
    const std::size_t n = sites_->nodes();
    const ElementId held = sites_->held_above(e);
    NodalValues out{};
    if (held == e) {
        for (std::size_t k = 0; k < n; ++k) out[k] = node(e, k);
        return out;
    }
    const Patch outer = sites_->frame(held), inner = sites_->frame(e);
    std::array<double, 9> factors{};
    for (std::size_t k = 0; k < n; ++k) {
        sites_->basis().interpolate(outer.shape, outer.coordinates(sites_->node(inner, k)),
                                    std::span(factors).first(n));
        for (std::size_t j = 0; j < n; ++j) out[k] += factors[j] * node(held, j);
    }
    return out;
}

FromBelow pull_from_parts(const LinkSites& sites, ElementId e, std::span<const FromBelow> parts) {
    const ElementTree& tree = sites.tree();
    const std::size_t n = sites.nodes();
    LinkSites::ChildMatrices matrices = sites.matrices(e);
    std::vector<double> sum(n * bands, 0.0);
    std::array<double, 9> means;
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (std::size_t j = 0; j < n; ++j)
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t band = 0; band < bands; ++band)
                    sum[j * bands + band] += matrices.pull[i][j * n + k] * parts[i].values[k][band];
    if (!matrices.gram.empty()) solve_in_place(matrices.gram, sum, n, bands);
    FromBelow out;
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t band = 0; band < bands; ++band) out.values[j][band] = sum[j * bands + band];
        means[j] = mean(out.values[j]);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const ElementId child = tree.children(e)[i];
        double departure_squared = parts[i].departure_squared;
        for (std::size_t k = 0; k < n; ++k) {
            double departure = mean(parts[i].values[k]);
            for (std::size_t j = 0; j < n; ++j) departure -= matrices.push[i][k * n + j] * means[j];
            departure_squared += sites.weight(child, k) * departure * departure;
        }
        out.departure_squared += tree.area(child) / tree.area(e) * departure_squared;
    }
    return out;
}

namespace {

/// Elements per task, each with this many nodes and about four children.
std::size_t grain(std::size_t nodes) {
    return nodes == 1 ? 128 : 32;
}

/// out += matrix in, for n values of one band.
void add_product(std::span<const float> matrix, std::size_t n, const float* in, float* out) {
    for (std::size_t i = 0; i < n; ++i) {
        float sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += matrix[i * n + j] * in[j];
        out[i] += sum;
    }
}

}  // namespace

void NodalField::clear() {
    parallel_ranges(values_.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        std::fill(values_.begin() + static_cast<std::ptrdiff_t>(begin),
                  values_.begin() + static_cast<std::ptrdiff_t>(end), 0.0f);
    });
}

void NodalField::clear(const ElementPart& part) {
    const std::size_t size = bands * sites_->nodes();
    const auto clear_one = [&](ElementId e) { std::fill_n(at(e, 0), size, 0.0f); };
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
            for (std::size_t band = 0; band < bands; ++band) std::fill_n(at(e, band), n, 0.0f);
            for (ElementId child : tree.children(e)) {
                const auto matrix = sites_->pull(child);
                for (std::size_t band = 0; band < bands; ++band) add_product(matrix, n, at(child, band), at(e, band));
            }
        });
    }
}

Field<ElementId, double> NodalField::roughness(const Field<ElementId, double>& of_ends) const {
    const ElementTree& tree = sites_->tree();
    const std::size_t n = sites_->nodes();
    Field<ElementId, double> squared(tree.size(), 0.0);
    for (ElementId e : of_ends.ids())
        if (!sites_->is_open(e)) squared[e] = of_ends[e] * of_ends[e];
    for (std::size_t level = sites_->inner().size(); level-- > 0;) {
        const std::vector<ElementId>& elements = sites_->inner()[level];
        parallel_for(elements.size(), grain(n), [&](std::size_t i) {
            const ElementId e = elements[i];
            for (ElementId child : tree.children(e)) {
                const auto matrix = sites_->push(child);
                double sum = squared[child];
                for (std::size_t k = 0; k < n; ++k) {
                    double departure = exitance::mean(node(child, k));
                    for (std::size_t j = 0; j < n; ++j)
                        departure -= static_cast<double>(matrix[k * n + j]) * exitance::mean(node(e, j));
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
