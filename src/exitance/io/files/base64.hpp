#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace exitance {

/// Encodes bytes as Base64 [RFC 4648]: four characters per three bytes, padded with '='.
std::string base64(std::span<const std::byte> bytes);

}  // namespace exitance
