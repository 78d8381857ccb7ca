#pragma once

#include <bit>
#include <cstdint>

namespace exitance {

/// A floating-point number of 16 bits (IEEE 754 binary16): 11 significant bits, at most 65504.
struct Half {
    std::uint16_t bits = 0;
};

/// Returns the nearest number of 16 bits, ties to even; an infinity beyond their range. Numbers that are not numbers
/// stay so.
constexpr Half to_half(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    constexpr std::uint32_t infinity = 0x7f800000u, min_normal = 113u << 23;  // 2^-14
    std::uint32_t half = 0;
    if (magnitude > infinity) {
        half = 0x7e00u;
    } else if (magnitude >= 143u << 23) {  // numbers of at least 2^16
        half = 0x7c00u;
    } else if (magnitude >= min_normal) {
        const std::uint32_t odd = magnitude >> 13 & 1u;
        half = (magnitude - (112u << 23) + 0xfffu + odd) >> 13;  // a carry may lead to the next exponent
    } else {
        // Adding 1/2 in 32 bits leaves a multiple of the least 16-bit number, 2^-24, rounded to even, in the last bits.
        half = std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + 0.5f) - (126u << 23);
    }
    return {static_cast<std::uint16_t>(sign | half)};
}

/// Returns the number, which is exact.
constexpr float to_float(Half half) {
    const std::uint32_t sign = (half.bits & 0x8000u) << 16, magnitude = half.bits & 0x7fffu;
    if (magnitude >= 0x7c00u) return std::bit_cast<float>(sign | 0x7f800000u | (magnitude & 0x3ffu) << 13);
    if (magnitude >= 0x400u) return std::bit_cast<float>(sign | ((magnitude << 13) + (112u << 23)));
    const float small = static_cast<float>(magnitude) * 0x1p-24f;
    return sign ? -small : small;
}

}  // namespace exitance
