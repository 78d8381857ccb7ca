#pragma once

#include <optional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

struct DirectProjectionOptions {
    MeshSize mesh;
    double tolerance = 0;  ///< RMS error of rho E_dir over all surfaces, relative to the mean of rho E_dir.
    int max_depth = 8;     ///< Cuts below the first mesh.
    /// Elements of less than this are not cut, m^2; empty: as the tolerance asks.
    std::optional<double> least_area = {};
    /// What to do when a stop is asked for: give up at once and return an empty tree, or leave the rest to rays, so
    /// that there is something to return.
    bool may_give_up = false;
    std::uint64_t seed = 1;  ///< Of the rays to small elements, where there are many.
};

/// Exact direct light on one element, and the polynomial nearest to it.
struct DirectFit {
    std::array<Spectrum, 4> corners;
    Spectrum mean;                            ///< W/m^2
    Spectrum parallel;                        ///< What parallel light has in the mean, W/m^2.
    double misfit_squared = 0;                ///< Mean of (w (E - polynomial))^2, see light_weight().
    std::array<double, 2> misfit_along = {};  ///< How much of it is along one coordinate alone, noise and all.
};

/// Direct light projected onto elements, for readers that come in great numbers, such as rays.
///
/// On each leaf of an adaptive mesh it is the polynomial nearest in the mean square to exact values at the places of a
/// quadrature rule: its means are right, its shadow edges as sharp as the elements are small. Where a method solves on
/// the same mesh, its elements follow the shadows.
struct DirectProjection {
    ElementTree tree;
    Field<ElementId, DirectFit> fit;  ///< Of every leaf; of inner elements: what was there before they were cut.

    Spectrum at(ElementTree::Place place) const;
};

/// How much an error of E counts on a region: as much as it reflects, and a little on black ones, where E is still
/// looked at.
Spectrum light_weight(const Material& material);

/// Room to work in; one a thread.
struct DirectFitRoom {
    ReceiverLight light;
    ClusteredLight::Workspace clustered;
};

/// Of one element, by values at the places of its fine rule: by clusters of emitters where that pays
/// (`ClusteredLight`), with rays to sources that many things stand before (`CrowdedLight`), else exact. `allowed`: mean
/// square of w (E - polynomial) that noise may leave, (W/m^2)^2. Noise is no misfit, but what it leaves in the
/// polynomial is.
DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                           DirectFitRoom& room);

/// The same by exact values alone. `light` and `workspace` are room to work in.
DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, ReceiverLight& light,
                           DirectLight::Workspace& workspace);

/// What an element's parent holds, in place of light of its own: for work that is cut short.
DirectFit inherited_fit(const ElementTree& tree, ElementId e, const DirectFit& parent);

/// O(elements x places x visible emitters).
DirectProjection project_direct_light(const Stage& stage, const DirectProjectionOptions& options,
                                      const StopRequest& stop);

}  // namespace exitance
