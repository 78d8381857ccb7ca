#pragma once

namespace exitance {

/// Adds to the engine what this library has beyond it: growing cells; local passes a to d, triangulation schemes, BSP
/// orderings and layers of discontinuity meshing; hierarchical radiosity by tasks; and how their light is kept in files
/// and checkpoints. To be called once, before the first solve. Without it such methods are refused, and solutions are
/// read without the parts that only it can evaluate.
void install_laboratory();

/// Like `install_laboratory`, but without files: for programs that neither read nor write solutions.
void install_lab_methods();

}  // namespace exitance
