#pragma once

#include <span>
#include <vector>

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/lab/classical/classical_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// How a link's block is made.
struct KernelChoice {
    TransferKernel kernel = TransferKernel::exact;
    VisibilityKind visibility = VisibilityKind::fractional;
    unsigned rays = 16;  ///< Of fractional visibility, a pair of elements.
};

/// The block of a link, from nodes of the source to nodes of the receiver: E_k += sum_l K_kl B_l.
///
///     point:  K_kl = A_q w_l cos cos / (pi r^2)           the singular transfer from point to point,
///     disc:   K_kl = A_q w_l cos cos / (pi r^2 + A_q w_l)  bounded [Wallace89],
///     exact:  disc, with the row scaled to the form factor from the node to the polygon [Baum89].
///
/// Times what is visible. fractional: one share for all, of rays between places of a jittered 4 x 4 grid. quadrature:
/// yes or no for each pair of nodes. exact: the source is cut by what stands before it as seen from the node, and the
/// source's polynomial integrated over what is left, a share of disc's kernel at Dunavant's points of its triangles,
/// scaled to the form factor of what is left.
class InteractionKernel {
  public:
    InteractionKernel(const Stage& stage, const NodalBasis& basis, KernelChoice choice, std::uint64_t seed)
        : stage_(stage), basis_(basis), choice_(choice), seed_(seed) {}

    struct Workspace {
        std::vector<Point> from, to, source, kept, cut;
        std::vector<std::vector<Point>> parts, left;
        std::vector<PieceId> blockers;
        std::vector<double> factors;
        std::size_t rays = 0, form_factors = 0;
    };

    /// Does any of either element lie before the other?
    bool faces(const ElementTree& tree, ElementId receiver, ElementId source) const;
    /// The share of the pair's rays that meet nothing.
    double visible_share(const ElementTree& tree, ElementId receiver, ElementId source, Workspace& w) const;
    /// The form factor from the receiver's middle to the source, nothing in between.
    double unoccluded(const ElementTree& tree, ElementId receiver, ElementId source) const;
    /// Row by receiver's node, count()^2 entries. `share`: what visible_share gave.
    void block(const ElementTree& tree, ElementId receiver, ElementId source, double share, std::span<float> K,
               Workspace& w) const;

  private:
    void open_row(const Point& x, const Normal& n, const Patch& source, const Normal& m, std::span<double> row,
                  Workspace& w) const;
    void exact_row(const Point& x, const Normal& n, const Patch& source, const Normal& m, std::span<double> row,
                   Workspace& w) const;
    void find_blockers(const ElementTree& tree, ElementId receiver, ElementId source, Workspace& w) const;
    void cut_away(const Point& x, const Normal& n, const Normal& m, double offset, PieceId blocker, Workspace& w) const;

    const Stage& stage_;
    const NodalBasis& basis_;
    KernelChoice choice_;
    std::uint64_t seed_;
};

}  // namespace exitance
