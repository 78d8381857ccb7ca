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

/// A hierarchy, or the upper part of one: of no element only some children. Within one level nothing depends on
/// anything.
struct ElementPart {
    std::vector<std::vector<ElementId>> inner;  ///< By depth, roots first: elements whose children are in it.
    std::vector<ElementId> ends;                ///< Where it ends, in order of their ids.
};

/// Link sites place the nodes of a basis on the elements of a tree, and carry functions between its levels.
///
/// A cell (an element whose domain is less than its patch) is replaced by the parallelogram that has the cell's area
/// and its first and second moments, so that one kind of rule serves all.
///
/// Values are stored (held) for all elements, or only for those that a link uses: the roots, and the children of what
/// was opened. Where the mesh follows direct light far below these ends, nothing is stored.
class LinkSites {
  public:
    enum class Held : std::uint8_t { all, roots };
    LinkSites(const Stage& stage, const ElementTree& tree, const NodalBasis& basis, Held held = Held::all);

    /// Stores values for the children of these elements, too, from now on.
    void open(std::span<const ElementId> parents);
    std::size_t size() const { return held_.size(); }  ///< Elements that are held.
    bool holds(ElementId e) const { return e.value < place_.size() && place_[e] != none; }
    /// True if the element has children whose values are stored.
    bool is_open(ElementId e) const { return !tree_->is_leaf(e) && holds(tree_->children(e).front()); }
    /// The element's row among the stored values.
    std::size_t place(ElementId e) const { return place_[e]; }
    /// The smallest element with stored values that contains e: e itself, or an ancestor.
    ElementId held_above(ElementId e) const;
    std::vector<ElementId> ends() const;  ///< Those held whose children are not, in order of their ids.

    const Stage& stage() const { return *stage_; }
    const ElementTree& tree() const { return *tree_; }
    const NodalBasis& basis() const { return *basis_; }
    std::size_t nodes() const { return n_; }  ///< Numbers an element holds.

    const Normal& normal(ElementId e) const { return stage_->scene.regions()[tree_->region(e)].plane.n; }
    double radius(ElementId e) const { return radius_[place_[e]]; }  ///< Of a ball about the centre, metres; held.
    Point centre(ElementId e) const { return frame(e).centre(); }
    /// The patch, or what stands for a cell.
    Patch frame(ElementId e) const;
    Point node(ElementId e, std::size_t k) const { return node(frame(e), k); }
    Point node(const Patch& frame, std::size_t k) const { return frame.at(basis_->nodes(frame.shape)[k].at); }
    /// Moves a point near a cell into it: beyond its border may be the inside of a box. Other elements keep the point.
    Point within(ElementId e, const Point& x) const;
    /// The point at which light is evaluated for a node of a receiver.
    Point receiving_node(ElementId e, std::size_t k) const { return within(e, node(e, k)); }
    double weight(ElementId e, std::size_t k) const { return basis_->nodes(tree_->patch(e).shape)[k].weight; }

    /// child[k] = sum_j push[k n + j] parent[j], and what pull adds to the parent: pull[j n + k] child[k]. Held.
    std::span<const float> push(ElementId child) const { return {&push_[matrix_[place_[child]]], n_ * n_}; }
    std::span<const float> pull(ElementId child) const { return {&pull_[matrix_[place_[child]]], n_ * n_}; }
    /// Those of all children of an element, held or not; where `gram` is not empty, nodes()^2 entries, what pull adds
    /// up is gram times the parent.
    struct ChildMatrices {
        std::vector<std::span<const double>> push, pull;
        std::vector<double> gram, own;  ///< `own`: what spans refer to that the basis does not have.

        ChildMatrices() = default;
        ChildMatrices(ChildMatrices&&) = default;  // and no copies, whose spans would lead elsewhere
    };
    ChildMatrices matrices(ElementId parent) const;

