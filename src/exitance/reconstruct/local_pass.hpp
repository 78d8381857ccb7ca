#pragma once

#include "exitance/core/progress.hpp"
#include "exitance/reconstruct/gather.hpp"
#include "exitance/reconstruct/solution.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// How finely indirect light is gathered.
struct LocalPassOptions {
    MeshSize mesh;         ///< Of the elements to begin with.
    RayBudget rays;        ///< Of one node, to begin with; more where they turn out too noisy.
    double noise = 0;      ///< RMS error of rho E_ind that the rays may leave, W/m^2.
    double tolerance = 0;  ///< RMS error of rho E_ind that interpolation may leave, W/m^2.
    int max_depth = 6;     ///< Cuts below the first mesh.
    std::uint64_t seed = 1;
};

struct LocalPassReport {
    std::size_t rays = 0;
    double noise = 0;          ///< RMS over the surfaces of the rays' error in rho E_ind, W/m^2.
    double interpolation = 0;  ///< Estimated RMS of the interpolation's error in rho E_ind, W/m^2.
    /// What is known of every leaf; of inner elements: unused.
    struct Leaf {
        double expected_error = 0;  ///< Of rho E_ind, W/m^2.
        unsigned rays = 0;          ///< That a node took to bring its noise down to what is allowed.
    };
    Field<ElementId, Leaf> leaves;
    bool interrupted = false;
};

/// Indirect irradiance everywhere, by one gather over the light that a method found: E_ind = H b at the Gauss nodes of
/// an adaptive mesh (2 x 2 on parallelograms, 3 on triangles), a polynomial through them on each element. The gather
/// smooths what is rough in b and doubles its order (the iterated or Sloan solution) [Lischinski93], [Atkinson97].
/// An element is cut where the gather at its centre departs from its polynomial by more than its share of the
/// tolerance and than the rays' own noise. O(elements x rays).
ElementFunction gather_indirect_light(const Stage& stage, const RadiosityAt& b, const LocalPassOptions& options,
                                      LocalPassReport& report, Progress& progress, const StopRequest& stop);

}  // namespace exitance
