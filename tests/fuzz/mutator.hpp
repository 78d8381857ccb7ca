#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace exitance::fuzz {

/// Makes damaged copies of valid files with one to eight changes each: flipped bits; changed bytes, words and numbers;
/// ranges removed, repeated or copied from another file; truncation. Numbers, as text or binary, become values that
/// programs often mishandle. Equal seeds and rounds give equal bytes.
class Mutator {
  public:
    /// `corpus` must outlive this object.
    Mutator(const std::vector<std::string>& corpus, std::uint64_t seed) : corpus_(corpus), seed_(seed) {}

    std::string make(std::uint64_t round) const;

  private:
    const std::vector<std::string>& corpus_;
    std::uint64_t seed_;
};

}  // namespace exitance::fuzz
