#pragma once

#include <string>

#include "exitance/reconstruct/error/certificate.hpp"
#include "exitance/reconstruct/local_pass.hpp"
#include "exitance/solve/global_light.hpp"

namespace exitance {

// What a solve says of itself, in its statistics and as text.

/// What a method did, added to what is counted already.
void record_work(const GlobalLight& light, SolveStatistics& statistics);

/// What the light that is delivered was found by. `has_links`: is it of one of the methods with a hierarchy?
void record_method(const Stage& stage, const GlobalLight& light, bool has_links, SolveStatistics& statistics);

/// How right the delivered light is, and how many elements it is held by.
void record_certificate(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                        SolveStatistics& statistics);

/// The same in a line, for those who want to know what the error is made of; in per cent of the mean reflected light.
std::string describe(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                     const LocalPassReport& gathered);

}  // namespace exitance
