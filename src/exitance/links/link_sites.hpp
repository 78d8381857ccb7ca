#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include "exitance/base/archive.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/basis/nodal_basis.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// A hierarchy, or its upper part: for every element, either all of its children are in it or none. The elements of one
/// level are independent of each other.
struct ElementPart {
    /// Elements with children in this part of the tree, by depth, roots first.
    std::vector<std::vector<ElementId>> inner;
    std::vector<ElementId> ends;  ///< Elements of this part without children in it, in the order of their ids.
};

/// Places the nodes of a basis on the elements of a tree, and transfers functions between its levels.
///
/// A cell is an element whose domain is smaller than its patch. It is replaced by the parallelogram with the same area
/// and the same first and second moments, so that one kind of rule suffices.
///
/// Values are stored (held) for all elements, or only for those that links use: the roots, and the children of opened
/// elements. Where the mesh for direct light is much finer than these, nothing is stored.
class LinkSites {
  public:
    enum class Held : std::uint8_t { all, roots };
    LinkSites(const Stage& stage, const ElementTree& tree, const NodalBasis& basis, Held held = Held::all);

    /// Stores values for the children of these elements as well, from now on.
    void open(std::span<const ElementId> parents);
    std::size_t size() const { return held_.size(); }  ///< Number of held elements.
    bool holds(ElementId e) const { return e.value < place_.size() && place_[e] != none; }
    /// True if the element has children whose values are stored.
    bool is_open(ElementId e) const { return !tree_->is_leaf(e) && holds(tree_->children(e).front()); }
    /// The element's row among the stored values.
    std::size_t place(ElementId e) const { return place_[e]; }
    /// The smallest element with stored values that contains e: e itself, or an ancestor.
    ElementId held_above(ElementId e) const;
    std::vector<ElementId> ends() const;  ///< Held elements whose children are not held, in the order of their ids.

    const Stage& stage() const { return *stage_; }
    const ElementTree& tree() const { return *tree_; }
    const NodalBasis& basis() const { return *basis_; }
    std::size_t nodes() const { return n_; }  ///< Number of values per element.

    const Normal& normal(ElementId e) const { return stage_->scene.regions()[tree_->region(e)].plane.n; }
    double radius(ElementId e) const {  ///< Radius of a ball around the centre, metres; held elements only.
        return radius_[place_[e]];
    }
    Point centre(ElementId e) const { return frame(e).centre(); }
    /// The patch; for a cell, the parallelogram that replaces it.
    Patch frame(ElementId e) const;
    Point node(ElementId e, std::size_t k) const { return node(frame(e), k); }
    Point node(const Patch& frame, std::size_t k) const { return frame.at(basis_->nodes(frame.shape)[k].at); }
    /// Moves a point near a cell into the cell, because beyond its border there may be the inside of a box. Other
    /// elements leave the point unchanged.
    Point within(ElementId e, const Point& x) const;
    /// The point at which light is evaluated for a node of a receiver.
    Point receiving_node(ElementId e, std::size_t k) const { return within(e, node(e, k)); }
    double weight(ElementId e, std::size_t k) const { return basis_->nodes(tree_->patch(e).shape)[k].weight; }

    /// Matrices between a held child and its parent: child[k] = sum_j push[k n + j] parent[j]; parent[j] = sum over
    /// children and k of pull[j n + k] child[k].
    std::span<const float> push(ElementId child) const { return {&push_[matrix_[place_[child]]], n_ * n_}; }
    std::span<const float> pull(ElementId child) const { return {&pull_[matrix_[place_[child]]], n_ * n_}; }
    /// The matrices of all children of an element, held or not. If `gram` is not empty (nodes()^2 entries), the sum of
    /// the pulls is gram times the parent's values.
    struct ChildMatrices {
        std::vector<std::span<const double>> push, pull;
        std::vector<double> gram, own;  ///< `own`: storage for the spans of matrices that the basis does not provide.

        ChildMatrices() = default;
        ChildMatrices(ChildMatrices&&) = default;  // not copyable: spans would point to the original
    };
    ChildMatrices matrices(ElementId parent) const;

    /// All elements with held children, per depth, roots first.
    const std::vector<std::vector<ElementId>>& inner() const { return inner_; }
    /// The smallest part of the hierarchy that contains all marked elements, which must be held. O(elements).
    ElementPart part_with(Field<ElementId, std::uint8_t> marked) const;
    std::size_t memory_bytes() const;
    std::vector<std::size_t> count_by_level() const;  ///< Number of held elements per depth.

