#pragma once

#include <bit>
#include <span>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

/// So many unknowns, one after the other, are one process's: few enough for even shares, and so many that a sum over
/// all, of a value a block, moves little between processes.
constexpr std::size_t dealt_block(std::size_t unknowns) {
    constexpr std::size_t least = 16, most_blocks = 1 << 16;  // 2 MB with a number for each band
    return std::bit_ceil(std::max(least, (unknowns + most_blocks - 1) / most_blocks));
}

/// How the unknowns of a system are held where several processes solve it: each has vectors of its own unknowns alone,
/// in their order; blocks are dealt out like cards. Or every process has all of them, as one process alone does. Sums
/// go over the same blocks either way, block after block, so that they have the same bits on any number of processes.
class DealtUnknowns {
  public:
    /// All of them in every process.
    explicit DealtUnknowns(std::size_t count) : DealtUnknowns(count, dealt_block(count), 1, 0) {}
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
    /// Of an unknown: its place among those of its owner.
    std::size_t place(std::size_t unknown) const { return unknown / block_ / processes_ * block_ + unknown % block_; }
    /// Of a place among the own ones: the unknown.
    std::size_t unknown(std::size_t place) const {
        return (place / block_ * processes_ + process_) * block_ + place % block_;
    }
    std::size_t own_count() const { return count_of(process_); }
    std::size_t count_of(std::size_t process) const {
        const std::size_t whole = count_ / block_, rest = count_ % block_;  // blocks, and what is left
        const std::size_t blocks = whole / processes_ + (process < whole % processes_ ? 1 : 0);
        return blocks * block_ + (rest > 0 && process == whole % processes_ ? rest : 0);
    }

    /// Of values of all unknowns those of the own ones.
    template <class T>
    std::vector<T> own_part(std::span<const T> all) const {
        std::vector<T> out(own_count());
        parallel_for(out.size(), 4096, [&](std::size_t i) { out[i] = all[unknown(i)]; });
        return out;
    }
    /// The values of every process's own unknowns, for all. All processes call it.
    template <class T>
    void tell(std::span<const T> own, std::span<T> all, const char* what) const {
        parallel_for(own.size(), 4096, [&](std::size_t i) { all[unknown(i)] = own[i]; });
        if (is_spread())
            exchange_values(
                count_, block_, [&](std::size_t i) -> T& { return all[i]; }, what);
    }

    /// Calls body(i) for the places of all own ones. Where they are few of all, it counts as what is dealt out.
    template <class Body>
    void for_each_own(const Body& body) const {
        const auto all = [&] { parallel_for(own_count(), 1024, body); };
        if (is_spread())
            do_own_share(all);
        else
            all();
    }

    /// sum_i term(i, k), k < terms, over all unknowns; i is the place of an own one. All processes call it.
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
