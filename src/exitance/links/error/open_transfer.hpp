#pragma once

#include <vector>

#include "exitance/links/error/check_points.hpp"
#include "exitance/links/error/link_tolerance.hpp"
#include "exitance/links/error/near_row.hpp"
#include "exitance/links/error/source_light.hpp"

namespace exitance {

/// Difference between a source's light at a receiver's check points and the polynomial through the nodes, w E, W/m^2.
using Departure = std::array<double, 5>;

/// Unoccluded transport from a source to a receiver.
struct OpenTransfer {
    std::array<NodeRow, 9> rows{};  ///< Row of weights for each node of the receiver.
    NodeRow light{};                ///< Light w E at the receiver's nodes, W/m^2.
    Departure departure{};
    double rule_error = 0;  ///< RMS error over the receiver of the rule and of the source's polynomial, W/m^2.
    double brightest = 0;   ///< Largest light at nodes and check points, W/m^2.
    double ratio = 0;       ///< Size of the source relative to its distance.
    /// True if the rows are integrated (NearRow); false if they come from the basis's quadrature rule.
    bool near = false;
    /// True if the rows must be stored with the link; otherwise the kernel is recomputed when it is applied.
    bool has_block = false;
    /// Factor on the recomputed kernel that makes its mean equal to that of the integrated rows; 1 if there are none.
    double kernel_scale = 1;

    double largest_light(std::size_t nodes) const;
};

/// Transport with one value per element: the mean form factor over the receiver.
struct EvenTransfer {
    double form_factor = 0, rule_error = 0;
    Departure departure{};
};

/// Evaluates unoccluded transport between elements, and the error of using the basis's rule for it. One object per
/// thread; reuses its memory. Source: the oracle of [Gortler93] and [Lischinski94], by samples.
class OpenTransferRule {
  public:
    OpenTransferRule(const LinkSites& sites, const LinkTolerance& tolerance)
        : sites_(sites), tolerance_(tolerance), nodes_(sites.nodes()), checks_(sites.basis()), near_row_(sites) {}

    /// Computes the transport: by the basis's rule if its error is small relative to `allowed` (W/m^2), otherwise by
    /// near rows.
    OpenTransfer send(ElementId receiver, const SourceLight& source, double allowed);
    /// Like send(), with one value b for the whole source.
    EvenTransfer send_evenly(ElementId receiver, const SourceLight& source, double b, double allowed);
    /// The row at a point x, for the transfer that send() returned last.
    NodeRow row(const OpenTransfer& transfer, const SourceLight& source, const Point& x, const Normal& n);
    /// Value at a point of the receiver of the polynomial through the nodes, W/m^2.
    double interpolated(const OpenTransfer& transfer, ElementId receiver, const Point& x) const;
    /// Scale of the kernel for which uniform light has the exact mean over the receiver, for orders 2 and 3. Constants
    /// are corrected by rays instead.
    double scale_of_kernel(const OpenTransfer& transfer, ElementId receiver, const SourceLight& source);
    /// Size of a source relative to its distance.
    double ratio(ElementId receiver, ElementId source) const;
    /// Exact form factor of a part of the source, given by its outline.
    double form_factor(const Point& x, const Normal& n, std::span<const Point> outline);

    std::size_t form_factors() const { return form_factors_; }

  private:
    NodeRow mean_row(const OpenTransfer& transfer, const SourceLight& source, const Patch& receiver, const Normal& n,
                     Departure& light);
    double set_rows(OpenTransfer& transfer, ElementId receiver, const SourceLight& source);
    double error_of_kernel(OpenTransfer& transfer, ElementId receiver, const SourceLight& source) const;

    const LinkSites& sites_;
    const LinkTolerance& tolerance_;
    std::size_t nodes_;
    CheckPoints checks_;
    NearRow near_row_;
    std::vector<Point> outline_;
    std::size_t form_factors_ = 0;
};

}  // namespace exitance
