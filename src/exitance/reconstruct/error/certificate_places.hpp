#pragma once

#include "exitance/reconstruct/error/certificate.hpp"

namespace exitance {

/// A place to measure the residual at, and its share in the mean over all surfaces.
struct WeightedSample {
    ElementTree::Place place;
    double weight;
};

/// `options.points` places, one in each stratum of a running sum over the leaves of `tree`: half of it area, half area
/// x the square of the expected error; and where some leaves are narrow (`find_narrow_leaves`), a share of its own by
/// their area. A few lie on what is left out: should there be light, it is to be noticed.
std::vector<WeightedSample> stratified_places(const Stage& stage, const ElementTree& tree,
                                              const Field<ElementId, std::uint8_t>& narrow,
                                              const CertificateOptions& options, std::uint64_t seed);

/// The places given, again and again, `count` in all.
std::vector<WeightedSample> in_turn(const std::vector<ElementTree::Place>& places, std::size_t count);

}  // namespace exitance
