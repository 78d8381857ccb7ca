#include "fuzz/mutator.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "exitance/base/random.hpp"

namespace exitance::fuzz {
namespace {

constexpr std::size_t max_bytes = std::size_t(1)
                                  << 20;  ///< Limit on the bytes of a file, since repetition could grow without bound.

/// Random choices for one damaged copy.
class Dice {
  public:
    Dice(std::uint64_t seed, std::uint64_t round) : random_(hash(seed, round), Stream::mesh) {}
    std::uint64_t bits() { return random_.bits(); }
    /// Random number in [0, n); 0 for n = 0.
    std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random_.bits() % n); }

  private:
    RandomStream random_;
};

constexpr std::array<std::string_view, 28> odd_numbers = {"0",
                                                          "-0",
                                                          "1",
                                                          "-1",
                                                          "2",
                                                          "3",
                                                          "127",
                                                          "255",
                                                          "65535",
                                                          "65536",
                                                          "-2147483648",
                                                          "2147483647",
                                                          "4294967295",
                                                          "4294967296",
                                                          "18446744073709551615",
                                                          "9223372036854775807",
                                                          "1e308",
                                                          "1e-308",
                                                          "-1e30",
                                                          "1e999",
                                                          "nan",
                                                          "inf",
                                                          "-inf",
                                                          "0.5",
                                                          "1e-9",
                                                          "1,5",
                                                          "0x10",
                                                          "12345678901234567890123456789"};
constexpr std::array<std::uint64_t, 12> odd_integers = {
    0, 1, 0x7f, 0x80, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffff0, 0x7fffffffffffffff};

bool is_number(char c) {
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
}
bool is_word(char c) {
    return is_number(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/// The range of characters for which `belongs` is true at or after a position.
template <class Belongs>
std::pair<std::size_t, std::size_t> stretch(const std::string& s, std::size_t at, const Belongs& belongs) {
    while (at < s.size() && !belongs(s[at])) ++at;
    std::size_t first = at, last = at;
    while (first > 0 && belongs(s[first - 1])) --first;
    while (last < s.size() && belongs(s[last])) ++last;
    return {first, last};
}

void flip_bit(std::string& s, Dice& dice) {
    if (!s.empty()) s[dice.below(s.size())] ^= static_cast<char>(1u << dice.below(8));
}

void set_bytes(std::string& s, Dice& dice) {
    const std::size_t width = std::size_t(1) << dice.below(4);
    if (s.size() < width) return;
    const std::uint64_t value = dice.below(4) == 0 ? dice.bits() : odd_integers[dice.below(odd_integers.size())];
    std::memcpy(s.data() + dice.below(s.size() - width + 1), &value, width);  // little-endian, as in GLB and HDF5
}

/// Replaces a number. In half of the cases the length is kept, for formats that count bytes.
void put_number(std::string& s, Dice& dice) {
    const auto [first, last] = stretch(s, dice.below(s.size()), is_number);
    if (first == last) return;
    std::string number(odd_numbers[dice.below(odd_numbers.size())]);
    if (dice.below(2) == 0) number.resize(last - first, ' ');
    s.replace(first, last - first, number);
}

void nudge_number(std::string& s, Dice& dice) {
    const auto [first, last] = stretch(s, dice.below(s.size()), [](char c) { return c >= '0' && c <= '9'; });
    if (first == last) return;
    s[first + dice.below(last - first)] = static_cast<char>('0' + dice.below(10));
}

void swap_words(std::string& s, Dice& dice) {
    const auto [a, b] = stretch(s, dice.below(s.size()), is_word);
    const auto [c, d] = stretch(s, dice.below(s.size()), is_word);
    if (a == b || c == d || a == c) return;
    const std::string one = s.substr(a, b - a), other = s.substr(c, d - c);
    const bool ahead = a < c;
    s.replace(ahead ? c : a, ahead ? d - c : b - a, ahead ? one : other);
    s.replace(ahead ? a : c, ahead ? b - a : d - c, ahead ? other : one);
}

void cut_out(std::string& s, Dice& dice) {
    const std::size_t at = dice.below(s.size());
    s.erase(at, 1 + dice.below(std::min<std::size_t>(s.size(), std::size_t(1) << dice.below(10))));
}

void repeat(std::string& s, Dice& dice) {
    const std::size_t at = dice.below(s.size());
    const std::string part = s.substr(at, 1 + dice.below(std::size_t(1) << dice.below(10)));
    const std::size_t wanted = std::size_t(1) << dice.below(dice.below(8) == 0 ? 12 : 3);
    const std::size_t room = (max_bytes - std::min(max_bytes, s.size())) / part.size();
    std::string copies;
    for (std::size_t n = std::min(wanted, room); n > 0; --n) copies += part;
    s.insert(at, copies);
}

void splice(std::string& s, const std::string& other, Dice& dice) {
    if (other.empty()) return;
    const std::size_t from = dice.below(other.size());
    const std::string part = other.substr(from, 1 + dice.below(std::min<std::size_t>(other.size(), 4096)));
    const std::size_t at = dice.below(s.size() + 1);
    if (dice.below(2) == 0)
        s.insert(at, part);
    else
        s.replace(at, std::min(part.size(), s.size() - at), part);
}

void change(std::string& s, const std::vector<std::string>& corpus, Dice& dice) {
    switch (dice.below(12)) {
        case 0:
            return flip_bit(s, dice);
        case 1:
        case 2:
            return set_bytes(s, dice);
        case 3:
        case 4:
            return put_number(s, dice);
        case 5:
        case 6:
            return nudge_number(s, dice);
        case 7:
            return swap_words(s, dice);
        case 8:
            return cut_out(s, dice);
        case 9:
            return repeat(s, dice);
        case 10:
            return splice(s, corpus[dice.below(corpus.size())], dice);
        default:
            if (dice.below(4) == 0) s.resize(dice.below(s.size()));  // rare, since most later changes would be lost
    }
}

}  // namespace

std::string Mutator::make(std::uint64_t round) const {
    Dice dice(seed_, round);
    if (corpus_.empty()) return {};
    std::string out = corpus_[dice.below(corpus_.size())];
    for (std::size_t n = 1 + dice.below(8); n > 0 && !out.empty(); --n) change(out, corpus_, dice);
    if (out.size() > max_bytes) out.resize(max_bytes);
    return out;
}

}  // namespace exitance::fuzz
