#pragma once

#include <functional>
#include <optional>

#include "exitance/base/checkpoint.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/discontinuity/receiver_triangles.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/discontinuity_choice.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

struct DiscontinuityOptions {
    double error = 0;  ///< Requested relative RMS error of rho E.
    /// Requested largest error anywhere, as a share of the largest value of rho E. It may be exceeded on an area too
    /// small to be found by a table of sample points (mesh_limits::unfindable_area).
    double largest_error = 0;
    /// Indirect irradiance at a point of a region, W/m^2, which is added to direct light. Empty: none.
    std::function<Spectrum(RegionId, const Point&)> indirect = {};
    Spectrum direct_weight = Spectrum(1.0);       ///< Factor by which direct light is multiplied.
    std::vector<SecondarySource> secondary = {};  ///< Sources whose shadows are cut into the mesh as well.
    ConicCurves conics = ConicCurves::at_umbras;
    ShadowLines lines = {};         ///< Curves to follow. Contacts, where light jumps, are always followed.
    FaceCutter cutter = {};         ///< Cuts receivers along their curves; empty: Delaunay triangulation.
    MakeBlockerSearch search = {};  ///< Finds the blockers of sources; empty: shafts and a tree of boxes.
    bool refined = false;           ///< Refine for triangle quality before light is evaluated; not with a `cutter`.
    bool clough_tocher = false;  ///< Use Clough-Tocher elements (continuous tangent planes) instead of quadratic ones.
    /// Values of rho E to which `error` and `largest_error` are relative, W/m^2. If `scale` is 0, both are measured:
    /// the mean and the largest value at sample points.
    double scale = 0, brightest = 0;
    std::size_t max_triangles = 2'000'000;
    std::uint64_t seed = 1;             ///< Seed of the sample points that measure the mesh's error.
    SafePoints* safe_points = nullptr;  ///< If given, curves and node values are saved there from time to time.
};

struct DiscontinuityReport {
    /// Relative RMS error of rho E over all surfaces, measured at sample points that took no part in refinement.
    double error = 0;
    double scale = 0;     ///< Mean of rho E (of E if nothing reflects), W/m^2.
    double parallel = 0;  ///< Flux of parallel light on all surfaces, W, summed over the bands.
    bool interrupted = false;
    DiscontinuityCounts counts;
    double mesh_seconds = 0, direct_seconds = 0;
    std::size_t resumed_receivers = 0, resumed_nodes = 0;  ///< Receivers and nodes restored from a checkpoint.
    std::size_t secondary_curves = 0;                      ///< Number of curves that belong to secondary sources.
    /// Memory of the line trees before triangulation, bytes; 0 with Delaunay triangulation.
    std::size_t tree_bytes = 0;
    double candidate_share = 0;  ///< Mean over penumbra faces: candidate blockers as a share of all polygons.
    /// Number of plane tests by `search`, and of polygons in its data structure.
    std::size_t plane_tests = 0, fragments = 0;
};

/// Computes irradiance on six-node triangles that are cut along the curves where direct light changes its form:
/// contacts, VE and EV events. Values at nodes are exact. Triangles are bisected where the polynomial differs from
/// exact light between the nodes, until the error at sample points that took no part in refinement is at most
/// `options.error`. Returns an empty mesh if `stop` is requested before all nodes have light, otherwise the mesh
/// so far. O(curves log n + nodes x visible emitters).
SixNodeMesh make_discontinuity_mesh(const Stage& stage, const DiscontinuityOptions& options,
                                    DiscontinuityReport& report, const StopRequest& stop);

/// Converts a mesh to linear elements: four per triangle, sixteen per Clough-Tocher triangle.
ElementFunction linear_elements(const SixNodeMesh& mesh, const Scene& scene);

}  // namespace exitance
