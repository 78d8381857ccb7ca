#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/processes/value_scatter.hpp"

namespace exitance {

/// What a process reads of unknowns that others hold, and nothing else of them. 24 bytes a value.
class FetchedValues {
  public:
    /// Reads nothing.
    FetchedValues() = default;
    /// `marked`: of every unknown, not 0 where it is read (`mark`). Own ones are not fetched. All processes call it.
    FetchedValues(const DealtUnknowns& dealt, std::span<const std::uint8_t> marked);

    /// Notes that the own unknown at `place` reads another; on any thread. Bit 0 tells that of those that would be own
    /// ones with twice as many processes, bit 1 that of the others, so that one run counts what another would fetch.
    static void mark(std::uint8_t& marked, const DealtUnknowns& dealt, std::size_t place) {
        const auto bit = static_cast<std::uint8_t>(1 << place / dealt.block() % 2);
        std::atomic_ref(marked).fetch_or(bit, std::memory_order_relaxed);
    }

    /// `own`, one after the other, and behind them what they read of others. All processes call it.
    std::vector<Spectrum> with_fetched(std::span<const Spectrum> own) const;
    /// How many those are.
    std::size_t size() const { return dealt_.own_count() + fetched_.size(); }
    /// Which unknown's value stands there.
    std::uint32_t unknown_at(std::size_t place) const {
        const std::size_t own = dealt_.own_count();
        return place < own ? static_cast<std::uint32_t>(dealt_.unknown(place)) : fetched_[place - own];
    }
    /// And where that of every unknown stands; of those that are neither own nor read: anywhere. O(unknowns).
    std::vector<std::uint32_t> places() const;

  private:
    DealtUnknowns dealt_{0};
    std::vector<std::uint32_t> fetched_;                        ///< Unknowns, ascending.
    std::size_t messages_ = 0;                                  ///< That bring them;
    std::size_t messages_of_twice_ = 0, fetched_of_twice_ = 0;  ///< with twice as many processes, of both halves.
    std::shared_ptr<const ValueScatter> scatter_;
};

}  // namespace exitance
