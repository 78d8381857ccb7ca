#pragma once

#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// How much of the light that rays of leaves find goes between pieces with nothing in between, certainly: of
/// `radiosity`, by leaf number. From some hundred of the rays.
double open_share(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering, const RayRows& rows,
                  std::span<const Spectrum> radiosity);

}  // namespace exitance
