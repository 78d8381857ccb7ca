#pragma once

#include "exitance/error/certificate.hpp"

namespace exitance {

/// A place to measure the residual at, and its share in the mean over all surfaces.
struct WeightedSample {
    ElementTree::Place place;
    double weight;
};

/// `options.points` places to measure the residual at: one in each stratum of a running sum over the leaves of `tree`.
/// Half of the sum is area, half area times the square of the expected error. Narrow leaves (`find_narrow_leaves`) add
/// a share of their own by area. A few places lie on sides that are left out, so that light there is noticed.
std::vector<WeightedSample> stratified_places(const Stage& stage, const ElementTree& tree,
                                              const Field<ElementId, std::uint8_t>& narrow,
                                              const CertificateOptions& options, std::uint64_t seed);

/// `count` places on one body, spread over its leaves by area; their weights are equal.
std::vector<WeightedSample> places_on_body(const ElementTree& tree, std::span<const ElementId> leaves,
                                           std::size_t count, std::uint64_t seed);

/// The places given, again and again, `count` in all.
std::vector<WeightedSample> in_turn(const std::vector<ElementTree::Place>& places, std::size_t count);

}  // namespace exitance
