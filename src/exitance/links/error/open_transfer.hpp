#pragma once

#include <vector>

#include "exitance/links/error/check_points.hpp"
#include "exitance/links/error/link_tolerance.hpp"
#include "exitance/links/error/near_row.hpp"
#include "exitance/links/error/source_light.hpp"

namespace exitance {

/// Light at a receiver's check points less the polynomial of its nodes there, w E, W/m^2.
using Departure = std::array<double, 5>;

/// What a source sends to a receiver with nothing in between.
struct OpenTransfer {
    std::array<NodeRow, 9> rows{};  ///< Of each of the receiver's nodes.
    NodeRow light{};                ///< At the receiver's nodes, w E, W/m^2.
    Departure departure{};
    double rule_error = 0;  ///< RMS over the receiver of what the rule and the source's polynomial miss, W/m^2.
    double brightest = 0;   ///< At nodes and check points, W/m^2.
    double ratio = 0;       ///< Size of the source to its distance.
    bool near = false;      ///< The rows are integrated (NearRow), and not those of the basis's rule.
    bool has_block =
        false;  ///< The rows are to be kept with the link; else the kernel is made anew when it is applied,
    double kernel_scale = 1;  ///< scaled by this where the rows are near ones.

    double largest_light(std::size_t nodes) const;
};

/// What one number sends to another: the mean form factor over the receiver.
struct EvenTransfer {
    double form_factor = 0, rule_error = 0;
    Departure departure{};
};

/// Evaluates light from elements to elements in the open, and the error of doing so by the basis's rule.
/// One a thread; keeps its memory. Source: the oracle of [Gortler93] and [Lischinski94], by samples.
class OpenTransferRule {
  public:
    OpenTransferRule(const LinkSites& sites, const LinkTolerance& tolerance)
        : sites_(sites), tolerance_(tolerance), nodes_(sites.nodes()), checks_(sites.basis()), near_row_(sites) {}

    /// Light by the basis's rule where that is exact enough beside `allowed`, W/m^2, else by near rows.
    OpenTransfer send(ElementId receiver, const SourceLight& source, double allowed);
    /// The same for one number: b stands for all of the source.
    EvenTransfer send_evenly(ElementId receiver, const SourceLight& source, double b, double allowed);
    /// A row of a transfer that send() made last.
    NodeRow row(const OpenTransfer& transfer, const SourceLight& source, const Point& x, const Normal& n);
    /// Light of the nodes' polynomial at a point of the receiver, W/m^2.
    double interpolated(const OpenTransfer& transfer, ElementId receiver, const Point& x) const;
    /// Scale of the kernel of orders 2 and 3 by which even light arrives exactly in the mean over the receiver.
    /// Constants have rays to correct them.
    double scale_of_kernel(const OpenTransfer& transfer, ElementId receiver, const SourceLight& source);
    /// Size of a source to its distance.
    double ratio(ElementId receiver, ElementId source) const;
    /// Exact form factor of a part of the source.
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
