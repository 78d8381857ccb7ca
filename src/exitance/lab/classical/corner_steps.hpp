#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Differences between the corners of constant elements once `averaged_at_vertices` has made them continuous. Elements
/// are numbered in the order in which they are added; vertices are found once, when an element is added.
class CornerSteps {
  public:
    /// rounding  distance within which corners of one region are the same vertex, metres
    explicit CornerSteps(double rounding) : rounding_(rounding) {}

    /// Adds one element. O(log vertices).
    void add(RegionId region, const Patch& patch);
    /// Leaves an element out from now on; its number stays its own.
    void remove(std::size_t element) { corner_count_[element] = 0; }

    /// Averages the elements' values at their vertices. values[i] is that of element i; removed elements are not read.
    /// O(elements).
    void average(std::span<const Spectrum> values);
    /// Largest difference in any band between two corners of an element, by the last averages.
    double largest_step(std::size_t element) const;

  private:
    using Key = std::tuple<std::uint32_t, long long, long long, long long>;  // region, cell of the place
    struct Vertex {
        Spectrum sum;
        double count = 0;
        std::array<float, bands> mean;
    };

    double rounding_;
    std::map<Key, std::uint32_t> known_;
    std::vector<std::array<std::uint32_t, 4>> vertices_of_;  ///< By element.
    std::vector<std::uint8_t> corner_count_;                 ///< By element; 0 of removed ones.
    std::vector<Vertex> vertices_;
};

}  // namespace exitance
