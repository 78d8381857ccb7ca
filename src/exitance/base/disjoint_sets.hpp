#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace exitance {

/// Union-find over the numbers [0, n); the root of a set is its smallest member. Amortised O(log n) per call. Source:
/// [Tarjan75], with path halving.
class DisjointSets {
  public:
    /// Starts with n sets of one number each.
    explicit DisjointSets(std::size_t n = 0) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

    /// For sets that are used again and concern few of many numbers: makes room for the numbers [0, n). A number must
    /// be isolated before it is used.
    void make_room(std::size_t n) { parent_.resize(n); }
    /// Makes a set of i alone. i must not be in a set with others.
    void isolate(std::uint32_t i) { parent_[i] = i; }

    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::uint32_t i, std::uint32_t j) {
        i = root(i), j = root(j);
        parent_[std::max(i, j)] = std::min(i, j);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace exitance
