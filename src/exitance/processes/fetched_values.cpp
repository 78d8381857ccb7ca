#include "exitance/processes/fetched_values.hpp"

#include <numeric>

#include "exitance/processes/value_scatter.hpp"

namespace exitance {

FetchedValues::FetchedValues(const DealtUnknowns& dealt, std::span<const std::uint8_t> marked) : dealt_(dealt) {
    const std::size_t own = own_process(), all = dealt.processes();
    std::vector<std::uint8_t> owners(all, 0), owners_of_twice(4 * all, 0);  // 1 for each owner of a value that is read
    for (std::size_t j = 0; j < marked.size(); ++j) {
        if (marked[j] == 0) continue;
        if (!dealt.is_own(j)) {
            fetched_.push_back(static_cast<std::uint32_t>(j));
            owners[dealt.owner(j)] = 1;
        }
        const std::size_t owner = j / dealt.block() % (2 * all);
        for (std::size_t half = 0; half < 2; ++half)
            if ((marked[j] >> half & 1) != 0 && owner != own + half * all) {
                ++fetched_of_twice_;
                owners_of_twice[2 * half * all + owner] = 1;
            }
    }
    messages_ = std::accumulate(owners.begin(), owners.end(), std::size_t{0});
    messages_of_twice_ = std::accumulate(owners_of_twice.begin(), owners_of_twice.end(), std::size_t{0});
    if (dealt.is_spread()) scatter_ = make_scatter(dealt, fetched_);
}

std::vector<Spectrum> FetchedValues::with_fetched(std::span<const Spectrum> own) const {
    std::vector<Spectrum> out(size());
    std::copy(own.begin(), own.end(), out.begin());
    if (!dealt_.is_spread()) return out;
    detail::meet(dealt_.count(), "fetch");
    detail::count_fetched({.messages = messages_,
                           .values = fetched_.size(),
                           .messages_of_twice = messages_of_twice_,
                           .values_of_twice = fetched_of_twice_},
                          sizeof(Spectrum));
    scatter_->fetch(own, std::span(out).subspan(own.size()));
    return out;
}

std::vector<std::uint32_t> FetchedValues::places() const {
    std::vector<std::uint32_t> out(dealt_.count(), 0);
    for (std::size_t at = 0; at < size(); ++at) out[unknown_at(at)] = static_cast<std::uint32_t>(at);
    return out;
}

}  // namespace exitance
