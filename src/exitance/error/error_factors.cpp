#include "exitance/error/error_factors.hpp"

#include <algorithm>
#include <array>

#include "exitance/error/batch_mean.hpp"

namespace exitance {
namespace {

constexpr double suspicious = 1;  ///< Standard errors by which the first paths must find a correlation.

/// Squared errors of a part, and their correlation with the light that the coarse response lacks, as weighted sums.
struct PartSums {
    double own = 0;
    std::array<double, batches> correlation{};  ///< The product 2 e m, by batch of paths.

    double mean() const { return BatchMean(correlation).mean; }
    /// True if the correlation is positive by this many standard errors.
    bool exceeds(double standard_errors) const {
        const BatchMean found(correlation);
        return own > 0 && found.mean > standard_errors * found.standard_error;
    }
    double factor() const { return exceeds(2) ? 1 + 0.5 * mean() / own : 1; }
};

/// The sums of all rooms and bodies.
struct AllSums {
    std::vector<PartSums> rooms, bodies;

    AllSums(std::span<const ResidualSample> samples, std::span<const CorrelationTerm> terms, const ErrorParted& parts)
        : rooms(parts.light_of_room.size()), bodies(parts.bodies) {
        const auto visit = [&](std::size_t sample, const auto& add) {
            add(rooms[samples[sample].room]);
            if (!bodies.empty()) add(bodies[parts.body_of[sample]]);
        };
        for (std::size_t k = 0; k < samples.size(); ++k)
            visit(k, [&](PartSums& part) { part.own += samples[k].weight * samples[k].squared; });
        for (std::size_t j = 0; j < terms.size(); ++j)
            visit(terms[j].sample, [&](PartSums& part) { part.correlation[j % batches] += batches * terms[j].value; });
    }

    bool any_exceeds(double standard_errors) const {
        return std::any_of(rooms.begin(), rooms.end(), [&](const PartSums& p) { return p.exceeds(standard_errors); });
    }
};

}  // namespace

ErrorFactors measure_error_factors(const LatePaths& paths, std::span<const ResidualSample> samples,
                                   std::span<const Spectrum> late, const ErrorParted& parts, std::uint64_t seed,
                                   std::size_t max_rays) {
    ErrorFactors out{.rooms = std::vector<double>(parts.light_of_room.size(), 1),
                     .bodies = std::vector<double>(parts.bodies, 1)};
    std::vector<double> counted;
    double weight = 0;
    for (const ResidualSample& s : samples) {
        const double light = parts.light_of_room[s.room];
        counted.push_back(light > 0 ? s.weight / (light * light) : 0), weight += s.weight;
    }
    const auto sums = [&](std::uint64_t which, std::size_t rays) {
        return AllSums(samples, paths.correlation(samples, counted, late, hash(seed, which), rays, out.rays), parts);
    };
    const AllSums first = sums(1, max_rays / 3);
    if (!first.any_exceeds(suspicious)) return out;
    const AllSums again = sums(2, max_rays - max_rays / 3);
    double own = 0, more = 0;
    for (std::size_t room = 0; room < out.rooms.size(); ++room) {
        own += again.rooms[room].own;
        if (!first.rooms[room].exceeds(suspicious) || !again.rooms[room].exceeds(2)) continue;
        out.rooms[room] = again.rooms[room].factor(), more += again.rooms[room].mean();
    }
    if (more > 0) out.whole = 1 + 0.5 * more / own, out.explained = 0.5 * more * (0.5 * more / own) / weight;
    for (std::size_t body = 0; body < out.bodies.size(); ++body)
        if (first.bodies[body].exceeds(suspicious)) out.bodies[body] = again.bodies[body].factor();
    return out;
}

}  // namespace exitance