    /// Writes or reads which elements are held, for checkpoints.
    template <class Archive>
    void archive_state(Archive& a) {
        std::vector<ElementId> held = held_;
        a(held);
        if constexpr (Archive::reads) hold_anew(held);
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    void hold(std::span<const ElementId> elements);
    void hold_anew(std::span<const ElementId> elements);
    void add(ElementId e);
    bool is_regular(ElementId parent) const;
    /// Index of the matrices of the first child; those of the others follow. Adds them, unless equal ones are stored
    /// already.
    std::uint32_t matrices_below(ElementId parent);
    std::uint32_t add_matrices(ElementId parent);
    Patch inertia_parallelogram(ElementId e) const;

    const Stage* stage_;
    const ElementTree* tree_;
    const NodalBasis* basis_;
    std::size_t n_;
    /// Per element of the tree: its index among the held elements; `none` if not held.
    Field<ElementId, std::uint32_t> place_;
    std::vector<ElementId> held_;  ///< Held elements, in the order of their indices, like all arrays below.
    std::vector<double> radius_;
    std::vector<std::uint32_t> matrix_;  ///< Per child: index of its matrices in `push_` and `pull_`.
    std::vector<float> push_, pull_;     ///< Matrices; those of regular splits are stored only once.
    /// Per regular split: index of the matrices of the first child.
    std::map<std::pair<Patch::Shape, Cut>, std::uint32_t> regular_;
    std::vector<std::vector<ElementId>> inner_;
    std::vector<std::uint32_t> depth_;
    std::vector<std::uint32_t> cell_frame_;  ///< Per cell: index in `cell_frames_`; none for other elements.
    std::vector<Patch> cell_frames_;
};

/// The values of one element, one per node.
using NodalValues = std::array<Spectrum, 9>;

/// Values of all held elements, in single precision (the precision of links), band by band: value k of element e in a
/// band is at index (place bands + band) nodes + k.
class NodalField {
  public:
    explicit NodalField(const LinkSites& sites) : sites_(&sites) { resize(); }
    void resize() { values_.resize(sites_->size() * bands * sites_->nodes(), 0.0f); }
    std::size_t memory_bytes() const { return sizeof(float) * values_.size(); }
    template <class Archive>
    void archive_state(Archive& a) {
        a(values_);
    }
    void clear();
    void clear(const ElementPart& part);

    float* at(ElementId e, std::size_t band) { return &values_[(sites_->place(e) * bands + band) * sites_->nodes()]; }
    const float* at(ElementId e, std::size_t band) const {
        return &values_[(sites_->place(e) * bands + band) * sites_->nodes()];
    }
    Spectrum node(ElementId e, std::size_t k) const;
    Spectrum mean(ElementId e) const;  ///< Mean over the element.
    void set_node(ElementId e, std::size_t k, const Spectrum& value);
    void set(ElementId e, const NodalValues& values);
    void add(ElementId e, const NodalValues& values);
    /// Values of any element. Below held elements they are those of the function of the nearest held ancestor.
    NodalValues values(ElementId e) const;

    /// Computes the values of every inner element from those of its children. O(elements), level by level, parallel.
    void pull() { pull(sites_->inner()); }
    void pull(const ElementPart& part) { pull(part.inner); }
    /// Per element: RMS difference between its own function and those of its descendants, mean over the bands. of_ends:
    /// the roughness of the ends; 0 if not given.
    Field<ElementId, double> roughness(const Field<ElementId, double>& of_ends = {}) const;
    /// Adds the values of every inner element to those of its children, so that leaves have the sum along their path.
    /// Cost as for pull().
    void push() { push(sites_->inner()); }
    void push(const ElementPart& part) { push(part.inner); }

  private:
    using Levels = std::vector<std::vector<ElementId>>;
    void pull(const Levels& inner);
    void push(const Levels& inner);

    const LinkSites* sites_;
    std::vector<float> values_;
};

/// Approximation at an element of a function given below it: its nodal values, and the mean squared error of the mean
/// over the bands.
struct FromBelow {
    NodalValues values{};
    double departure_squared = 0;
};

/// Computes the approximation at element e from those at its children (`parts`), held or not.
FromBelow pull_from_parts(const LinkSites& sites, ElementId e, std::span<const FromBelow> parts);

/// Computes the approximation at element e (held or not) from the values of the leaves. `of_leaf(e)`: values of a leaf.
/// O(elements below).
template <class OfLeaf>
FromBelow pull_from_leaves(const LinkSites& sites, ElementId e, const OfLeaf& of_leaf) {
    if (sites.tree().is_leaf(e)) return {of_leaf(e)};
    std::vector<FromBelow> parts;
    for (ElementId child : sites.tree().children(e)) parts.push_back(pull_from_leaves(sites, child, of_leaf));
    return pull_from_parts(sites, e, parts);
}

}  // namespace exitance
