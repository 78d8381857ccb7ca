#pragma once

#include <bit>
#include <span>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

/// Size of the blocks of consecutive unknowns that are distributed over processes: a power of two, at least 16. There
/// are at most 2^16 blocks, so that processes get even shares and a sum that exchanges one value per block transfers
/// little.
constexpr std::size_t dealt_block(std::size_t unknowns) {
    constexpr std::size_t least = 16, max_blocks = 1 << 16;  // one double per block and band is then at most 2 MB
    return std::bit_ceil(std::max(least, (unknowns + max_blocks - 1) / max_blocks));
}

/// Distribution of the unknowns of a linear system over the processes that solve it. In the first form, block b belongs
/// to process b mod processes(), and each process stores only its own unknowns, in ascending order. In the second form
/// every process stores all unknowns. In both sums are formed block by block in the same order, so that they have the
/// same bits on any number of processes.
class DealtUnknowns {
  public:
    /// Every process stores all unknowns.
    explicit DealtUnknowns(std::size_t count) : DealtUnknowns(count, dealt_block(count), 1, 0) {}
    /// Blocks of `block` unknowns are assigned to all processes in turn.
    DealtUnknowns(std::size_t count, std::size_t block)
        : DealtUnknowns(count, block, exitance::processes(), exitance::own_process()) {}
    DealtUnknowns(std::size_t count, std::size_t block, std::size_t processes, std::size_t process)
        : count_(count), block_(block), processes_(processes), process_(process) {}

    bool is_spread() const { return processes_ > 1; }
    std::size_t count() const { return count_; }
    std::size_t block() const { return block_; }
    std::size_t processes() const { return processes_; }

    std::size_t owner(std::size_t unknown) const { return unknown / block_ % processes_; }
    bool is_own(std::size_t unknown) const { return owner(unknown) == process_; }
    /// Index of an unknown among the unknowns of its owner.
    std::size_t place(std::size_t unknown) const { return unknown / block_ / processes_ * block_ + unknown % block_; }
    /// Returns the unknown with index `place` among this process's own unknowns.
    std::size_t unknown(std::size_t place) const {
        return (place / block_ * processes_ + process_) * block_ + place % block_;
    }
    std::size_t own_count() const { return count_of(process_); }
    std::size_t count_of(std::size_t process) const {
        const std::size_t whole = count_ / block_,
                          rest = count_ % block_;  // full blocks; unknowns in the partial one
        const std::size_t blocks = whole / processes_ + (process < whole % processes_ ? 1 : 0);
        return blocks * block_ + (rest > 0 && process == whole % processes_ ? rest : 0);
    }

    /// Extracts the own unknowns' values from the values of all unknowns.
    template <class T>
    std::vector<T> own_part(std::span<const T> all) const {
        std::vector<T> out(own_count());
        parallel_for(out.size(), 4096, [&](std::size_t i) { out[i] = all[unknown(i)]; });
        return out;
    }
    /// Sends every process's own values to all processes, which write them to `all`. Collective.
    template <class T>
    void tell(std::span<const T> own, std::span<T> all, const char* what) const {
        parallel_for(own.size(), 4096, [&](std::size_t i) { all[unknown(i)] = own[i]; });
        if (is_spread())
            exchange_values(
                count_, block_, [&](std::size_t i) -> T& { return all[i]; }, what);
    }

    /// Calls body(i) in parallel for every index i of an own unknown. If unknowns are distributed, the time is counted
    /// as distributed work (`do_own_share`).
    template <class Body>
    void for_each_own(const Body& body) const {
        const auto all = [&] { parallel_for(own_count(), 1024, body); };
        if (is_spread())
            do_own_share(all);
        else
            all();
    }

    /// Returns sum_i term(i, k) over all unknowns for each k < terms. `i` is the index among the own unknowns.
    /// Collective.
    template <class T, class Term>
    std::vector<T> sums(std::size_t terms, const Term& term) const {
        const std::size_t blocks = (count_ + block_ - 1) / block_, own = own_count();
        std::vector<T> of_block(blocks * terms);
        const auto sum_own = [&] {
            parallel_for((own + block_ - 1) / block_, std::max<std::size_t>(1, 1024 / block_), [&](std::size_t b) {
                T* const out = &of_block[(b * processes_ + process_) * terms];
                for (std::size_t k = 0; k < terms; ++k)
                    for (std::size_t i = b * block_; i < std::min(own, (b + 1) * block_); ++i) out[k] += term(i, k);
            });
        };
        if (!is_spread()) {
            sum_own();
        } else {
            do_own_share(sum_own);
            exchange_equal_blocks(std::span(of_block), blocks, "sums");
        }
        std::vector<T> out(terms);
        for (std::size_t b = 0; b < blocks; ++b)
            for (std::size_t k = 0; k < terms; ++k) out[k] += of_block[b * terms + k];
        return out;
    }
    template <class T, class Term>
    T sum(const Term& term) const {
        return sums<T>(1, [&](std::size_t i, std::size_t) { return term(i); }).front();
    }

  private:
    std::size_t count_, block_, processes_, process_;
};

}  // namespace exitance
