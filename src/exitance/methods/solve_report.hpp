#pragma once

#include <string>

#include "exitance/error/certificate.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

// What a solve says of itself, in its statistics and as text.

/// What a method did, added to what is counted already.
void record_work(const GlobalLight& light, SolveStatistics& statistics);

/// What the light that is delivered was found by. `has_links`: is it of one of the methods with a hierarchy?
void record_method(const Stage& stage, const GlobalLight& light, bool has_links, SolveStatistics& statistics);

/// How right the delivered light is, and how many elements it is held by.
void record_certificate(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                        SolveStatistics& statistics);

/// Measures the light that panes mirror and that the solve leaves out (`mirrored_share`), as the figure
/// `mirrored_light_share`. If it certainly exceeds the error requested, the solution gets a warning, which is shown,
/// too, and is not converged. Nothing is recorded for scenes without mirroring panes or light.
void record_mirrored_light(Solution& solution, const Stage& stage, const SolveOptions& options, Progress& progress);

/// The parts of a certificate's error in one line, in per cent of the mean reflected light.
std::string describe(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                     const LocalPassReport& gathered);

}  // namespace exitance
