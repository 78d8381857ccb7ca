#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "exitance/base/processor.hpp"

namespace exitance {

/// Hashes 64 bits so that every input bit affects every output bit (the finaliser of splitmix64).
constexpr std::uint64_t hash(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

template <class... More>
constexpr std::uint64_t hash(std::uint64_t first, std::uint64_t second, More... more) {
    return hash(hash(first) ^ second, more...);
}

/// Purpose of a random stream. A stream is identified by its purpose and the things that it is for, never by its
/// caller.
enum class Stream : std::uint64_t { visibility, rows, gather, direct, certificate, reference, shooting, mesh };

/// Random numbers of one purpose: the same seed, purpose and numbers a and b give the same sequence on any thread and
/// in any order of calls.
class RandomStream {
  public:
    RandomStream(std::uint64_t seed, Stream purpose, std::uint64_t a = 0, std::uint64_t b = 0)
        : key_(hash(seed, static_cast<std::uint64_t>(purpose), a, b)) {}

    std::uint64_t bits() { return hash(key_ ^ (0xd1342543de82ef95u * ++counter_)); }
    /// Returns a uniform random number in [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    std::uint64_t key() const { return key_; }

  private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

/// Points of the Sobol sequence (first four dimensions, direction numbers of Joe and Kuo), Owen-scrambled by a hash of
/// the seed. Every block of 2^k points is stratified in every pair of dimensions, and each point alone is uniformly
/// distributed. O(1) per coordinate. Source: [Burley20], [JoeKuo08].
class ScrambledSobol {
  public:
    explicit ScrambledSobol(std::uint64_t seed) : shuffle_(static_cast<std::uint32_t>(hash(seed))) {
        for (unsigned d = 0; d < 4; ++d) scramble_[d] = static_cast<std::uint32_t>(hash(seed, 1u + d));
    }

    /// Coordinate `dimension` (0 to 3) of point `index`, in [0, 1).
    double operator()(std::uint32_t index, int dimension) const {
        const std::uint32_t raw = sobol(owen(index, shuffle_), dimension);
        return owen_reversed(raw, scramble_[static_cast<std::size_t>(dimension)]) * 0x1p-32;
    }
    /// Writes coordinate `dimension` of the points from `first` on, one per entry of `coordinates`. A few times as fast
    /// as single calls.
    void fill(std::uint32_t first, int dimension, std::span<double> coordinates,
              Processor processor = Processor::fastest) const;

  private:
    static constexpr std::uint32_t reverse(std::uint32_t v) {
        v = (v >> 1 & 0x55555555u) | (v & 0x55555555u) << 1;
        v = (v >> 2 & 0x33333333u) | (v & 0x33333333u) << 2;
        v = (v >> 4 & 0x0f0f0f0fu) | (v & 0x0f0f0f0fu) << 4;
        v = (v >> 8 & 0x00ff00ffu) | (v & 0x00ff00ffu) << 8;
        return v >> 16 | v << 16;
    }
    static constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
        x ^= x * 0x3d20adeau;
        x += seed;
        x *= (seed >> 16) | 1u;
        x ^= x * 0x05526c56u;
        x ^= x * 0x53a22864u;
        return x;
    }
    static constexpr std::uint32_t owen_reversed(std::uint32_t x, std::uint32_t seed) {
        return reverse(laine_karras(reverse(x), seed));
    }
    /// Nested uniform shuffle of indices: aligned blocks of 2^k indices stay together.
    static constexpr std::uint32_t owen(std::uint32_t index, std::uint32_t seed) {
        return reverse(laine_karras(reverse(index), seed));
    }
    static std::uint32_t sobol(std::uint32_t index, int dimension);
    template <int dimension>
    void fill_reversed(std::uint32_t first, std::span<double> coordinates) const;

    std::uint32_t shuffle_;
    std::array<std::uint32_t, 4> scramble_;
};

}  // namespace exitance
