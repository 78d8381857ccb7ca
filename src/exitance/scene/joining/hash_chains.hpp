#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exitance {

/// A hash table of consecutive numbers in which the caller compares entries. Entries of equal hash, and some others,
/// form a chain. Eight bytes per entry; allocates only at the start.
class HashChains {
  public:
    static constexpr std::uint32_t end = 0xffffffffu;

    explicit HashChains(std::size_t expected) : mask_(std::bit_ceil(expected + 1) - 1), head_(mask_ + 1, end) {
        next_.reserve(expected);
    }

    std::uint32_t first(std::uint64_t hash) const { return head_[hash & mask_]; }
    std::uint32_t next(std::uint32_t entry) const { return next_[entry]; }

    static constexpr std::uint32_t ahead = 12;
    /// Prefetches the table entry of a hash that is needed soon, ideally `ahead` iterations later: large tables exceed
    /// the caches.
    void prefetch(std::uint64_t hash) const { __builtin_prefetch(&head_[hash & mask_]); }

    /// Adds the next number (0, 1, 2, ...) and returns it.
    std::uint32_t add(std::uint64_t hash) {
        const auto entry = static_cast<std::uint32_t>(next_.size());
        next_.push_back(head_[hash & mask_]);
        return head_[hash & mask_] = entry;
    }

  private:
    std::size_t mask_;
    std::vector<std::uint32_t> head_, next_;
};

}  // namespace exitance
