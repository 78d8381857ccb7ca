#pragma once

#include <functional>

#include "exitance/lab/classical/classical_options.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// What a classical form took, beside SolveStatistics.
struct ClassicalFacts {
    std::string direct, mesh_kind, links_found_by;
    std::size_t initial_links = 0;
    /// Numbers that elements hold (radiosity, irradiance, what enters), bytes: beside the links' what papers count.
    std::size_t coefficient_memory_bytes = 0;
};

/// Takes a solution on the way, and its number, counted from 1. Its elements are as the method has them; it is neither
/// gathered nor are its energies known.
using SnapshotSink = std::function<Result<void>(const Solution& on_the_way, std::size_t number)>;

/// A method as its paper had it, chosen by ClassicalOptions: its own set-up, mesh, transport, solve and result, beside
/// `solve_scene`, of whose path it changes nothing. One attempt, no certificate; the estimate of the error is absent.
///
/// `carried`: emitters are elements like others, b = M + rho F b, and E = F b is all light, read from the elements.
/// `apart`: b = rho (E_dir + F b), E_dir exact. See docs/classical.md.
Result<Solution> solve_classical(const Scene& scene, const SolveOptions& options, const ClassicalOptions& classical,
                                 Progress& progress, const StopRequest& stop, ClassicalFacts& facts,
                                 const SnapshotSink& sink = {});

}  // namespace exitance
