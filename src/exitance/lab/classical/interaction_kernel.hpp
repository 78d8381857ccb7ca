#pragma once

#include <span>
#include <vector>

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// How a link's block is computed.
struct KernelChoice {
    TransferKernel kernel = TransferKernel::exact;
    VisibilityKind visibility = VisibilityKind::fractional;
    unsigned rays = 16;  ///< Number of rays for fractional visibility, per pair of elements.
};

/// Computes the block of a link, from nodes of the source to nodes of the receiver: E_k += sum_l K_kl B_l.
///
///     point:  K_kl = A_q w_l cos cos / (pi r^2)           singular point-to-point transfer,
///     disc:   K_kl = A_q w_l cos cos / (pi r^2 + A_q w_l)  bounded [Wallace89],
///     exact:  disc, with the row scaled to the form factor from the node to the polygon [Baum89].
///
/// The kernel is multiplied by visibility:
/// - fractional: one share for all nodes, from rays between points of a jittered 4 x 4 grid.
/// - quadrature: visible or not for each pair of nodes.
/// - exact: the source is clipped by its blockers as seen from the node. The source's polynomial is integrated over the
///   visible parts with the disc kernel at the Dunavant points of their triangles, scaled to the form factor of each
///   part.
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

    /// True if part of each element is in front of the other.
    bool faces(const ElementTree& tree, ElementId receiver, ElementId source) const;
    /// Unblocked share of the pair's rays.
    double visible_share(const ElementTree& tree, ElementId receiver, ElementId source, Workspace& w) const;
    /// Form factor from the receiver's centre to the source without blockers.
    double unoccluded(const ElementTree& tree, ElementId receiver, ElementId source) const;
    /// Fills count()^2 entries, one row per node of the receiver. `share`: result of visible_share.
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
