#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/basis/nodal_basis.hpp"

namespace exitance {

/// Gortler's criterion for links: how far the kernel g(x, y) = cos cos / (pi r^2) departs from its interpolant of the
/// basis between the nodes of both elements,
///
///     e = sum over i, j of w_i w_j | g(x_i, y_j) - sum over k, l of N_k(x_i) N_l(y_j) g(x_k, y_l) |,
///
/// where x_k, y_l are the nodes of the basis of order M, and x_i, y_j with weights w_i, w_j those of the Gauss rule of
/// order M + 1, which lie between them. e falls with the size h of the elements as h^M: higher orders need fewer links
/// where the kernel is smooth. The mean is used in place of the largest difference, which diverges where elements
/// touch. Source: [Gortler93]. O((M + 1)^2 M^2 (M^2 + (M + 1)^2)).
class KernelOracle {
  public:
    /// The basis must outlive this object.
    explicit KernelOracle(const NodalBasis& basis);

    struct Misfit {
        double difference = 0;  ///< e, 1/m^2.
        double mean = 0;        ///< Mean of the kernel over both elements by the rule of the basis, 1/m^2.
    };
    Misfit misfit(const Patch& receiver, const Patch& source) const;

    /// Strength of a link as a share of the source's power A_q B_q that may be wrong, times A_p:
    /// A_p A_q (e^2 + s (1 - s) mean^2)^(1/2). The second term is the standard deviation of the kernel due to
    /// visibility if a share s of the source is visible. m^2.
    double strength(const Patch& receiver, const Patch& source, double visible_share) const;

  private:
    /// Points between the nodes of a shape, and the factor of every node at each of them.
    struct Between {
        std::span<const PlanarNode> points;
        std::vector<double> factors;  ///< Values per point and node (points x nodes).
    };
    Between between(Patch::Shape shape) const;
    const Between& of(Patch::Shape shape) const { return shape == Patch::Shape::triangle ? triangle_ : square_; }

    const NodalBasis& basis_;
    Between square_, triangle_;
};

}  // namespace exitance
