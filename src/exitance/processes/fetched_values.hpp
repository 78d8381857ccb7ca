#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/processes/value_scatter.hpp"

namespace exitance {

/// The values that a process reads of unknowns owned by other processes. Only these are transferred. 24 bytes per
/// value.
class FetchedValues {
  public:
    /// Fetches nothing.
    FetchedValues() = default;
    /// `marked`: one value per unknown, not 0 if it is read (see `mark`). Own unknowns are not fetched. Collective.
    FetchedValues(const DealtUnknowns& dealt, std::span<const std::uint8_t> marked);

    /// Records that the own unknown at index `place` reads another unknown, in the `marked` value of that one.
    /// Thread-safe. Sets bit 0 if the reader would still belong to this process with twice as many processes, else bit
    /// 1, so that one run predicts the traffic of the other.
    static void mark(std::uint8_t& marked, const DealtUnknowns& dealt, std::size_t place) {
        const auto bit = static_cast<std::uint8_t>(1 << place / dealt.block() % 2);
        std::atomic_ref(marked).fetch_or(bit, std::memory_order_relaxed);
    }

    /// Returns the values of the own unknowns, followed by the fetched values. Collective.
    std::vector<Spectrum> with_fetched(std::span<const Spectrum> own) const;
    /// Number of own and fetched values.
    std::size_t size() const { return dealt_.own_count() + fetched_.size(); }
    /// Returns the unknown whose value is at index `place` of the result of with_fetched().
    std::uint32_t unknown_at(std::size_t place) const {
        const std::size_t own = dealt_.own_count();
        return place < own ? static_cast<std::uint32_t>(dealt_.unknown(place)) : fetched_[place - own];
    }
    /// For every unknown, the index of its value in with_fetched(); arbitrary if it is neither own nor fetched.
    /// O(unknowns).
    std::vector<std::uint32_t> places() const;

  private:
    DealtUnknowns dealt_{0};
    std::vector<std::uint32_t> fetched_;  ///< Fetched unknowns, ascending.
    std::size_t messages_ = 0;            ///< Number of messages that deliver the fetched values.
    /// Messages and fetched unknowns if there were twice as many processes, for both halves together.
    std::size_t messages_of_twice_ = 0, fetched_of_twice_ = 0;
    std::shared_ptr<const ValueScatter> scatter_;
};

}  // namespace exitance
