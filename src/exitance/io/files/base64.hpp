#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace exitance {

/// Bytes as text of 64 characters [RFC 4648], four for three bytes, filled up with '='.
std::string base64(std::span<const std::byte> bytes);

}  // namespace exitance
