#pragma once

#include "exitance/error/certificate.hpp"

namespace exitance {

/// A place at which the residual is measured, and its weight in the mean over all surfaces.
struct WeightedSample {
    ElementTree::Place place;
    double weight;
};

/// Returns `options.points` places at which to measure the residual: one in each stratum of a running sum over the
/// leaves of `tree`. Half of the sum is area; the other half is area times the square of the expected error. Narrow
/// leaves (`find_narrow_leaves`) get an additional share of the points. Unlit sides get a few points, so that any
/// light there is detected.
std::vector<WeightedSample> stratified_places(const Stage& stage, const ElementTree& tree,
                                              const Field<ElementId, std::uint8_t>& narrow,
                                              const CertificateOptions& options, std::uint64_t seed);

/// Returns `count` places on one body, distributed over its leaves by area, with equal weights.
std::vector<WeightedSample> places_on_body(const ElementTree& tree, std::span<const ElementId> leaves,
                                           std::size_t count, std::uint64_t seed);

/// Returns `count` places by cycling through the given ones, with equal weights.
std::vector<WeightedSample> in_turn(const std::vector<ElementTree::Place>& places, std::size_t count);

}  // namespace exitance
