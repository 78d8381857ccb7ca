#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/core/archive.hpp"
#include "exitance/core/spectrum.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// A hierarchy, or the upper part of one: of no element only some children. Within one level nothing depends on
/// anything.
struct ElementPart {
    std::vector<std::vector<ElementId>> inner;  ///< By depth, roots first: elements whose children are in it.
    std::vector<ElementId> ends;                ///< Where it ends, in order of their ids.
};

/// The elements of a tree as links see them: where the nodes of a basis stand, and how functions move between levels.
///
/// A cell (an element whose domain is less than its patch) is seen as the parallelogram that has the cell's area's
/// first and second moments, so that one kind of rule serves all. Grows with the tree: update() after every change.
class LinkSites {
  public:
    LinkSites(const Stage& stage, const ElementTree& tree, const NodalBasis& basis);

    void update();

    const Stage& stage() const { return *stage_; }
    const ElementTree& tree() const { return *tree_; }
    const NodalBasis& basis() const { return *basis_; }
    std::size_t nodes() const { return n_; }  ///< Numbers an element holds.
    /// From one element's numbers to the next one's: nodes(), rounded up to lanes of four where there are several.
    std::size_t stride() const { return stride_; }

    const Normal& normal(ElementId e) const { return stage_->scene.regions()[tree_->region(e)].plane.n; }
    double radius(ElementId e) const { return radius_[e]; }  ///< Of a ball about the frame's middle, metres.
    const Point& centre(ElementId e) const { return centre_[e]; }
    /// The patch, or what stands for a cell.
    Patch frame(ElementId e) const;
    /// One coordinate of every node, stride() entries; lanes past the last node repeat the middle.
    const double* x(ElementId e) const { return &position_[0][e.value * stride_]; }
    const double* y(ElementId e) const { return &position_[1][e.value * stride_]; }
    const double* z(ElementId e) const { return &position_[2][e.value * stride_]; }
    Point node(ElementId e, std::size_t k) const { return {x(e)[k], y(e)[k], z(e)[k]}; }
    double weight(ElementId e, std::size_t k) const { return basis_->nodes(tree_->patch(e).shape)[k].weight; }

    /// child[k] = sum_j push[k n + j] parent[j], and what pull adds to the parent: pull[j n + k] child[k].
    std::span<const double> push(ElementId child) const { return matrix(push_, child, false); }
    std::span<const double> pull(ElementId child) const { return matrix(pull_, child, true); }

    /// All inner elements by their depth, roots first.
    const std::vector<std::vector<ElementId>>& inner() const { return inner_; }
    /// The least part that holds all elements that are marked, by element. O(elements).
    ElementPart part_with(Field<ElementId, std::uint8_t> marked) const;
    std::size_t memory_bytes() const;

  private:
    static constexpr std::uint32_t regular = 0xffffffffu;
    void add_depth(ElementId e);
    void set_nodes(ElementId e);
    void add_matrices(ElementId child);
    void add_pull(ElementId parent);
    std::span<const double> matrix(const std::vector<double>& own, ElementId child, bool pull) const;
    Patch inertia_parallelogram(ElementId e) const;

    const Stage* stage_;
    const ElementTree* tree_;
    const NodalBasis* basis_;
    std::size_t n_, stride_;
    std::array<std::vector<double>, 3> position_;
    Field<ElementId, double> radius_;
    Field<ElementId, Point> centre_;
    Field<ElementId, std::uint32_t> own_matrix_;  ///< Of children that lie like no other: where their matrices stand.
    std::vector<double> push_, pull_;
    std::vector<std::vector<ElementId>> inner_;
    Field<ElementId, std::uint32_t> depth_;
    Field<ElementId, std::uint32_t> cell_frame_;  ///< Of a cell: where its frame stands in `cell_frames_`.
    std::vector<Patch> cell_frames_;
};

/// Numbers of all elements, band by band: of element e, band and node k at (e bands + band) stride + k.
class NodalField {
  public:
    explicit NodalField(const LinkSites& sites) : sites_(&sites) { resize(); }
    void resize() { values_.resize(sites_->tree().size() * bands * sites_->stride(), 0.0); }
    std::size_t memory_bytes() const { return 8 * values_.size(); }
    template <class Archive>
    void archive_state(Archive& a) {
        a(values_);
    }
    void clear();
    void clear(const ElementPart& part);

    double* at(ElementId e, std::size_t band) { return &values_[(e.value * bands + band) * sites_->stride()]; }
    const double* at(ElementId e, std::size_t band) const {
        return &values_[(e.value * bands + band) * sites_->stride()];
    }
    Spectrum node(ElementId e, std::size_t k) const;
    void set_node(ElementId e, std::size_t k, const Spectrum& value);

    /// Every inner element takes its numbers from its children's. O(elements), level by level on all threads.
    void pull() { pull(sites_->inner()); }
    void pull(const ElementPart& part) { pull(part.inner); }
    /// How far the mean over the bands departs from each element's own function, RMS over the element: 0 on leaves.
    Field<ElementId, double> roughness() const;
    /// Every child adds what its parent holds; leaves end with the sum along their path. Likewise.
    void push() { push(sites_->inner()); }
    void push(const ElementPart& part) { push(part.inner); }

  private:
    using Levels = std::vector<std::vector<ElementId>>;
    void pull(const Levels& inner);
    void push(const Levels& inner);

    const LinkSites* sites_;
    std::vector<double> values_;
};

}  // namespace exitance
