#include "exitance/base/random.hpp"

namespace exitance {
namespace {

using Directions = std::array<std::uint32_t, 32>;

/// Computes the direction numbers of one dimension from its primitive polynomial x^s + a_1 x^(s-1) + ... + 1 and its
/// first m_i.
constexpr Directions make_directions(int s, std::uint32_t a, std::array<std::uint32_t, 4> m) {
    Directions v{};
    if (s == 0) {  // the first dimension: van der Corput
        for (int i = 0; i < 32; ++i) v[i] = 1u << (31 - i);
        return v;
    }
    for (int i = 0; i < s; ++i) v[i] = m[i] << (31 - i);
    for (int i = s; i < 32; ++i) {
        v[i] = v[i - s] ^ (v[i - s] >> s);
        for (int k = 1; k < s; ++k) v[i] ^= ((a >> (s - 1 - k)) & 1u) * v[i - k];
    }
    return v;
}

constexpr std::array<Directions, 4> directions = {make_directions(0, 0, {}), make_directions(1, 0, {1}),
                                                  make_directions(2, 1, {1, 3}), make_directions(3, 1, {1, 3, 1})};

/// XOR of the direction numbers for every value of each byte of the index, so that a point costs four table lookups.
using ByteTable = std::array<std::array<std::uint32_t, 256>, 4>;

constexpr ByteTable make_byte_table(const Directions& v) {
    ByteTable table{};
    for (int byte = 0; byte < 4; ++byte)
        for (unsigned value = 0; value < 256; ++value)
            for (int bit = 0; bit < 8; ++bit)
                if (value >> bit & 1u) table[byte][value] ^= v[8 * byte + bit];
    return table;
}

constexpr std::array<ByteTable, 4> tables = {make_byte_table(directions[0]), make_byte_table(directions[1]),
                                             make_byte_table(directions[2]), make_byte_table(directions[3])};

}  // namespace

std::uint32_t ScrambledSobol::sobol(std::uint32_t index, int dimension) {
    const ByteTable& t = tables[static_cast<std::size_t>(dimension)];
    return t[0][index & 255u] ^ t[1][index >> 8 & 255u] ^ t[2][index >> 16 & 255u] ^ t[3][index >> 24];
}

/// Owen scrambling works on bit-reversed numbers, and for these the first two dimensions need no table. Dimension 0 is
/// the index itself. The direction numbers of dimension 1 are the rows of Pascal's triangle modulo 2: bit i of the
/// result is the parity of the index bits j for which i is a bitwise subset of j. Without lookups the compiler
/// vectorizes the loop over the points.
template <int dimension>
EXITANCE_INLINE void ScrambledSobol::fill_reversed(std::uint32_t first, std::span<double> coordinates) const {
    const auto count = static_cast<std::uint32_t>(coordinates.size());
    const std::uint32_t shuffle = shuffle_, scramble = scramble_[dimension];
    double* const out = coordinates.data();
    for (std::uint32_t k = 0; k < count; ++k) {
        std::uint32_t bits = owen(first + k, shuffle);
        if (dimension == 1) {
            bits ^= bits >> 16 & 0x0000ffffu;
            bits ^= bits >> 8 & 0x00ff00ffu;
            bits ^= bits >> 4 & 0x0f0f0f0fu;
            bits ^= bits >> 2 & 0x33333333u;
            bits ^= bits >> 1 & 0x55555555u;
        }
        out[k] = reverse(laine_karras(bits, scramble)) * 0x1p-32;
    }
}

void ScrambledSobol::fill(std::uint32_t first, int dimension, std::span<double> coordinates,
                          Processor processor) const {
    if (dimension > 1) {
        for (std::uint32_t k = 0; k < coordinates.size(); ++k) coordinates[k] = (*this)(first + k, dimension);
        return;
    }
    call_for(processor, [&]() EXITANCE_INLINE_LAMBDA {
        dimension == 0 ? fill_reversed<0>(first, coordinates) : fill_reversed<1>(first, coordinates);
    });
}

}  // namespace exitance
