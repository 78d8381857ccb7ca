#pragma once

#include <functional>

#include "exitance/methods/methods.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/classical_options.hpp"

namespace exitance {

/// Facts about a classical solve, in addition to SolveStatistics.
struct ClassicalFacts {
    std::string direct, mesh_kind, links_found_by;
    std::size_t initial_links = 0;
    /// Memory of the elements' coefficients (radiosity, irradiance, source term), bytes. Papers count it besides that
    /// of links.
    std::size_t coefficient_memory_bytes = 0;
};

/// Receives an intermediate solution and its number, counted from 1. Its elements are those of the method; light has
/// not been gathered and energies have not been computed.
using SnapshotSink = std::function<Result<void>(const Solution& on_the_way, std::size_t number)>;

/// Solves by a method in the form of its paper, chosen by ClassicalOptions, with its own set-up, mesh, transport,
/// solver and result. It is independent of `solve_scene`. One attempt, no certificate; the error estimate is absent.
///
/// `carried`: emitters are elements like others, b = M + rho F b, and E = F b is all light, read from the elements.
/// `apart`: b = rho (E_dir + F b) with exact E_dir. See docs/laboratory/recipes.md.
Result<Solution> solve_classical(const Scene& scene, const SolveOptions& options, const ClassicalOptions& classical,
                                 Progress& progress, const StopRequest& stop, ClassicalFacts& facts,
                                 const SnapshotSink& sink = {});

}  // namespace exitance
