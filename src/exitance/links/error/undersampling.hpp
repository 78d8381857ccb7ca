#pragma once

#include "exitance/links/error/open_transfer.hpp"

namespace exitance {

/// Error of a receiver's polynomial away from its nodes and check points, for the transfer that `rule` made last:
/// - a peak: the source is small and near, or the two elements share a corner. Light is compared at two points: the one
/// nearest to the source, and the one in front of the source's centre, both within the part in front of the other's
/// plane;
/// - a fall: the source ends next to the receiver, whose corners receive almost no light from it.
/// certainly_open  nothing is in between; the errors of such views cancel if the light is uniform, so only a much
/// brighter peak counts
/// Returns the RMS over the receiver, W/m^2; 0 for far transfers, and for falls below `allowed`.
double undersampling_error(OpenTransferRule& rule, const LinkSites& sites, const OpenTransfer& transfer,
                           ElementId receiver, const SourceLight& source, bool certainly_open, double allowed);

}  // namespace exitance
