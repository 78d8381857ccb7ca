#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace exitance {

/// SHA-256 of data that arrive in parts (FIPS 180-4).
class Sha256 {
  public:
    void add(std::string_view bytes);
    /// Adds a text with its length before it, so that a text's end matters.
    void add_text(std::string_view text);
    /// Returns the hash as 64 hexadecimal digits. Must be called once, last.
    std::string finish();

  private:
    void add_block(const unsigned char* block);

    std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> rest_{};
    std::uint64_t bytes_ = 0;
};

}  // namespace exitance
