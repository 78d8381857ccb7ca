#include "exitance/samples/mersenne_twister.hpp"

#include <algorithm>
#include <bit>

namespace exitance {

void MersenneTwister::seed_with(std::uint32_t seed) {
    state_[0] = seed;
    for (std::uint32_t i = 1; i < state_.size(); ++i)
        state_[i] = 1812433253u * (state_[i - 1] ^ (state_[i - 1] >> 30)) + i;
}

/// The seed is a key of one or two 32-bit words ("initialisation by array").
MersenneTwister::MersenneTwister(std::uint64_t seed) {
    seed_with(19650218u);
    const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
    const std::uint32_t length = key[1] != 0 ? 2 : 1, n = 624;
    std::uint32_t i = 1, j = 0;
    const auto step = [&] {
        if (++i < n) return;
        state_[0] = state_[n - 1];
        i = 1;
    };
    const auto mixed = [&] { return state_[i - 1] ^ (state_[i - 1] >> 30); };
    for (std::uint32_t k = n; k > 0; --k) {
        state_[i] = (state_[i] ^ (mixed() * 1664525u)) + key[j] + j;
        j = (j + 1) % length;
        step();
    }
    for (std::uint32_t k = n - 1; k > 0; --k) {
        state_[i] = (state_[i] ^ (mixed() * 1566083941u)) - i;
        step();
    }
    state_[0] = 0x80000000u;
}

std::uint32_t MersenneTwister::bits() {
    constexpr std::size_t n = 624, m = 397;
    if (next_ == n) {
        for (std::size_t k = 0; k < n; ++k) {
            const std::uint32_t y = (state_[k] & 0x80000000u) | (state_[(k + 1) % n] & 0x7fffffffu);
            state_[k] = state_[(k + m) % n] ^ (y >> 1) ^ ((y & 1u) != 0 ? 0x9908b0dfu : 0u);
        }
        next_ = 0;
    }
    std::uint32_t y = state_[next_++];
    y ^= y >> 11;
    y ^= (y << 7) & 0x9d2c5680u;
    y ^= (y << 15) & 0xefc60000u;
    return y ^ (y >> 18);
}

double MersenneTwister::uniform(double low, double high) {
    const std::uint32_t a = bits() >> 5, b = bits() >> 6;
    return low + (high - low) * ((a * 67108864.0 + b) / 9007199254740992.0);
}

std::uint32_t MersenneTwister::below(std::uint32_t count) {
    const int width = std::bit_width(count);
    std::uint32_t r;
    do r = bits() >> (32 - width);
    while (r >= count);
    return r;
}

}  // namespace exitance
