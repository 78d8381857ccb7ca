#pragma once

#include <array>
#include <cstdint>

namespace exitance {

/// MT19937 with the seeding and the draws of Python's `random.Random(seed)`, so that both produce the same scene
/// families. Only for scene generation; all other code uses RandomStream. Source: [Matsumoto98].
class MersenneTwister {
  public:
    explicit MersenneTwister(std::uint64_t seed);
    std::uint32_t bits();
    double uniform(double low, double high);   ///< Random number of 53 bits, uniform in [low, high).
    std::uint32_t below(std::uint32_t count);  ///< Random integer from 0 to count - 1, by rejection.

  private:
    void seed_with(std::uint32_t seed);
    std::array<std::uint32_t, 624> state_{};
    std::size_t next_ = 624;
};

}  // namespace exitance
