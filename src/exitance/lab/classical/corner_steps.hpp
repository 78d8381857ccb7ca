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

/// Differences between the corners of constant elements after `averaged_at_vertices` has made them continuous. Elements
/// are numbered in the order in which they are added; the vertices of an element are found once.
class CornerSteps {
  public:
    /// rounding   distance within which corners of one region are the same vertex, metres
    explicit CornerSteps(double rounding) : rounding_(rounding) {}

    /// Adds one element. O(log vertices).
    void add(RegionId region, const Patch& patch);
    /// Ignores an element from now on; the numbers of the others stay.
    void remove(std::size_t element) { corner_count_[element] = 0; }

    /// Averages the elements' values at their vertices. `values[i]`: value of element i; those of removed elements are
    /// not read. O(elements).
    void average(std::span<const Spectrum> values);
    /// Largest difference in any band between two corners of an element, after the last call of `average`.
    double largest_step(std::size_t element) const;

  private:
    using Key = std::tuple<std::uint32_t, long long, long long, long long>;  // region, grid cell of the point
    struct Vertex {
        Spectrum sum;
        double count = 0;
        std::array<float, bands> mean;
    };

    double rounding_;
    std::map<Key, std::uint32_t> known_;
    std::vector<std::array<std::uint32_t, 4>> vertices_of_;  ///< Per element.
    std::vector<std::uint8_t> corner_count_;                 ///< Per element; 0 if removed.
    std::vector<Vertex> vertices_;
};

}  // namespace exitance
