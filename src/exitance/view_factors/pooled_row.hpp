#pragma once

#include "exitance/view_factors/raw_row.hpp"

namespace exitance {

/// Mean of two independent estimates of the row of one face, weighted by their numbers of samples: of every entry, and
/// of the shares of the sky and of backs. Face and round are those of `a`. O(entries).
RawRow pooled(const RawRow& a, const RawRow& b);

}  // namespace exitance
