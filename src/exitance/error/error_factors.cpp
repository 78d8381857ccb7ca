#include "exitance/error/error_factors.hpp"

#include <algorithm>
#include <array>

#include "exitance/error/batch_mean.hpp"

namespace exitance {
namespace {

/// Standard errors by which the product must be positive in the first and in the second set of paths.
constexpr double min_first = 1, min_second = 2;

/// Weighted sums over the samples of a room or a body: the squared error e^2, and its product with the light m that the
/// coarse response lacks.
struct DomainSums {
    std::size_t samples = 0, paths = 0;
    std::array<double, batches> squared{}, product{};  ///< e^2 by batch of samples, and 2 e m by batch of paths.

    /// Returns the sum of e^2, but at least its standard error, which is the smallest error that samples can resolve.
    double own() const {
        const BatchMean found(squared);
        return std::max(found.mean, found.standard_error);
    }
    double more() const { return BatchMean(product).mean; }
    /// True if the product is positive by this many standard errors. A few equal values in a few batches would seem
    /// certain, so there must be two in each batch.
    bool exceeds(double standard_errors) const {
        constexpr std::size_t enough = 2 * batches;
        const BatchMean found(product);
        return samples >= enough && paths >= enough && own() > 0 && found.mean > standard_errors * found.standard_error;
    }
    double factor(double max_factor) const { return std::min(1 + 0.5 * more() / own(), max_factor); }
};

/// The sums of all rooms and bodies.
struct AllSums {
    std::vector<DomainSums> rooms, bodies;

    AllSums(std::span<const ResidualSample> samples, std::span<const CorrelationTerm> terms,
            const ErrorDomains& domains)
        : rooms(domains.light_of_room.size()), bodies(domains.bodies) {
        const auto visit = [&](std::size_t sample, const auto& add) {
            add(rooms[samples[sample].room]);
            if (!bodies.empty()) add(bodies[domains.body_of[sample]]);
        };
        for (std::size_t k = 0; k < samples.size(); ++k)
            visit(k, [&](DomainSums& domain) {
                ++domain.samples, domain.squared[k % batches] += batches * samples[k].weight * samples[k].squared;
            });
        for (std::size_t j = 0; j < terms.size(); ++j)
            visit(terms[j].sample,
                  [&](DomainSums& domain) { ++domain.paths, domain.product[j % batches] += batches * terms[j].value; });
    }

    bool any_exceeds(double standard_errors) const {
        return std::any_of(rooms.begin(), rooms.end(),
                           [&](const DomainSums& room) { return room.exceeds(standard_errors); });
    }
};

}  // namespace

ErrorFactors measure_error_factors(const LatePaths& paths, std::span<const ResidualSample> samples,
                                   std::span<const Spectrum> late, const ErrorDomains& domains, std::uint64_t seed,
                                   std::size_t max_rays) {
    ErrorFactors out{.rooms = std::vector<double>(domains.light_of_room.size(), 1),
                     .bodies = std::vector<double>(domains.bodies, 1)};
    std::vector<double> weight_of_place;
    double weight = 0;
    for (const ResidualSample& s : samples) {
        const double light = domains.light_of_room[s.room];
        weight_of_place.push_back(light > 0 ? s.weight / (light * light) : 0), weight += s.weight;
    }
    const auto sums = [&](std::uint64_t which, std::size_t rays) {
        const std::vector<CorrelationTerm> terms =
            paths.correlation(samples, weight_of_place, late, hash(seed, which), rays, out.rays);
        return AllSums(samples, terms, domains);
    };
    const AllSums first = sums(1, max_rays / 3);
    if (!first.any_exceeds(min_first)) return out;
    const AllSums second = sums(2, max_rays - max_rays / 3);
    double own = 0, more = 0;
    for (std::size_t room = 0; room < out.rooms.size(); ++room) {
        own += second.rooms[room].own();
        if (!first.rooms[room].exceeds(min_first) || !second.rooms[room].exceeds(min_second)) continue;
        out.rooms[room] = second.rooms[room].factor(domains.max_factor);
        more += (out.rooms[room] - 1) * second.rooms[room].own();
    }
    if (more > 0) out.whole = 1 + more / own, out.explained = more * (more / own) / weight;
    for (std::size_t body = 0; body < out.bodies.size(); ++body)
        if (first.bodies[body].exceeds(min_first) && second.bodies[body].exceeds(min_second))
            out.bodies[body] = second.bodies[body].factor(domains.max_factor);
    return out;
}

}  // namespace exitance
