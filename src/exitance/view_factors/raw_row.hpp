#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace exitance {

/// One view factor as its own row estimates it.
struct RowEntry {
    double F = 0;
    std::uint32_t column = 0;
    float variance = 0;  ///< Of F; 0 where it is integrated.
    /// Samples per m^2 behind F, known before they were drawn: rays cast from the row's face over its area, or the
    /// number of such rays that a pair's own samples are worth. Infinite where F is integrated.
    float density = 0;
    std::uint32_t unused = 0;  ///< Fills the record up, so that its bytes are known.
};

inline constexpr float integrated = std::numeric_limits<float>::infinity();

/// One row of view factors as it was computed by itself, before rows are combined.
struct RawRow {
    std::uint32_t face = 0;
    std::uint32_t round = 0;  ///< 0: first pass; 1: computed again because its combined error was too large.
    double cast_density = 0;  ///< Density behind entries that are absent; 0 where absent means 0 or dropped.
    double missed = 0;        ///< Share of rays that met nothing, the back of a face, or began under another face.
    double missed_variance = 0;
    double bound = 0;  ///< Sum over the row of |error| of what was integrated or dropped.
    std::uint64_t rays = 0;
    std::vector<RowEntry> entries;  ///< By column, none twice.

    /// sqrt(sum of variances) + bound.
    double error() const {
        double sum = 0;
        for (const RowEntry& entry : entries) sum += entry.variance;
        return std::sqrt(sum) + bound;
    }
};

}  // namespace exitance
