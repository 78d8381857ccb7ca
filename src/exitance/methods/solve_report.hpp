#pragma once

#include <string>

#include "exitance/error/certificate.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

// Statistics of a solve, and their description as text.

/// Adds a method's work (iterations, rays, form factors) to the counts.
void record_work(const GlobalLight& light, SolveStatistics& statistics);

/// Records how the delivered light was found. `has_links`: true for hierarchical methods.
void record_method(const Stage& stage, const GlobalLight& light, bool has_links, SolveStatistics& statistics);

/// Records the errors of the delivered light and the number of its elements.
void record_certificate(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                        SolveStatistics& statistics);

/// Describes the parts of a certificate's error in one line, in per cent of the mean reflected light.
std::string describe(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                     const LocalPassReport& gathered);

}  // namespace exitance
