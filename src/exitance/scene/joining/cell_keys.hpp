#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "exitance/base/random.hpp"

namespace exitance {

/// A coordinate that is divided into cells, with the cell size and the bound on its error, at most an eighth of `cell`.
struct CellCoordinate {
    double value, cell, error;
};

/// Calls take(key) for the cell of a point of N coordinates, and for the neighbouring cells whose wall is within the
/// error. Two points whose coordinates agree within their errors therefore have a key in common. Different cells may
/// share a key, and most points get a single one. Points of different `kind` do not share keys on purpose.
template <std::size_t N, class Take>
void each_cell_key(std::uint64_t kind, const std::array<CellCoordinate, N>& coordinates, const Take& take) {
    std::array<double, N> own, other;  // as doubles: distant points may have no digits left for integer cells
    unsigned near = 0;                 // bit i: coordinate i is also in a neighbouring cell
    for (unsigned i = 0; i < N; ++i) {
        // Rounded, not floored: exact zeros, which are frequent in scenes, are then in the middle of their cell.
        const double x = coordinates[i].value / coordinates[i].cell, e = coordinates[i].error / coordinates[i].cell;
        const double nearest = std::floor(x + 0.5);  // one instruction; llround is a function call
        own[i] = nearest;
        other[i] = nearest + (x + e >= nearest + 0.5 ? 1 : x - e < nearest - 0.5 ? -1 : 0);
        if (other[i] != own[i]) near |= 1u << i;
    }
    // visit every subset of the coordinates that are near a border
    for (unsigned chosen = near;; chosen = (chosen - 1) & near) {
        std::uint64_t key = kind;
        for (unsigned i = 0; i < N; ++i)
            key = hash(key, std::bit_cast<std::uint64_t>((chosen >> i & 1u) != 0 ? other[i] : own[i]));
        take(key);
        if (chosen == 0) return;
    }
}

}  // namespace exitance
