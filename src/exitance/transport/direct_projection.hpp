#pragma once

#include <vector>

#include "exitance/core/progress.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

struct DirectProjectionOptions {
    MeshSize mesh;
    double tolerance = 0;  ///< RMS error of rho E_dir over all surfaces, relative to the mean of rho E_dir.
    int max_depth = 8;     ///< Cuts below the first mesh.
};

/// Direct light projected onto elements, for readers that come in great numbers, such as rays.
///
/// On each leaf of an adaptive mesh it is the polynomial nearest in the mean square to exact values at the places of a
/// quadrature rule: its means are right, its shadow edges as sharp as the elements are small. Where a method solves on
/// the same mesh, its elements follow the shadows.
struct DirectProjection {
    ElementTree tree;
    Field<ElementId, std::array<Spectrum, 4>> corners;  ///< Of a leaf: values at its patch's corners, W/m^2.
    Field<ElementId, Spectrum> mean;                    ///< Of a leaf, W/m^2.
    Field<ElementId, double> misfit_squared;            ///< Of a leaf: mean of (w (E - polynomial))^2, see light_weight().

    Spectrum at(ElementTree::Place place) const;
};

/// How much an error of E counts on a region: as much as it reflects, and a little on black ones, where E is still
/// looked at.
Spectrum light_weight(const Material& material);

/// O(elements x places x visible emitters).
DirectProjection project_direct_light(const Stage& stage, const DirectProjectionOptions& options,
                                      const StopRequest& stop);

}  // namespace exitance
