#pragma once

#include "exitance/links/error/open_transfer.hpp"

namespace exitance {

/// Error of a receiver's polynomial where none of its nodes or check points lie, of a transfer that `rule` made last:
/// - a peak: the source is small and near, or the two meet in a tip. Light is compared at two points: the one nearest
/// to
///   the source, and the one in front of the source's centre; both within what lies before the other's plane;
/// - a fall: the source ends beside the receiver, and corners see next to none of it.
/// `certainly_open`: nothing stands in between; departures of such views cancel where light is even, so that only a
/// much brighter peak counts. Returns the RMS over the receiver, W/m^2; 0 of far transfers, and of falls below
/// `allowed`.
double undersampling_error(OpenTransferRule& rule, const LinkSites& sites, const OpenTransfer& transfer,
                           ElementId receiver, const SourceLight& source, bool certainly_open, double allowed);

}  // namespace exitance
