#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// True if all bits of the coordinates are the same, so that also 0 and -0 differ.
bool are_same_bits(const Vec3& a, const Vec3& b);

/// Numbers the different points of a mesh, so that a file holds the coordinates of a point once, although each face
/// around it has it as a corner. Points are the same if all bits of their coordinates are, so that a file restores
/// the mesh bit for bit. Numbers follow the order in which points are added.
class VertexTable {
  public:
    /// Returns the number of a point, which is a new one if the point was not added before.
    std::uint32_t add(const Point& p);

    const std::vector<Point>& points() const { return points_; }

  private:
    using Bits = std::array<std::uint64_t, 3>;  ///< The bits of x, y and z.
    struct HashOfBits {
        std::size_t operator()(const Bits& bits) const;
    };

    std::vector<Point> points_;
    std::unordered_map<Bits, std::uint32_t, HashOfBits> number_of_;
};

}  // namespace exitance
