#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace exitance {

/// One view factor as estimated by its own row.
struct RowEntry {
    double F = 0;
    std::uint32_t column = 0;
    float variance = 0;  ///< Variance of F; 0 if F was integrated rather than sampled.
    /// Samples per m^2 used for F, fixed before sampling: rays cast from the row's face over its area, or the number of
    /// such rays to which a pair's own samples are equivalent. Infinite if F was integrated.
    float density = 0;
    std::uint32_t unused = 0;  ///< Padding, so that all bytes of the record are defined.
};

inline constexpr float integrated = std::numeric_limits<float>::infinity();

/// One row of view factors, computed independently of the other rows.
struct RawRow {
    std::uint32_t face = 0;
    /// 0: computed in the first pass. 1 and above: recomputed because its combined error was too large.
    std::uint32_t round = 0;
    double cast_density = 0;  ///< Samples per m^2 behind absent entries; 0 if absent entries are zero or were dropped.
    double sky = 0;           ///< Share of rays that hit nothing.
    double back = 0;          ///< Share of rays that hit the back of a face or started below another face.
    double sky_variance = 0, back_variance = 0;
    double missed_variance = 0;  ///< Variance of sky + back.
    double bound = 0;            ///< Sum of the error bounds of integrated and dropped entries.
    /// Number of all rays of the row, and of those that were cast for the whole row.
    std::uint64_t rays = 0, cast_rays = 0;
    std::vector<RowEntry> entries;  ///< Sorted by column, without duplicates.

    /// sqrt(sum of variances) + bound.
    double error() const {
        double sum = 0;
        for (const RowEntry& entry : entries) sum += entry.variance;
        return std::sqrt(sum) + bound;
    }
};

template <class Archive>
void archive(Archive& a, RawRow& row) {
    a(row.face, row.round, row.cast_density, row.sky, row.back, row.sky_variance, row.back_variance);
    a(row.missed_variance, row.bound, row.rays, row.cast_rays, row.entries);
}

}  // namespace exitance
