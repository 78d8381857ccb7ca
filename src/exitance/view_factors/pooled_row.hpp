#pragma once

#include "exitance/view_factors/raw_row.hpp"

namespace exitance {

/// Returns the mean of two independent estimates of one face's row, weighted by their numbers of samples: of every
/// entry, and of the shares of the sky and of backs. The result has the face and the round of `a`. O(entries).
RawRow pooled(const RawRow& a, const RawRow& b);

}  // namespace exitance
