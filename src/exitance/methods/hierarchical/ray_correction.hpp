#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// b = rho (E_dir + F b) for the means of leaves by rays, which know no links, from the light that links give: those
/// are up to some percent too dark in all places together, which no average over a hemisphere mends and which comes
/// back from every reflection. Links still tell how light varies within leaves. Sets `missed`, what links leave out.
void correct_by_rays(Hierarchy& hierarchy);

}  // namespace exitance
