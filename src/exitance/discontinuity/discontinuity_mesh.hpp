#pragma once

#include <functional>

#include "exitance/base/checkpoint.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/discontinuity/receiver_triangles.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

struct DiscontinuityOptions {
    double error = 0;  ///< Asked of the mesh, relative RMS of rho E.
    /// How far any place may be off, as a share of the largest value of rho E; but for as little area as no table of
    /// points would find.
    double largest_error = 0;
    /// Light on top of what is direct, at a place of a region; empty: none.
    std::function<Spectrum(RegionId, const Point&)> indirect = {};
    Spectrum direct_weight = Spectrum(1.0);       ///< What direct light is to be multiplied by.
    std::vector<SecondarySource> secondary = {};  ///< Cut along their shadows, too.
    ConicCurves conics = ConicCurves::at_umbras;
    FaceCutter cutter = {};         ///< Cuts receivers along their curves; empty: Delaunay.
    MakeBlockerSearch search = {};  ///< Finds what blocks sources; empty: by shafts and a tree of boxes.
    bool refined = false;           ///< Delaunay refinement before light is looked at, without a `cutter`.
    bool clough_tocher = false;     ///< Elements with tangent planes that agree, in place of quadratic ones.
    /// What both errors are relative to, W/m^2 of rho E; 0: the mean and the largest value at places.
    double scale = 0, brightest = 0;
    std::size_t max_triangles = 2'000'000;
    std::uint64_t seed = 1;             ///< Of the places at which the mesh is tried.
    SafePoints* safe_points = nullptr;  ///< Where curves and values at nodes are kept on the way.
};

struct DiscontinuityReport {
    double error = 0;     ///< Relative RMS of rho E over all surfaces, by places of their own.
    double scale = 0;     ///< Mean of rho E (of E where nothing reflects), W/m^2.
    double parallel = 0;  ///< Flux of parallel light that meets a surface, W, summed over the bands.
    bool interrupted = false;
    DiscontinuityCounts counts;
    double mesh_seconds = 0, direct_seconds = 0;
    std::size_t resumed_receivers = 0, resumed_nodes = 0;  ///< Those that a checkpoint has spared.
    std::size_t secondary_curves = 0;                      ///< Of the curves, those of secondary sources.
    std::size_t tree_bytes = 0;  ///< Of the trees before triangles are made of them; 0 with Delaunay's.
    double candidate_share = 0;  ///< Mean over faces in penumbra of what may hide a source, of all polygons.
    std::size_t plane_tests = 0, fragments = 0;  ///< Of `search`: its tests and its polygons.
};

/// Light on six-node triangles that are cut along the curves across which direct light changes its form: contacts, VE
/// and EV events. Exact at every node; triangles are bisected where the polynomial misses exact light at places
/// between, until that is below the error asked for at places that took no part in it.
/// O(curves log n + nodes x visible emitters).
SixNodeMesh make_discontinuity_mesh(const Stage& stage, const DiscontinuityOptions& options,
                                    DiscontinuityReport& report, const StopRequest& stop);

/// The same as plain elements: every triangle by four linear ones.
ElementFunction linear_elements(const SixNodeMesh& mesh, const Scene& scene);

}  // namespace exitance
