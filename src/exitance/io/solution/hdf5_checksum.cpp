#include "exitance/io/solution/hdf5_checksum.hpp"

#include <bit>
#include <cstddef>

namespace exitance {

std::uint32_t hdf5_checksum(std::string_view bytes) {
    std::size_t at = 0;
    const auto word = [&] {  // little-endian, with zeros after the end
        std::uint32_t w = 0;
        for (std::size_t k = 0; k < 4; ++k, ++at)
            if (at < bytes.size()) w |= std::uint32_t(static_cast<unsigned char>(bytes[at])) << 8 * k;
        return w;
    };
    std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(bytes.size()), b = a, c = a;
    const auto add = [&] { a += word(), b += word(), c += word(); };
    const auto less = [](std::uint32_t& x, std::uint32_t y, std::uint32_t& z, int turn) {
        x = (x - z) ^ std::rotl(z, turn);
        z += y;
    };
    const auto last = [](std::uint32_t& x, std::uint32_t y, int turn) { x = (x ^ y) - std::rotl(y, turn); };
    while (bytes.size() > at + 12) {
        add();
        less(a, b, c, 4), less(b, c, a, 6), less(c, a, b, 8), less(a, b, c, 16), less(b, c, a, 19), less(c, a, b, 4);
    }
    if (bytes.empty()) return c;
    add();
    last(c, b, 14), last(a, c, 11), last(b, a, 25), last(c, b, 16), last(a, c, 4), last(b, a, 14), last(c, b, 24);
    return c;
}

}  // namespace exitance