    /// All elements with stored children, by their depth, roots first.
    const std::vector<std::vector<ElementId>>& inner() const { return inner_; }
    /// The least part of the hierarchy that holds all marked elements, which have stored values. O(elements).
    ElementPart part_with(Field<ElementId, std::uint8_t> marked) const;
    std::size_t memory_bytes() const;
    std::vector<std::size_t> count_by_level() const;  ///< How many elements are held at each depth.

    /// Writes or reads which elements have stored values, for checkpoints.
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
    /// Where the push and the pull of its first child stand; the others' follow. Adds them, unless others have the
    /// same.
    std::uint32_t matrices_below(ElementId parent);
    std::uint32_t add_matrices(ElementId parent);
    Patch inertia_parallelogram(ElementId e) const;

    const Stage* stage_;
    const ElementTree* tree_;
    const NodalBasis* basis_;
    std::size_t n_;
    Field<ElementId, std::uint32_t> place_;  ///< Of all elements.
    std::vector<ElementId> held_;            ///< By place, as all below.
    std::vector<double> radius_;
    std::vector<std::uint32_t> matrix_;                              ///< Where the push and the pull of a child stand:
    std::vector<float> push_, pull_;                                 ///< what regular cuts have alike, once.
    std::map<std::pair<Patch::Shape, Cut>, std::uint32_t> regular_;  ///< Where those of the first child stand.
    std::vector<std::vector<ElementId>> inner_;
    std::vector<std::uint32_t> depth_;
    std::vector<std::uint32_t> cell_frame_;  ///< Of a cell: where its frame stands in `cell_frames_`.
    std::vector<Patch> cell_frames_;
};

/// The numbers of one element, node by node.
using NodalValues = std::array<Spectrum, 9>;

/// Numbers of all elements that are held, in single precision as links bring them, band by band: of element e, band and
/// node k at (place bands + band) nodes + k.
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
    Spectrum mean(ElementId e) const;  ///< Over the element.
    void set_node(ElementId e, std::size_t k, const Spectrum& value);
    void set(ElementId e, const NodalValues& values);
    void add(ElementId e, const NodalValues& values);
    /// Of any element: below those that are held, of the function of the nearest one.
    NodalValues values(ElementId e) const;

    /// Every inner element takes its numbers from its children's. O(elements), level by level on all threads.
    void pull() { pull(sites_->inner()); }
    void pull(const ElementPart& part) { pull(part.inner); }
    /// How far the mean over the bands departs from each element's own function, RMS over the element; of ends: what is
    /// given, or 0 where nothing is.
    Field<ElementId, double> roughness(const Field<ElementId, double>& of_ends = {}) const;
    /// Every child adds what its parent holds; leaves end with the sum along their path. Likewise.
    void push() { push(sites_->inner()); }
    void push(const ElementPart& part) { push(part.inner); }

  private:
    using Levels = std::vector<std::vector<ElementId>>;
    void pull(const Levels& inner);
    void push(const Levels& inner);

    const LinkSites* sites_;
    std::vector<float> values_;
};

/// A function below an element, as the element sees it: the nearest numbers, and the mean square by which the mean over
/// the bands departs from them.
struct FromBelow {
    NodalValues values{};
    double departure_squared = 0;
};

/// What an element comes to, of which its children, held or not, come to `parts`.
FromBelow pull_from_parts(const LinkSites& sites, ElementId e, std::span<const FromBelow> parts);

/// Pulls what leaves hold up to an element, held or not. `of_leaf(e)`: the values of a leaf. O(elements below).
template <class OfLeaf>
FromBelow pull_from_leaves(const LinkSites& sites, ElementId e, const OfLeaf& of_leaf) {
    if (sites.tree().is_leaf(e)) return {of_leaf(e)};
    std::vector<FromBelow> parts;
    for (ElementId child : sites.tree().children(e)) parts.push_back(pull_from_leaves(sites, child, of_leaf));
    return pull_from_parts(sites, e, parts);
}

}  // namespace exitance
