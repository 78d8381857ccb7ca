#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// Refines links and solves over them, in turn, until the links' own estimate meets the error asked for: with light
/// from a coarser solution (multigridding), each round with tolerances lowered as the last ones have shown to be
/// needed. Where links deliver the light, at least two rounds: the first sees one reflection. Keeps its state at safe
/// points. Returns whether what it leaves is whole; false once a stop made it give up. Source: [Hanrahan91],
/// [Gortler93].
bool refine_links(Hierarchy& hierarchy);

/// The tolerance of single links and receivers, where each may have `error`, W/m^2 m.
LinkTolerance link_tolerance(const Hierarchy& hierarchy, double error);

}  // namespace exitance
