#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <tuple>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Differences between the corners of constant elements after `averaged_at_vertices` has made them continuous, kept
/// while light is shot and elements are cut. Elements are numbered in the order in which they are added.
class CornerSteps {
  public:
    /// Returns the value of an element; not called for removed elements.
    using ValueOf = std::function<Spectrum(std::size_t element)>;

    /// Corners of one region within `rounding` (metres) of each other are the same vertex.
    explicit CornerSteps(double rounding) : rounding_(rounding) {}

    /// Adds one element. `is_watched`: false if `steeper_than` need not find it. O(log vertices).
    void add(RegionId region, const Patch& patch, bool is_watched = true);
    /// Ignores an element from now on; the numbers of the others stay.
    void remove(std::size_t element);

    /// Returns the watched elements with a difference of more than `limit` in any band between two corners, in the
    /// order of their numbers. `change`: no band of any value has changed by more since the last call. The values of
    /// an element are evaluated only if it is new, if a neighbour is new or was removed, or if the sum of the changes
    /// since their last evaluation might make its difference too large. O(elements), with a comparison for most of
    /// them.
    std::vector<std::size_t> steeper_than(double limit, double change, const ValueOf& value);

  private:
    using Key = std::tuple<std::uint32_t, long long, long long, long long>;  // region, grid cell of the point
    struct Vertex {
        std::vector<std::uint32_t> elements;
        std::size_t look = 0;  ///< The call of `steeper_than` that `mean` is from.
        std::array<float, bands> mean;
    };
    struct Element {
        std::array<std::uint32_t, 4> vertices{};
        std::uint8_t corners = 0;  ///< Number of corners; 0 if the element was removed.
        bool is_watched = true;
        double next_look = 0;  ///< Sum of changes at which the element is evaluated again.
    };
    /// Smallest and largest values at the corners of an element, in the band in which they differ most.
    struct Range {
        double low = 0, high = 0;
    };

    void look_around(std::uint32_t vertex);
    const std::array<float, bands>& mean_at(std::uint32_t vertex, const ValueOf& value);
    Range largest_step(std::size_t element, const ValueOf& value);

    double rounding_;
    std::map<Key, std::uint32_t> known_;
    std::vector<Element> elements_;
    std::vector<Vertex> vertices_;
    double changes_ = 0;  ///< Sum of the changes of all calls.
    std::size_t looks_ = 0;
};

}  // namespace exitance
