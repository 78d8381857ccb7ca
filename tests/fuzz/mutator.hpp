#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace exitance::fuzz {

/// Damaged copies of good files: bits turned, bytes, words and numbers changed, stretches cut out, doubled or taken
/// from another file, ends cut off; one to eight such changes each. Text and binary numbers alike become those that
/// programs stumble over. The same seed and round give the same bytes.
class Mutator {
  public:
    /// The corpus is to outlive it.
    Mutator(const std::vector<std::string>& corpus, std::uint64_t seed) : corpus_(corpus), seed_(seed) {}

    std::string make(std::uint64_t round) const;

  private:
    const std::vector<std::string>& corpus_;
    std::uint64_t seed_;
};

}  // namespace exitance::fuzz
