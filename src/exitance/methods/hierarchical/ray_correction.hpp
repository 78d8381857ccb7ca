#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// Solves b = rho (E_dir + F b) for the means of leaves by rays, independently of links, starting from the light of
/// links. Links may be some per cent too dark everywhere, which no average over a hemisphere corrects and which every
/// reflection adds to. Links still determine the variation of light within leaves. Sets `missed`, the light that links
/// miss.
void correct_by_rays(Hierarchy& hierarchy);

}  // namespace exitance
