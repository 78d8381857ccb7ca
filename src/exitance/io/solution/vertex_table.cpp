#include "exitance/io/solution/vertex_table.hpp"

#include <bit>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

std::array<std::uint64_t, 3> bits_of(const Vec3& v) {
    return {std::bit_cast<std::uint64_t>(v.x), std::bit_cast<std::uint64_t>(v.y), std::bit_cast<std::uint64_t>(v.z)};
}

}  // namespace

bool are_same_bits(const Vec3& a, const Vec3& b) {
    return bits_of(a) == bits_of(b);
}

std::size_t VertexTable::HashOfBits::operator()(const Bits& bits) const {
    return hash(bits[0], bits[1], bits[2]);
}

std::uint32_t VertexTable::add(const Point& p) {
    const auto [found, is_new] = number_of_.try_emplace(bits_of(p), static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back(p);
    return found->second;
}

}  // namespace exitance
