#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "exitance/base/random.hpp"

namespace exitance {

/// A coordinate by which things are put into cells, and how uncertain it is; `error` at most an eighth of `cell`.
struct CellCoordinate {
    double value, cell, error;
};

/// Calls take(key) for the cell of a point of N coordinates, and for the cells beyond any wall that lies within the
/// error. Hence two things whose coordinates agree within their errors have a key in common. Different cells may share
/// a key, and most things get just one. `kind` separates things that are never to meet.
template <std::size_t N, class Take>
void each_cell_key(std::uint64_t kind, const std::array<CellCoordinate, N>& coordinates, const Take& take) {
    std::array<double, N> own, other;  // for far places, which have no digits left for cells
    unsigned near = 0;                 // coordinates that have a neighbour's cell too
    for (unsigned i = 0; i < N; ++i) {
        // Rounded, not floored: exact zeros, which abound in scenes, lie amid their cell.
        const double x = coordinates[i].value / coordinates[i].cell, e = coordinates[i].error / coordinates[i].cell;
        const double nearest = std::floor(x + 0.5);  // one instruction, where llround is a call
        own[i] = nearest;
        other[i] = nearest + (x + e >= nearest + 0.5 ? 1 : x - e < nearest - 0.5 ? -1 : 0);
        if (other[i] != own[i]) near |= 1u << i;
    }
    for (unsigned chosen = near;; chosen = (chosen - 1) & near) {  // every subset of them
        std::uint64_t key = kind;
        for (unsigned i = 0; i < N; ++i)
            key = hash(key, std::bit_cast<std::uint64_t>((chosen >> i & 1u) != 0 ? other[i] : own[i]));
        take(key);
        if (chosen == 0) return;
    }
}

}  // namespace exitance
