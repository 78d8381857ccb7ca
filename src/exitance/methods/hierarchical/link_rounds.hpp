#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// Alternately refines links and solves over them until their estimated error is at most the requested one. Each round
/// starts with the light of the last, coarser solution (multigridding), with tolerances lowered according to the errors
/// so far. If links deliver the light, there are at least two rounds, since the first only has one reflection. The
/// state is saved at safe points. Returns false if a stop made it give up; the result is then incomplete. Source:
/// [Hanrahan91], [Gortler93].
bool refine_links(Hierarchy& hierarchy);

/// Returns the tolerance of single links and receivers if each may have `error`, W/m^2 m.
LinkTolerance link_tolerance(const Hierarchy& hierarchy, double error);

}  // namespace exitance
