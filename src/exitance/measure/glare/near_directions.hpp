#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Returns all pairs of unit vectors within an angle (radians, at least 0.07): indices with the larger one first.
/// O(directions x directions within the angle).
std::vector<std::pair<std::uint32_t, std::uint32_t>> near_pairs(std::span<const Normal> directions, double angle);

/// Disjoint sets of numbers that are joined step by step. A set is named by its smallest number.
class JoinedSets {
  public:
    void resize(std::size_t count) { root_.resize(count); }
    /// Makes a set of one number.
    void start(std::uint32_t i) { root_[i] = i; }
    std::uint32_t find(std::uint32_t i) {
        while (root_[i] != i) i = root_[i] = root_[root_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        root_[a > b ? a : b] = a > b ? b : a;
    }

  private:
    std::vector<std::uint32_t> root_;
};

}  // namespace exitance
